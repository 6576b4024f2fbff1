"""Stops: what a body cannot do, however hard it is struck. No joint goes past its limits, no arm into head, trunk or
the other arm, no leg into the other.

Both are bounds on velocities, met after every sub-step by the least impulses that do it, through the whole jointed
body: with rows J and bounds b,

    v = v+ + M^-1 J^T x,   x >= 0,   J v >= b,   x (J v - b) = 0

(the velocity-level complementarity of Stewart and Trinkle 1996, solved by projected Gauss-Seidel). A bound looks ahead:
what is a distance d from its stop may approach it with d / EASE_S at most, so that it is slowed over some sub-steps
before it touches, as flesh does, and never passes. What is past a stop already may not go farther, but is not thrown
back: the way out is left to ligaments and soft contacts. So a pose that begins inside itself, or beyond a limit, is no
spring under load, and no energy is made.
"""

from __future__ import annotations

import math

import mujoco
import numpy as np
from numba import njit

from engine.body.capsules import CAPSULES, capsules_at
from engine.body.limits import components
from engine.body.skeleton import JOINT_COUNT, PARENT
from engine.maths import quaternion, shapes, vector
from engine.maths.inner_kernel import inner_kernel
from engine.physics.tracking import world_frames

EASE_S = 0.006
MOST_ROWS = 48  # more stops than this at once are those of a body that is nowhere near a person's pose
NEAR_MPS = 0.05  # a bound that is met by less than this may be broken by the impulses of others: it is kept in view
NEAR_RAD = 0.4  # the same for limits of one joint: nothing turns farther than this in EASE_S
SWEEPS = 40
CREEP_RADPS, CREEP_MPS = 0.3, 0.02
FARTHEST_M = 0.15  # nothing within a body closes faster than this in EASE_S
LEAST_APART_M = 1e-6  # of two axes: nearer than this, there is no saying which way is out
TOUCHING_M, TOUCHING_RAD = 0.01, 0.05  # what a blow closes at once: these count as touching
MOST_SWING_RAD = 2.9  # nearer to half a turn, where the axis of a swing flips, its components say nothing
NUDGE_RAD = 1e-6
LEAST_GIVE = 1e-9  # 1 / kg, 1 / kg m^2: what gives less is no stop, its row is all but nothing
LEAST_NEW = 1e-8  # of what it gives: the rest of a row that others leave

_TRUNK = ("pelvis", "belly", "chest", "upper_chest", "neck", "head")


def _between(ones, others):
    return [(one, other) for one in ones for other in others]


def _both(names):
    return [f"{side}_{name}" for side in ("left", "right") for name in names]


def _names_of_pairs():
    """Which capsules stop which, by name: never two that hang on one joint."""
    lower, legs = _both(("forearm", "hand")), _both(("thigh",))
    left, right = ([f"{side}_{part}" for part in ("upper_arm", "forearm", "hand")] for side in ("left", "right"))
    left_leg, right_leg = ([f"{side}_{part}" for part in ("thigh", "shank", "foot")] for side in ("left", "right"))
    return [
        *_between(lower, _TRUNK),
        *_between(_both(("upper_arm",)), ("head",)),
        *_between(left, right),
        *_between(lower, legs),
        # thighs meet at their knees, which are the shanks' upper ends too: at the hips they are one flesh
        *[pair for pair in _between(left_leg, right_leg) if any(name.endswith("shank") for name in pair)],
        ("left_foot", "right_foot"),
    ]


PAIRS_BY_NAME = _names_of_pairs()


def pairs_of(mujoco_model) -> np.ndarray:
    """(P, 2) the same as capsules, in the order in which MuJoCo keeps them."""
    geoms = zip(mujoco_model.pair_geom1, mujoco_model.pair_geom2, strict=True)
    return np.array([[CAPSULES.index(mujoco_model.geom(g).name) for g in pair] for pair in geoms])


def keep_own(model, target: np.ndarray) -> None:
    """Lets every pair of parts lie in each other as deep as they do in the target (J, 4): a clip keeps its own."""
    depths_into(PARENT, model.body.offset_m, target, model.capsules, model.pairs, model.mujoco_model.pair_margin)
    np.negative(model.mujoco_model.pair_margin, out=model.mujoco_model.pair_margin)


def hold(model, qpos_before: np.ndarray, target: np.ndarray, limp: float, h: float) -> None:
    """Corrects the step of h seconds that MuJoCo's data has just taken from `qpos_before`, velocities and places.

    target (J, 4): a limit that it oversteps is moved out to it. limp, 0 to 1: how far slow motion is left to ligaments
    and soft contacts, which know of the floor: else a limp body that lies on its hands would never come to rest. Uses
    the mass matrix of that step, servos included.
    """
    m, d, body = model.mujoco_model, model.data, model.body
    rows, least = np.zeros((MOST_ROWS, m.nv)), np.empty(MOST_ROWS)
    count = find(
        PARENT, body.offset_m, body.limit_low_rad, body.limit_high_rad, target, model.capsules, model.pairs,
        qpos_before, d.qvel, max(EASE_S, h), limp, FARTHEST_M, NEAR_RAD, rows, least,
    )  # fmt: skip
    if count == 0:
        return
    rows, least = rows[:count], least[:count]
    answers = np.empty_like(rows)
    mujoco.mj_solveM(m, d, answers, rows)
    if meet(rows, answers, least, d.qvel):
        d.qpos[:] = qpos_before
        mujoco.mj_integratePos(m, d.qpos, d.qvel, h)


def braces(model, qpos: np.ndarray, towards: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The stops that touch already and hold against a change of velocities (nv,): rows (N, nv) and M^-1 rows.

    A hand that lies on the head gives way to a ball no more than the head does. Needs MuJoCo's data at that pose.
    """
    m, body = model.mujoco_model, model.body
    rows, least = np.zeros((MOST_ROWS, m.nv)), np.empty(MOST_ROWS)
    count = find(
        PARENT, body.offset_m, body.limit_low_rad, body.limit_high_rad, qpos[3:].reshape(JOINT_COUNT, 4),
        model.capsules, model.pairs, qpos, towards, np.inf, 0.0, TOUCHING_M, TOUCHING_RAD, rows, least,
    )  # fmt: skip
    rows = rows[:count]
    answers = np.empty_like(rows)
    if count:
        mujoco.mj_solveM(m, model.data, answers, rows)
        holds = impulses(rows, answers, np.zeros(count), towards) > 0.0
        rows, answers = np.ascontiguousarray(rows[holds]), np.ascontiguousarray(answers[holds])
    return rows, answers


@njit(cache=True)
def braced(rows, answers, changes):
    """Changes of velocity (K, nv) as they are when no row (N, nv) moves for them, in place. answers: M^-1 rows.

    One row after the other, each made independent of those before it (Gram and Schmidt, in the metric of M^-1); a row
    that says nothing new is passed over.
    """
    rows, answers = rows.copy(), answers.copy()
    for a in range(len(rows)):
        gave = _rate(rows[a], answers[a])
        for b in range(a):
            _without(rows[a], answers[a], rows[b], answers[b])
        gives = _rate(rows[a], answers[a])
        if gives < max(LEAST_GIVE, LEAST_NEW * gave):
            rows[a], answers[a] = 0.0, 0.0
            continue
        scale = 1.0 / math.sqrt(gives)
        rows[a], answers[a] = rows[a] * scale, answers[a] * scale
        for change in changes:
            rate = _rate(rows[a], change)
            for k in range(len(change)):
                change[k] -= answers[a, k] * rate


@inner_kernel
def _without(row, answer, other_row, other_answer):
    """Takes out of a row, and its answer, what another of unit length has of it. In place."""
    share = _rate(row, other_answer)
    for k in range(len(row)):
        row[k] -= other_row[k] * share
        answer[k] -= other_answer[k] * share


@njit(cache=True)
def depths_into(parent, offset_m, rotations, capsules, pairs, out):
    """How deep the parts of each pair (P, 2) lie in each other in a pose, metres, 0 where they are apart."""
    qpos = np.zeros(3 + 4 * JOINT_COUNT)
    for joint in range(JOINT_COUNT):
        for k in range(4):
            qpos[3 + 4 * joint + k] = rotations[joint, k]
    ends = capsules_at(capsules, *world_frames(parent, offset_m, qpos))
    for n in range(len(pairs)):
        a, b = pairs[n]
        gap_m = _nearest(ends[a], ends[b], capsules.radius_m[a] + capsules.radius_m[b])[2]
        out[n] = max(0.0, -gap_m)


@njit(cache=True)
def find(
    parent,
    offset_m,
    low,
    high,
    target,
    capsules,
    pairs,
    qpos,
    qvel,
    ease_s,
    limp,
    farthest_m,
    farthest_rad,
    rows,
    least,
):
    """Fills in the rows (N, nv), zero before, and bounds (N,) of all stops that are broken or nearly so; how many.

    No stop that is farther off than farthest_m or farthest_rad is looked at.
    """
    positions, orientations = world_frames(parent, offset_m, qpos)
    count = 0
    for j in range(1, JOINT_COUNT):
        count = _limits_of(j, qpos, qvel, low[j], high[j], target[j], ease_s, limp, farthest_rad, rows, least, count)
    ends = capsules_at(capsules, positions, orientations)
    for n in range(len(pairs)):
        if count == len(least):
            break
        a, b = pairs[n, 0], pairs[n, 1]
        on_a, on_b, gap_m = _nearest(ends[a], ends[b], capsules.radius_m[a] + capsules.radius_m[b])
        apart_m = vector.distance(on_a, on_b)
        if gap_m > farthest_m or apart_m < LEAST_APART_M:
            continue
        normal = vector.scale(vector.subtract(on_a, on_b), 1.0 / apart_m)
        row = rows[count]
        _add_place(parent, positions, orientations, capsules.joint[a], on_a, normal, 1.0, row)
        _add_place(parent, positions, orientations, capsules.joint[b], on_b, normal, -1.0, row)
        least[count] = -max(gap_m, 0.0) / ease_s - limp * CREEP_MPS
        if _rate(row, qvel) < least[count] + NEAR_MPS:
            count += 1
        else:
            row[:] = 0.0
    return count


@njit(cache=True)
def _nearest(ends, other_ends, radii_m):
    """The nearest places of two capsules' axes, and the gap between their surfaces, negative inside."""
    s, t = shapes.nearest_between(ends[0], ends[1], other_ends[0], other_ends[1])
    one, other = vector.mix(ends[0], ends[1], s), vector.mix(other_ends[0], other_ends[1], t)
    return one, other, vector.distance(one, other) - radii_m


@njit(cache=True)
def _rate(row, qvel):
    """How fast what a row is of grows."""
    rate = 0.0
    for k in range(len(row)):
        rate += row[k] * qvel[k]
    return rate


@inner_kernel
def _add_place(parent, positions, orientations, joint, place, normal, sign, row):
    """Adds to a row how fast a place on a part moves along a normal, per generalised velocity."""
    j = joint
    while j >= 0:
        arm = vector.subtract(place, positions[j])
        turning = quaternion.unrotate(orientations[j], vector.cross(arm, normal))
        for axis in range(3):
            row[3 + 3 * j + axis] += sign * turning[axis]
        j = parent[j]
    for axis in range(3):
        row[axis] += sign * normal[axis]


@inner_kernel
def _limits_of(j, qpos, qvel, low, high, target, ease_s, limp, farthest_rad, rows, least, count):
    """Adds the rows of one joint's limits, those that the target oversteps moved out to it: all that are not far, if
    one is broken, since what holds that one turns into the others."""
    a, v = 3 + 4 * j, 3 + 3 * j
    q = quaternion.normalise((qpos[a], qpos[a + 1], qpos[a + 2], qpos[a + 3]))
    now, aim = components(q), components(target)
    if now[0] * now[0] + now[1] * now[1] > MOST_SWING_RAD**2:
        return count
    near = False
    for k in range(3):
        near |= min(now[k] - min(low[k], aim[k]), max(high[k], aim[k]) - now[k]) <= farthest_rad
    if not near:
        return count
    turned = (
        components(quaternion.multiply(q, quaternion.from_rotation_vector((NUDGE_RAD, 0.0, 0.0)))),
        components(quaternion.multiply(q, quaternion.from_rotation_vector((0.0, NUDGE_RAD, 0.0)))),
        components(quaternion.multiply(q, quaternion.from_rotation_vector((0.0, 0.0, NUDGE_RAD)))),
    )
    first, broken = count, False
    for k in range(3):
        for sign in (1.0, -1.0):
            room = now[k] - min(low[k], aim[k]) if sign > 0.0 else max(high[k], aim[k]) - now[k]
            if room > farthest_rad or count == len(least):
                continue
            rate = 0.0
            for axis in range(3):
                slope = sign * (turned[axis][k] - now[k]) / NUDGE_RAD
                rows[count, v + axis] = slope
                rate += slope * qvel[v + axis]
            least[count] = -max(room, 0.0) / ease_s - limp * CREEP_RADPS
            broken |= rate < least[count]
            count += 1
    if broken:
        return count
    rows[first:count, v : v + 3] = 0.0
    return first


@njit(cache=True)
def meet(rows, answers, least, qvel):
    """Changes velocities (nv,) so that every bound is met; False if they all were. answers (N, nv): M^-1 rows."""
    broken = False
    for a in range(len(rows)):
        broken |= _rate(rows[a], qvel) < least[a]
    if not broken:
        return False
    impulse = impulses(rows, answers, least, qvel)
    for a in range(len(rows)):
        for k in range(len(qvel)):
            qvel[k] += answers[a, k] * impulse[a]
    return True


@njit(cache=True)
def impulses(rows, answers, least, qvel):
    """(N,) the impulses along the rows, none negative, that bring all rates to their bounds or above."""
    count = len(rows)
    gives, rate, impulse = _gives(rows, answers), np.empty(count), np.zeros(count)
    for a in range(count):
        rate[a] = _rate(rows[a], qvel)
    for _ in range(SWEEPS):
        for a in range(count):
            if gives[a, a] < LEAST_GIVE:
                continue
            wanted = max(0.0, impulse[a] + (least[a] - rate[a]) / gives[a, a])
            change = wanted - impulse[a]
            impulse[a] = wanted
            for b in range(count):
                rate[b] += gives[b, a] * change
    return impulse


@inner_kernel
def _gives(rows, answers):
    """(N, N) how the rates of the rows answer to impulses along them: rows M^-1 rows^T."""
    out = np.empty((len(rows), len(rows)))
    for a in range(len(rows)):
        for b in range(len(rows)):
            out[a, b] = _rate(rows[a], answers[b])
    return out
