"""A ball and a body meet: where and when exactly, what impulse passes between them, and how it reaches both.

The impulse is Newton's and Coulomb's, computed once from the body as it is jointed: J_mujoco M^-1 J_mujoco^T is how a
place on the body gives way to a push, all joints transmitting. Servos, gravity and floor have no part in it. It may
then be delivered at once, or as a half-sine force over the contact time (spec A8): the same shares go to both sides, so
what one gains the other loses.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import mujoco
import numpy as np

from engine.body.capsules import CAPSULES, Capsules, capsules_at
from engine.maths import quaternion, shapes, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.physics import ragdoll, stops
from engine.physics.model import RagdollModel
from engine.physics.ragdoll import Push

HOLLOW, SOLID = 2.0 / 3.0, 2.0 / 5.0  # moment of inertia of a thin shell and of a full ball, per m r^2


class Ball(NamedTuple):
    """A ball in flight; three-vectors are anything indexable, world."""

    mass_kg: float
    radius_m: float
    centre_m: tuple[float, float, float]
    velocity_mps: tuple[float, float, float]
    spin_radps: tuple[float, float, float] = (0.0, 0.0, 0.0)
    hollow: float = HOLLOW


class Material(NamedTuple):
    """What two surfaces do to each other."""

    restitution: float  # 0 ... 1, along the normal
    friction: float  # Coulomb


class Hit(NamedTuple):
    """The first contact of a ball with a body within a tick."""

    share: float  # of the tick that passed before, 0 ... 1
    part: str  # which capsule, by name
    joint: int  # the joint that carries it
    place_m: np.ndarray  # (3,) the contact in that joint's frame
    point_m: np.ndarray  # (3,) the contact in the world, at that moment
    normal: np.ndarray  # (3,) unit, from the body to the ball's centre, world


class Impulse(NamedTuple):
    """What passes between a ball and a body. On the ball; the body gets its opposite."""

    impulse_Ns: np.ndarray  # (3,) world
    turning_Nms: np.ndarray  # (3,) its moment about the ball's centre
    joint: int
    place_m: np.ndarray  # (3,) in the joint's frame
    approach_mps: float  # speed of closing along the normal before, positive
    normal: np.ndarray  # (3,) unit, from the body to the ball's centre, world


def first_hit(
    capsules: Capsules, before, now, centre_before_m, centre_m, radius_m: float, past_joint: int = -1
) -> Hit | None:
    """The first contact within a tick in which ball and body each move evenly.

    before, now: (positions (J, 3), orientations (J, 4)) of the body at the tick's two ends; past_joint: the parts that
    this one carries do not count. None if they do not meet.
    """
    ends0, ends1 = capsules_at(capsules, *before), capsules_at(capsules, *now)
    centre0, centre1 = np.asarray(centre_before_m, float), np.asarray(centre_m, float)
    counts = capsules.joint != past_joint
    c, share = _first(capsules.radius_m, counts, ends0, ends1, centre0, centre1, float(radius_m))
    if c < 0:
        return None
    start, end = ends0[c] + share * (ends1[c] - ends0[c])
    centre = centre0 + share * (centre1 - centre0)
    normal = np.array(shapes.outwards(start, end, centre))
    along = shapes.nearest_on_segment(start, end, centre)
    joint = int(capsules.joint[c])
    frame = quaternion.slerp(before[1][joint], now[1][joint], share)
    axis_point = capsules.start_m[c] + along * (capsules.end_m[c] - capsules.start_m[c])
    outwards = np.array(quaternion.unrotate(frame, normal))
    return Hit(
        share=share,
        part=CAPSULES[c],
        joint=joint,
        place_m=axis_point + capsules.radius_m[c] * outwards,
        point_m=start + along * (end - start) + capsules.radius_m[c] * normal,
        normal=normal,
    )


@njit(cache=True)
def _first(radius_m, counts, ends0, ends1, centre0, centre1, ball_radius_m):
    """The capsule that is met first, and the share of the tick: (-1, -1) where none is."""
    best, when = -1, 2.0
    for c in range(len(radius_m)):
        if not counts[c]:
            continue
        share = shapes.swept_sphere_capsule(
            centre0, centre1, ends0[c, 0], ends0[c, 1], ends1[c, 0], ends1[c, 1], radius_m[c] + ball_radius_m
        )
        if 0.0 <= share < when:
            best, when = c, share
    return best, (when if best >= 0 else -1.0)


def exchange(model: RagdollModel, state: np.ndarray, ball: Ball, hit: Hit, material: Material) -> Impulse | None:
    """The impulse of one contact between a ball and a body in a state; None if they are parting already."""
    place = _locate(model, state, hit.joint, hit.place_m)
    gives, velocity = _mobility(model, place, hit.joint, hit.normal)
    arm = -ball.radius_m * hit.normal
    gap_velocity = np.asarray(ball.velocity_mps) + np.cross(ball.spin_radps, arm) - velocity
    approach = -float((gap_velocity * hit.normal).sum())
    if approach <= 0.0:
        return None
    gives = gives + ball_mobility(ball.mass_kg, ball.radius_m, ball.hollow, hit.normal)
    j = np.array(contact_impulse(gives, gap_velocity, hit.normal, *material))
    return Impulse(j, np.cross(arm, j), hit.joint, np.asarray(hit.place_m, float), approach, hit.normal)


def bounce(ball: Ball, normal, material: Material) -> Ball:
    """A ball after it has met something that does not give, like the floor; the same ball if it is parting already."""
    n = np.asarray(normal, float)
    arm = -ball.radius_m * n
    gap_velocity = np.asarray(ball.velocity_mps) + np.cross(ball.spin_radps, arm)
    if (gap_velocity * n).sum() >= 0.0:
        return ball
    gives = ball_mobility(ball.mass_kg, ball.radius_m, ball.hollow, n)
    j = np.array(contact_impulse(gives, gap_velocity, n, *material))
    return ball_after(ball, Impulse(j, np.cross(arm, j), -1, arm, 0.0, n))


def ball_after(ball: Ball, impulse: Impulse, share: float = 1.0) -> Ball:
    """The ball when a share of the impulse has reached it: velocity and spin change, its place does not."""
    inertia = ball.hollow * ball.mass_kg * ball.radius_m**2
    velocity = np.asarray(ball.velocity_mps) + share * impulse.impulse_Ns / ball.mass_kg
    spin = np.asarray(ball.spin_radps) + share * impulse.turning_Nms / inertia
    return ball._replace(velocity_mps=tuple(velocity.tolist()), spin_radps=tuple(spin.tolist()))


def body_after(model: RagdollModel, state: np.ndarray, impulse: Impulse) -> np.ndarray:
    """The state when the body has taken all of its side of the impulse at once: velocities change, places do not."""
    place = _locate(model, state, impulse.joint, impulse.place_m)
    jacobian = _jacobian(model, place, impulse.joint)
    out = np.array(state, float)
    solved = _answers(model, jacobian, np.asarray(impulse.normal, float))
    out[model.velocities] -= (solved * impulse.impulse_Ns[:, None]).sum(axis=0)
    return out


def push_of(impulse: Impulse, since_s: float, duration_s: float) -> Push:
    """The body's side of the impulse, for ragdoll.step to deliver; since_s: time since contact when the step begins."""
    return Push(impulse.joint, impulse.place_m, -impulse.impulse_Ns, since_s, duration_s)


def _locate(model, state, joint, place_m):
    """Loads a state, without servos or their armature, into the scratch data. Returns the place in the world."""
    m, d = model.mujoco_model, model.data
    mujoco.mj_setState(m, d, np.ascontiguousarray(state, dtype=float), mujoco.mjtState.mjSTATE_INTEGRATION)
    m.dof_armature[:] = 0.0
    mujoco.mj_fwdPosition(m, d)
    return ragdoll.place_in_world(model, joint, place_m)


def _jacobian(model, place, joint):
    """(3, nv): how the place moves with the generalised velocities."""
    out = np.empty((3, model.mujoco_model.nv))
    mujoco.mj_jac(model.mujoco_model, model.data, out, None, place, joint + 1)
    return out


def _answers(model, jacobian, normal):
    """(3, nv): how all velocities change per impulse along each axis at the place, joints transmitting.

    Whatever touches already, a hand on the head, a joint at its limit, holds against a push from outside, -normal.
    """
    solved = np.empty_like(jacobian)
    mujoco.mj_solveM(model.mujoco_model, model.data, solved, jacobian)
    push = -(solved * normal[:, None]).sum(axis=0)
    rows, answers = stops.braces(model, model.data.qpos, push)
    if len(rows):
        stops.braced(rows, answers, solved)
    return solved


def _mobility(model, place, joint, normal):
    """How the place gives way: change of its velocity (3, 3) per impulse there, J M^-1 J^T; and its velocity now."""
    jacobian = _jacobian(model, place, joint)
    solved = _answers(model, jacobian, normal)
    gives = (jacobian[:, None, :] * solved[None, :, :]).sum(axis=2)
    return 0.5 * (gives + gives.T), (jacobian * model.data.qvel).sum(axis=1)


def ball_mobility(mass_kg: float, radius_m: float, hollow: float, normal: np.ndarray) -> np.ndarray:
    """(3, 3) the same for the ball's surface at the contact: it gives by moving and, across the normal, by spinning."""
    across = np.eye(3) - np.multiply.outer(normal, normal)
    return np.eye(3) / mass_kg + across / (hollow * mass_kg)


@njit(cache=True)
def contact_impulse(gives, gap_velocity, normal, restitution, friction):
    """The impulse on the ball that takes the approach u_n to -e u_n exactly, in Coulomb's cone, and makes no energy.

    gives (3, 3): mobility of both sides together; u' = u + gives j. If the surfaces can hold each other (|j_t| <= mu
    j_n), the slip ends, else they slide along the way that holding would have pushed, with j_t = mu j_n; j_n from the
    normal's equation. Newton's restitution can make energy where joints couple normal and tangent (Kane and Levinson
    1985, Dynamics, section 5.9): then there is just so much less friction that it does not.
    """
    n = (normal[0], normal[1], normal[2])
    u = (gap_velocity[0], gap_velocity[1], gap_velocity[2])
    wanted_n = -(1.0 + restitution) * vector.inner(u, n)
    holding = _solve3(gives, vector.along(vector.scale(vector.reject(u, n), -1.0), n, wanted_n))
    across, pressing = vector.reject(holding, n), vector.inner(holding, n)
    way = vector.unit(across, (0.0, 0.0, 0.0))
    ratio = friction if pressing <= 0.0 else min(friction, vector.length(across) / pressing)
    j, gained = _with_friction(gives, u, n, way, ratio, wanted_n)
    if gained <= 0.0:
        return j
    low, high = 0.0, ratio
    for _ in range(60):
        middle = 0.5 * (low + high)
        if _with_friction(gives, u, n, way, middle, wanted_n)[1] <= 0.0:
            low = middle
        else:
            high = middle
    return _with_friction(gives, u, n, way, low, wanted_n)[0]


@inner_kernel
def _with_friction(gives, u, n, way, ratio, wanted_n):
    """The impulse along n + ratio * way that changes the normal velocity as wanted, and the kinetic energy it makes."""
    towards = vector.along(n, way, ratio)
    answer = _times(gives, towards)
    normal_answer = vector.inner(n, answer)
    if normal_answer <= 0.0:  # so much friction would jam rather than part them
        return vector.scale(n, 0.0), math.inf
    size = wanted_n / normal_answer
    return vector.scale(towards, size), size * (vector.inner(u, towards) + 0.5 * size * vector.inner(towards, answer))


@njit(cache=True)
def _times(a, v):
    return (vector.inner(a[0], v), vector.inner(a[1], v), vector.inner(a[2], v))


@inner_kernel
def _solve3(a, b):
    """a x = b for a symmetric positive (3, 3), by cross products (Cramer's rule)."""
    r0, r1, r2 = (a[0, 0], a[0, 1], a[0, 2]), (a[1, 0], a[1, 1], a[1, 2]), (a[2, 0], a[2, 1], a[2, 2])
    c0, c1, c2 = vector.cross(r1, r2), vector.cross(r2, r0), vector.cross(r0, r1)
    det = vector.inner(r0, c0)
    total = vector.add(vector.add(vector.scale(c0, b[0]), vector.scale(c1, b[1])), vector.scale(c2, b[2]))
    return vector.scale(total, 1.0 / det)
