"""Servos and ligaments: the torques that pull a simulated body towards a pose, strong as a person and stable at any
gain.

Stable proportional-derivative control (Tan, Liu and Turk 2011, IEEE CG&A 31), written as one linearly implicit step.
With the torque k (error - h v+) - d v+ of the *next* velocity, M (v+ - v) / h = k error - D v+, D = d + h k, is the
same as

    (M + h D) (v+ - v) = h (k error - D v)

so h D goes where MuJoCo keeps a joint's armature (it then enters contacts too, and floor and servo agree about what
moves), and k error - D v is the applied torque. Gains come from the inertia that each joint has to move, so that one
frequency suits a wrist and a hip: k = I w^2, d = 2 z I w.
"""

from __future__ import annotations

import math

import numpy as np

from engine.body.limits import clamp_keeping
from engine.body.skeleton import JOINT_COUNT
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

SERVO_HZ = 3.5  # at strength 1: settles in about 0.1 s, as braced muscle with its reflexes does
LIGAMENT_HZ = 8.0
LIGAMENT_PER_STRENGTH = 60.0  # per radian beyond a limit: a joint gives 1 degree under its own muscles' full torque
TAUT_RAD = 0.02  # beyond a limit: there a ligament damps fully, before that in proportion (Hunt and Crossley 1975)
PASSIVE_PER_S = 1.5  # tissue damping that is left without any strength, per unit of servo inertia


@njit(cache=True)
def drive(qpos, qvel, target, spins, low, high, inertia, most_nm, strength, damping, h, torque, armature):
    """Fills in torque (nv,) and armature (nv,) for one sub-step of h seconds; the root's six stay zero.

    target (J, 4): local rotations to pull towards, which turn at spins (J, 3), radians per second, each in its own
    frame: muscles damp what goes otherwise, not the movement that they make. A limit that the target oversteps is moved
    out to it: a clip keeps its own excess. strength scales stiffness and greatest torque (0: limp), damping the servo's
    damping ratio (1: critical).
    """
    w = 2.0 * math.pi * SERVO_HZ
    for j in range(1, JOINT_COUNT):
        a, v = 3 + 4 * j, 3 + 3 * j
        q = (qpos[a], qpos[a + 1], qpos[a + 2], qpos[a + 3])
        spin = (qvel[v], qvel[v + 1], qvel[v + 2])
        astray = vector.subtract(spin, spins[j])
        k, own = _servo_gains(q, astray, target[j], inertia[j] * w * w * strength, strength * most_nm[j],
                            2.0 * damping * inertia[j] * w * math.sqrt(strength))  # fmt: skip
        d = own + PASSIVE_PER_S * inertia[j]
        error = _towards(q, target[j])
        inwards = _towards(q, clamp_keeping(low[j], high[j], target[j], q))
        beyond = math.sqrt(inwards[0] ** 2 + inwards[1] ** 2 + inwards[2] ** 2)
        tight = 0.0
        if beyond > 1e-9:
            ligament = 2.0 * math.pi * LIGAMENT_HZ
            tight = max(inertia[j] * ligament * ligament, LIGAMENT_PER_STRENGTH * most_nm[j])
            d += 2.0 * math.sqrt(tight * inertia[j]) * min(1.0, beyond / TAUT_RAD)
        slope = d + h * (k + tight)
        for axis in range(3):
            torque[v + axis] = k * error[axis] + own * spins[j, axis] + tight * inwards[axis] - slope * spin[axis]
            armature[v + axis] = h * slope


@njit(cache=True)
def spins_between(before, now, dt_s, spins):
    """Fills in the spins (J, 3), each in its joint's frame, that turn rotations (J, 4) into others in dt_s."""
    for j in range(JOINT_COUNT):
        turn = _towards(before[j], now[j])
        for axis in range(3):
            spins[j, axis] = turn[axis] / dt_s


@njit(cache=True)
def turned(before, spins, dt_s, out):
    """Fills in where rotations (J, 4) are after dt_s at these spins."""
    for j in range(JOINT_COUNT):
        turn = quaternion.from_rotation_vector(vector.scale(vector.at(spins, j), dt_s))
        quaternion.put(out, j, quaternion.normalise(quaternion.multiply(quaternion.at(before, j), turn)))


@inner_kernel
def _towards(q, goal):
    """The rotation from q to the goal, as a rotation vector in q's own frame."""
    return quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(q), goal))


@inner_kernel
def _servo_gains(q, spin, goal, stiffness, most_nm, damping):
    """Stiffness and damping, both weakened alike where together they would ask for more than the greatest torque."""
    e = _towards(q, goal)
    square = 0.0
    for axis in range(3):
        square += (stiffness * e[axis] - damping * spin[axis]) ** 2
    wanted = math.sqrt(square)
    share = most_nm / wanted if wanted > most_nm else 1.0
    return stiffness * share, damping * share


@njit(cache=True)
def finite_velocities(root_before, root, rotations_before, rotations, dt_s, qvel):
    """Fills in qvel (nv,), which leads from one pose to the next in dt_s: world linear, spins in each joint's frame."""
    for axis in range(3):
        qvel[axis] = (root[axis] - root_before[axis]) / dt_s
    for j in range(JOINT_COUNT):
        turn = _towards(rotations_before[j], rotations[j])
        for axis in range(3):
            qvel[3 + 3 * j + axis] = turn[axis] / dt_s


@njit(cache=True)
def world_frames(parent, offset_m, qpos):
    """(J, 3) and (J, 4): every joint in the world, from MuJoCo's own coordinates."""
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    for j in range(JOINT_COUNT):
        a, p = 3 + 4 * j, parent[j]
        q = quaternion.normalise((qpos[a], qpos[a + 1], qpos[a + 2], qpos[a + 3]))
        place = (qpos[0], qpos[1], qpos[2])
        if p >= 0:
            q = quaternion.multiply(orientations[p], q)
            place = vector.add(positions[p], quaternion.rotate(orientations[p], offset_m[j]))
        positions[j, 0], positions[j, 1], positions[j, 2] = place
        orientations[j, 0], orientations[j, 1], orientations[j, 2], orientations[j, 3] = q
    return positions, orientations


@njit(cache=True)
def joint_velocities(parent, offset_m, qpos, qvel):
    """(J, 3) linear and (J, 3) angular velocity of every joint's frame, world axes."""
    linear, angular = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 3))
    positions, orientations = world_frames(parent, offset_m, qpos)
    for j in range(JOINT_COUNT):
        v, p = 3 + 3 * j, parent[j]
        moves = (qvel[0], qvel[1], qvel[2])
        turns = quaternion.rotate(orientations[j], (qvel[v], qvel[v + 1], qvel[v + 2]))
        if p >= 0:
            bone = vector.subtract(positions[j], positions[p])
            moves = vector.add(linear[p], vector.cross(angular[p], bone))
            turns = vector.add(turns, angular[p])
        linear[j, 0], linear[j, 1], linear[j, 2] = moves
        angular[j, 0], angular[j, 1], angular[j, 2] = turns
    return linear, angular


@njit(cache=True)
def part_velocities(parent, offset_m, com_m, qpos, qvel):
    """(J, 3) velocity of the centre of mass of the part that each joint carries, world."""
    _, orientations = world_frames(parent, offset_m, qpos)
    linear, angular = joint_velocities(parent, offset_m, qpos, qvel)
    for j in range(JOINT_COUNT):
        arm = quaternion.rotate(orientations[j], com_m[j])
        linear[j, 0], linear[j, 1], linear[j, 2] = vector.add(linear[j], vector.cross(angular[j], arm))
    return linear


@njit(cache=True)
def momentum(parent, body, qpos, qvel):
    """(3,) linear momentum of the whole body, N s."""
    velocities = part_velocities(parent, body.offset_m, body.part_com_m, qpos, qvel)
    out = np.zeros(3)
    for j in range(JOINT_COUNT):
        for axis in range(3):
            out[axis] += body.part_mass_kg[j] * velocities[j, axis]
    return out
