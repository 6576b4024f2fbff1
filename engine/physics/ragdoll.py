"""A body that is simulated: start it from a moving pose, step it while it is pulled towards a pose, read where it is.

All functions are pure: a state is one flat float vector (MuJoCo's integration state, restored bit for bit) that can
live in a column of the world, be snapshot, digested and rewound like any other.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import mujoco
import numpy as np

from engine.body.skeleton import JOINT_COUNT, PARENT, Pose
from engine.maths import rotations
from engine.maths.springs import half_sine
from engine.physics import part_stops, stops, tracking, weight
from engine.physics.model import SUB_STEPS_HZ, RagdollModel

_KIND = mujoco.mjtState.mjSTATE_INTEGRATION


class Push(NamedTuple):
    """An impulse on its way into the body: a half-sine force at a place that moves with a body part."""

    joint: int  # the joint that carries the part
    place_m: np.ndarray  # (3,) in that joint's frame
    impulse_Ns: np.ndarray  # (3,) world, on the body, all of it
    since_s: float  # time since contact when the step begins; negative: contact is still to come within the step
    duration_s: float  # 0: at once


def start(model: RagdollModel, pose: Pose, pose_before: Pose, dt_s: float) -> np.ndarray:
    """The state (n,) of a body in a pose that it has reached in dt_s from the pose before."""
    qvel = np.empty(model.mujoco_model.nv)
    tracking.finite_velocities(pose_before.root_m, pose.root_m, pose_before.rotations, pose.rotations, dt_s, qvel)
    return state_of(model, pose, qvel)


def state_of(model: RagdollModel, pose: Pose, velocities: np.ndarray) -> np.ndarray:
    """The state (n,) with velocities (nv,): the root's linear in the world, then spins (J, 3) in each joint's frame."""
    d = model.data
    mujoco.mj_resetData(model.mujoco_model, d)
    d.qpos[:3] = pose.root_m
    d.qpos[3:] = np.asarray(pose.rotations, float).reshape(-1)
    d.qvel[:] = velocities
    return _state(model)


def step(
    model: RagdollModel,
    state: np.ndarray,
    target: Pose,
    strength: float,
    damping: float,
    dt_s: float,
    pushes: tuple[Push, ...] = (),
    trace: np.ndarray | None = None,
    *,
    target_before: Pose | None = None,
    carries: float = 0.0,
    sunk_m: np.ndarray | None = None,
) -> np.ndarray:
    """The state dt_s later: gravity, floor, servos towards the target's rotations (its root is ignored), and pushes.

    strength 1 is a fit person's, 0 limp; damping 1 is critical. Sub-steps of 1 / 480 s or a little less; trace, if
    given, (sub_steps_in(dt_s), J, 3), is filled with the velocity of every part's centre of mass after each: a blow is
    over within a tick. The target may move, evenly, from target_before. carries, 0 to 1, is the share of the weight on
    standing feet that the muscles hold from the start (`engine.physics.weight`); sunk_m (S,) how deep each shape may
    lie in the floor (`engine.physics.sunk`).
    """
    m, d = model.mujoco_model, model.data
    _load(model, state)
    count = sub_steps_in(dt_s)
    h = dt_s / count
    m.opt.timestep = h
    target_rotations = np.ascontiguousarray(target.rotations, dtype=float)
    came_from = target_rotations if target_before is None else np.ascontiguousarray(target_before.rotations, float)
    spins = np.empty((JOINT_COUNT, 3))
    tracking.spins_between(came_from, target_rotations, dt_s, spins)
    servos = _Servos(came_from, spins, float(strength), float(damping), carries)
    part_stops.keep_own(model, target_rotations)
    m.geom_margin[1:] = 0.0 if sunk_m is None else -sunk_m
    momentum = _momentum(model)
    for k in range(count):
        _pull(model, servos, (k + 1) * h, h)
        for push in pushes:
            _apply(model, push, push.since_s + k * h, h)
        qpos_before = d.qpos.copy()
        mujoco.mj_step(m, d)
        stops.hold(model, qpos_before, target_rotations, max(0.0, 1.0 - strength), h)
        momentum = _balance(model, momentum, h)
        if trace is not None:
            body = model.body
            trace[k] = tracking.part_velocities(PARENT, body.offset_m, body.part_com_m, d.qpos, d.qvel)
    d.qfrc_applied[:] = 0.0
    return _state(model)


class _Servos(NamedTuple):
    """What pulls the joints in one step, see `step`."""

    came_from: np.ndarray  # (J, 4) the target's rotations when the step begins
    spins: np.ndarray  # (J, 3) rad/s: how they turn
    strength: float
    damping: float
    carries: float


def _pull(model: RagdollModel, servos: _Servos, at_s: float, h: float) -> None:
    """Sets the servos' torques for a sub-step of h that ends at_s after the step began, and the inertia that lets them
    be stiff.
    """
    m, d, body = model.mujoco_model, model.data, model.body
    goal, torque, armature = np.empty((JOINT_COUNT, 4)), np.zeros(m.nv), np.zeros(m.nv)
    tracking.turned(servos.came_from, servos.spins, at_s, goal)
    tracking.drive(
        d.qpos, d.qvel, goal, servos.spins, body.limit_low_rad, body.limit_high_rad,
        model.inertia_kgm2, model.strength_nm, servos.strength, servos.damping, h, torque, armature,
    )  # fmt: skip
    if servos.carries > 0.0:
        most_nm = servos.strength * model.strength_nm
        weight.carry(PARENT, body, d.qpos, -m.opt.gravity[2], servos.carries, most_nm, torque)
    m.dof_armature[:] = armature
    d.qfrc_applied[:] = torque


def sub_steps_in(dt_s: float) -> int:
    """How many sub-steps a step of dt_s is made of."""
    return max(1, math.ceil(dt_s * SUB_STEPS_HZ - 1e-9))


def read(model: RagdollModel, state: np.ndarray) -> tuple[Pose, np.ndarray]:
    """The pose, and the velocities (J, 3) of its joints, world."""
    return pose_of(model, state), motion_of(model, state)[0]


def pose_of(model: RagdollModel, state: np.ndarray) -> Pose:
    """Where the body is."""
    qpos = state[model.positions]
    turned = qpos[3:].reshape(JOINT_COUNT, 4)
    return Pose(qpos[:3].copy(), turned / np.sqrt((turned * turned).sum(axis=1, keepdims=True)))


def carried_on(model: RagdollModel, state: np.ndarray, dt_s: float) -> Pose:
    """Where the body is a moment later (negative: earlier) by its velocities alone."""
    pose = pose_of(model, state)
    if dt_s == 0.0:
        return pose
    qvel = state[model.velocities]
    spins = qvel[3:].reshape(JOINT_COUNT, 3)
    turned = rotations.multiply(pose.rotations, rotations.from_rotation_vector(spins * dt_s))
    return Pose(pose.root_m + qvel[:3] * dt_s, rotations.normalise(turned))


def motion_of(model: RagdollModel, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Linear (J, 3) and angular (J, 3) velocity of every joint's frame, in world axes."""
    return tracking.joint_velocities(PARENT, model.body.offset_m, state[model.positions], state[model.velocities])


def part_motion_of(model: RagdollModel, state: np.ndarray) -> np.ndarray:
    """(J, 3) velocity of every part's centre of mass, world: what `step` traces."""
    body = model.body
    return tracking.part_velocities(
        PARENT, body.offset_m, body.part_com_m, state[model.positions], state[model.velocities]
    )


def com_velocity_of(model: RagdollModel, state: np.ndarray) -> np.ndarray:
    """(3,) velocity of the whole body's centre of mass, world."""
    qpos, qvel = state[model.positions], state[model.velocities]
    return tracking.momentum(PARENT, model.body, qpos, qvel) / model.mass_kg


def share_in(push: Push, from_s: float, to_s: float) -> float:
    """The share of a push that falls between two times since contact: the same numbers for body and ball."""
    if push.duration_s <= 0.0:
        return 1.0 if from_s <= 0.0 < to_s else 0.0
    return half_sine(to_s, push.duration_s) - half_sine(from_s, push.duration_s)


def _apply(model, push, from_s, h):
    """Adds one sub-step of a push to the applied forces: the mean force over it, at the place as it is now."""
    share = share_in(push, from_s, from_s + h)
    if share == 0.0:
        return
    m, d = model.mujoco_model, model.data
    mujoco.mj_kinematics(m, d)
    mujoco.mj_comPos(m, d)
    place = place_in_world(model, push.joint, push.place_m)
    force = np.asarray(push.impulse_Ns) * (share / h)
    mujoco.mj_applyFT(m, d, force, np.zeros(3), place, push.joint + 1, d.qfrc_applied)


def _momentum(model):
    """(3,) the linear momentum of the body as the scratch data has it."""
    return tracking.momentum(PARENT, model.body, model.data.qpos, model.data.qvel)


def _balance(model, before, h):
    """Makes a sub-step's change of momentum that of the outer forces, to rounding. Returns the new momentum (3,).

    Stepping velocities first and places after them, the turning of the parts leaks momentum at second order in h. All
    outer forces (floor, pushes, gravity) stand in the root's first three rows; what leaked goes back as a velocity of
    the whole.
    """
    m, d, mass = model.mujoco_model, model.data, model.mass_kg
    wanted = before + h * (d.qfrc_constraint[:3] + d.qfrc_applied[:3] + mass * m.opt.gravity)
    d.qvel[:3] += (wanted - _momentum(model)) / mass
    return wanted


def place_in_world(model: RagdollModel, joint: int, place_m: np.ndarray) -> np.ndarray:
    """A place on a body part (in its joint's frame) in the world, as the scratch data now has the body."""
    frame = model.data.xmat[joint + 1].reshape(3, 3)
    return model.data.xpos[joint + 1] + (frame * np.asarray(place_m)).sum(axis=1)


def _load(model, state):
    mujoco.mj_setState(model.mujoco_model, model.data, np.ascontiguousarray(state, dtype=float), _KIND)


def _state(model):
    out = np.empty(model.state_size)
    mujoco.mj_getState(model.mujoco_model, model.data, out, _KIND)
    return out
