"""The weight that the muscles of somebody who stands already carry when the physics takes over.

Servos alone carry it only after they have sunk far enough; a person struck on the feet holds himself up at that very
moment. So servos begin from the torques of standing still in the pose that the body has: what hangs on each joint
against gravity, less what the ground gives back through it, under the feet as near below the centre of mass as they
are (Winter 2009, Biomechanics and Motor Control of Human Movement, chapter 5, without accelerations).
"""

from __future__ import annotations

import math

import numpy as np

from engine.body.skeleton import ANKLES, JOINT_COUNT
from engine.body.support import bearing, sole_points
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.physics.tracking import world_frames

BEARS_M = 0.02  # a foot whose lowest point is nearer to the floor than this stands
SOLE_M = 0.08  # how far from the middle of a sole its pressure goes


@njit(cache=True)
def carry(parent, body, qpos, gravity_mps2, share, most_nm, torque):
    """Adds to torque (nv,) a share of what holds the body's weight on the feet that stand; nothing where none does.

    No joint carries more than its greatest torque (J,).
    """
    positions, orientations = world_frames(parent, body.offset_m, qpos)
    masses, moments = np.zeros(JOINT_COUNT), np.zeros((JOINT_COUNT, 3))  # of all that hangs on a joint
    for j in range(JOINT_COUNT - 1, -1, -1):
        com_m = vector.add(positions[j], quaternion.rotate(orientations[j], body.part_com_m[j]))
        masses[j] += body.part_mass_kg[j]
        for k in range(3):
            moments[j, k] += body.part_mass_kg[j] * com_m[k]
        if j > 0:
            masses[parent[j]] += masses[j]
            for k in range(3):
                moments[parent[j], k] += moments[j, k]
    weight_n = masses[0] * gravity_mps2
    places, forces_n = ground(body, positions, orientations, moments[0] / masses[0], weight_n)
    if forces_n[0] + forces_n[1] == 0.0:
        return
    for j in range(1, JOINT_COUNT):
        x = moments[j, 0] - masses[j] * positions[j, 0]
        y = moments[j, 1] - masses[j] * positions[j, 1]
        x, y = x * gravity_mps2, y * gravity_mps2
        for side in range(2):
            if _carries(parent, j, ANKLES[side]):
                x -= forces_n[side] * (places[side, 0] - positions[j, 0])
                y -= forces_n[side] * (places[side, 1] - positions[j, 1])
        # arm (x, y) times an upward force: the torque that holds it up, in the joint's own frame
        own = quaternion.unrotate(orientations[j], (y, -x, 0.0))
        own = vector.scale(own, share * min(1.0, most_nm[j] / max(vector.length(own), 1e-9)))
        for k in range(3):
            torque[3 + 3 * j + k] += own[k]


@inner_kernel
def _carries(parent, j, foot):
    """Whether a joint is the foot's or the foot hangs on it."""
    while foot >= 0:
        if foot == j:
            return True
        foot = parent[foot]
    return False


@njit(cache=True)
def ground(body, positions, orientations, com_m, weight_n):
    """(2, 3) where the ground presses against each foot, and (2,) how hard."""
    points = sole_points(body, positions, orientations)
    places, forces_n, stands = np.zeros((2, 3)), np.zeros(2), np.zeros(2, np.bool_)
    for side in range(2):
        bears, lowest = bearing(points[side]), math.inf
        for k in range(len(bears)):
            lowest = min(lowest, points[side, k, 2])
            if bears[k]:
                for axis in range(3):
                    places[side, axis] += points[side, k, axis] / bears.sum()
        stands[side] = lowest < BEARS_M
    if stands[0] and stands[1]:
        x, y = places[1, 0] - places[0, 0], places[1, 1] - places[0, 1]
        along = (com_m[0] - places[0, 0]) * x + (com_m[1] - places[0, 1]) * y
        right = min(max(along / max(x * x + y * y, 1e-9), 0.0), 1.0)
    else:
        right = 1.0 if stands[1] else 0.0
    if stands[0] or stands[1]:
        forces_n[0], forces_n[1] = (1.0 - right) * weight_n, right * weight_n
    between = vector.mix(places[0], places[1], right)
    aside = (com_m[0] - between[0], com_m[1] - between[1], 0.0)
    aside = vector.scale(aside, min(1.0, SOLE_M / max(vector.length(aside), 1e-9)))
    for side in range(2):
        for axis in range(3):
            places[side, axis] += aside[axis]
    return places, forces_n
