"""Stops: what a body cannot do, however hard it is struck. No joint goes past its limits
(`engine.physics.limit_stops`), no part into another (`engine.physics.part_stops`).

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

from engine.body.skeleton import JOINT_COUNT, PARENT
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.physics.limit_stops import NEAR_RAD, TOUCHING_RAD, limits_into
from engine.physics.part_stops import FARTHEST_M, TOUCHING_M, parts_into
from engine.physics.rows import MOST_ROWS, rate_of

EASE_S = 0.006
SWEEPS = 40
PASSES = 3  # what holds one joint may turn another, which was not in view, past its own stop
LEAST_GIVE = 1e-9  # 1 / kg, 1 / kg m^2: what gives less is no stop, its row is all but nothing
LEAST_NEW = 1e-8  # of what it gives: the rest of a row that others leave


def hold(model, qpos_before: np.ndarray, target: np.ndarray, limp: float, h: float) -> None:
    """Corrects the step of h seconds that MuJoCo's data has just taken from `qpos_before`, velocities and places.

    target (J, 4): a limit that it oversteps is moved out to it. limp, 0 to 1: how far slow motion is left to ligaments
    and soft contacts, which know of the floor: else a limp body that lies on its hands would never come to rest. Uses
    the mass matrix of that step, servos included.
    """
    m, d, moved = model.mujoco_model, model.data, False
    for _ in range(PASSES):
        if not _meet_those_in_view(model, qpos_before, target, limp, h):
            break
        moved = True
    if moved:
        d.qpos[:] = qpos_before
        mujoco.mj_integratePos(m, d.qpos, d.qvel, h)


def _meet_those_in_view(model, qpos_before: np.ndarray, target: np.ndarray, limp: float, h: float) -> bool:
    """Changes the velocities in MuJoCo's data so that the stops that they break, or nearly do, are met; whether any was
    broken.
    """
    m, d, body = model.mujoco_model, model.data, model.body
    rows, least = np.zeros((MOST_ROWS, m.nv)), np.empty(MOST_ROWS)
    count = find(
        PARENT, body.offset_m, body.limit_low_rad, body.limit_high_rad, target, model.capsules, model.pairs,
        qpos_before, d.qvel, max(EASE_S, h), h, limp, FARTHEST_M, NEAR_RAD, rows, least,
    )  # fmt: skip
    if count == 0:
        return False
    rows, least = rows[:count], least[:count]
    answers = np.empty_like(rows)
    mujoco.mj_solveM(m, d, answers, rows)
    return bool(meet(rows, answers, least, d.qvel))


def braces(model, qpos: np.ndarray, towards: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The stops that touch already and hold against a change of velocities (nv,): rows (N, nv) and M^-1 rows.

    A hand that lies on the head gives way to a ball no more than the head does. Needs MuJoCo's data at that pose.
    """
    m, body = model.mujoco_model, model.body
    rows, least = np.zeros((MOST_ROWS, m.nv)), np.empty(MOST_ROWS)
    count = find(
        PARENT, body.offset_m, body.limit_low_rad, body.limit_high_rad, qpos[3:].reshape(JOINT_COUNT, 4),
        model.capsules, model.pairs, qpos, towards, np.inf, np.inf, 0.0, TOUCHING_M, TOUCHING_RAD, rows, least,
    )  # fmt: skip
    rows = rows[:count]
    answers = np.empty_like(rows)
    if count:
        mujoco.mj_solveM(m, model.data, answers, rows)
        holds = impulses(rows, answers, np.zeros(count), towards) > 0.0
        rows, answers = np.ascontiguousarray(rows[holds]), np.ascontiguousarray(answers[holds])
    return rows, answers


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
    h,
    limp,
    farthest_m,
    farthest_rad,
    rows,
    least,
):
    """Fills in the rows (N, nv), zero before, and bounds (N,) of all stops that are broken or nearly so; how many.

    No stop that is farther off than farthest_m or farthest_rad is looked at.
    """
    count = limits_into(qpos, qvel, low, high, target, ease_s, limp, farthest_rad, rows, least)
    return parts_into(parent, offset_m, capsules, pairs, qpos, qvel, ease_s, h, limp, farthest_m, rows, least, count)


@njit(cache=True)
def meet(rows, answers, least, qvel):
    """Changes velocities (nv,) so that every bound is met; False if they all were. answers (N, nv): M^-1 rows."""
    broken = False
    for a in range(len(rows)):
        broken |= rate_of(rows[a], qvel) < least[a]
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
        rate[a] = rate_of(rows[a], qvel)
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
            out[a, b] = rate_of(rows[a], answers[b])
    return out


@njit(cache=True)
def braced(rows, answers, changes):
    """Changes of velocity (K, nv) as they are when no row (N, nv) moves for them, in place. answers: M^-1 rows.

    One row after the other, each made independent of those before it (Gram and Schmidt, in the metric of M^-1); a row
    that says nothing new is passed over.
    """
    rows, answers = rows.copy(), answers.copy()
    for a in range(len(rows)):
        gave = rate_of(rows[a], answers[a])
        for b in range(a):
            _without(rows[a], answers[a], rows[b], answers[b])
        gives = rate_of(rows[a], answers[a])
        if gives < max(LEAST_GIVE, LEAST_NEW * gave):
            rows[a], answers[a] = 0.0, 0.0
            continue
        scale = 1.0 / math.sqrt(gives)
        rows[a], answers[a] = rows[a] * scale, answers[a] * scale
        for change in changes:
            rate = rate_of(rows[a], change)
            for k in range(len(change)):
                change[k] -= answers[a, k] * rate


@inner_kernel
def _without(row, answer, other_row, other_answer):
    """Takes out of a row, and its answer, what another of unit length has of it. In place."""
    share = rate_of(row, other_answer)
    for k in range(len(row)):
        row[k] -= other_row[k] * share
        answer[k] -= other_answer[k] * share
