"""The feet on the way to the sustained pose: one that stands stays, one in the air steps and is soon down, and who is
in flight lands first.

A step that ends early puts the foot where the body is yet to come. So the soonest is taken of a few durations at which
the legs reach, without being snatched straight, and the blend keeps what it promises: the COM on its line, joints
within limits.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from behaviours.blends.blending import BlendEnd
from behaviours.components import Blend, Feet, Sustained
from behaviours.playing import body_of, clip_time_s, planted_in_clip
from behaviours.settle import feet as foot_plan
from behaviours.settle.sources import blend_ends, blended_pose, choose_hand_ways
from behaviours.timing import TICK_S, whole_ticks
from engine.body.kinematics import com_of, joints_of
from engine.body.limits import excess_rad
from engine.body.skeleton import HEAD, HIPS, JOINT_COUNT, KNEES, PELVIS, Pose
from engine.maths import vector

STEP_SHARE = 0.9  # of the time to contact: a foot stands before the blow comes
TRIES = 5  # durations of a step that are tried, the soonest first
MOMENTS = 10  # of the blend that are looked at, from when the foot begins to bear again
TOLERATED_M, TOLERATED_RAD = 0.003, math.radians(0.3)
SNATCHED_MPS = 3.5  # a knee that changes its velocity by more from one tick to the next pops
WORTH_A_STEP = 0.5  # of the trouble of standing still: more than that, and a foot had rather stand
CARRYING = tuple(j for j in range(PELVIS, JOINT_COUNT) if j <= HEAD or j >= HIPS[0])  # trunk, neck, head and legs


def step_into(world, row: int, tick: int, now: Pose, to: Pose, takes: float) -> None:
    """Plans the steps of the present blend, which takes so many ticks, from a pose to another; chooses the hands'
    ways.
    """
    plan, latest = partial(plan_steps, world, row, tick, now, to), STEP_SHARE * takes
    plan(latest)
    choose_hand_ways(world, row)
    if hasten_steps(world, row, tick, plan, latest):
        choose_hand_ways(world, row)
    elif (world[Feet].mode[row] == foot_plan.HELD).all():
        relieve_a_foot(world, row, tick, to, latest)


def plan_steps(world, row: int, tick: int, now: Pose, to: Pose, ticks: float) -> None:
    """Each foot is held where a pose has it now, or steps to where another has it."""
    body, f = body_of(world, row), world[Feet]
    for side in range(2):
        start, end = foot_plan.footing_of(body, now, side), foot_plan.footing_of(body, to, side)
        if not world[Sustained].held[row, side]:
            foot_plan.let_go(f, row, side)
        else:
            foot_plan.hold_or_step(f, row, side, start, end, tick - 1, ticks, world.assets.settings.balance)


def hasten_steps(world, row: int, tick: int, plan: Callable[[float], None], latest: float) -> bool:
    """Plans the steps anew, by `plan`, as short as they can be stood in; returns whether that is shorter than `latest`.
    Ticks.
    """
    soonest = whole_ticks(world.assets.settings.balance.step_s)
    if soonest >= latest or not (world[Feet].mode[row] == foot_plan.STEPPING).any():
        return False
    for ticks in np.linspace(soonest, latest, TRIES)[:-1]:
        plan(float(ticks))
        calm = trouble(world, row, tick, float(ticks), 1.0) <= 1.0
        if calm and knees_snatched_mps(world, row, tick, float(ticks)) <= SNATCHED_MPS:
            return True
    plan(latest)
    return False


def relieve_a_foot(world, row: int, tick: int, to: Pose, ticks: float) -> None:
    """Where both feet stand and the blend would suffer from it, one steps in place, if that helps: it bears nothing
    for a while, and its heel may rise.
    """
    held = trouble(world, row, tick, 0.0)
    if held <= 1.0:
        return
    stepping = []
    for side in range(2):
        at = foot_plan.planned(world[Feet], row, side)
        step_in_place(world, row, tick, side, to, ticks)
        stepping.append(trouble(world, row, tick, 0.0))
        foot_plan.hold(world[Feet], row, side, at)
    side = int(np.argmin(stepping))
    if stepping[side] < WORTH_A_STEP * held:
        step_in_place(world, row, tick, side, to, ticks)


def step_in_place(world, row: int, tick: int, side: int, to: Pose, ticks: float) -> None:
    """A foot that stands is not held for a while, and stands again where a pose has it."""
    f, body = world[Feet], body_of(world, row)
    at, end = foot_plan.planned(f, row, side), foot_plan.footing_of(body, to, side)
    foot_plan.step(f, row, side, at, end, tick - 1, ticks, world.assets.settings.balance)
    f.from_down[row, side] = 1.0


def trouble(world, row: int, tick: int, ticks: float, most: float = math.inf) -> float:
    """How far the blend goes off the COM's line, and joints beyond their limits, from when the feet of steps that take
    so long begin to bear again: the worst of either, 1 being what is tolerated. Whatever is above `most` is as bad.
    """
    body, b, worst = body_of(world, row), world[Blend], 0.0
    start, end = blend_ends(world, row, tick)
    own = np.maximum(_beyond(body, _pose(start)), _beyond(body, _pose(end)))
    first = (tick - 1 + foot_plan.LANDS * ticks - b.since[row]) / b.ticks[row]
    for progress in np.linspace(first, 1.0, MOMENTS, endpoint=False):
        pose = blended_pose(world, row, b.since[row] + progress * b.ticks[row])
        off = _off_line_m(com_of(body, pose), start, end) / TOLERATED_M
        worst = max(worst, off, float((_beyond(body, pose) - own).max()) / TOLERATED_RAD)
        if worst > most:
            break
    return worst


def knees_snatched_mps(world, row: int, tick: int, ticks: float) -> float:
    """The greatest change of either knee's velocity from one tick of the blend to the next, from when the feet of steps
    that take so long begin to bear again until they stand, m/s: a leg that reaches only just, and fast, snaps straight.
    """
    body, since = body_of(world, row), tick - 1
    landing = np.arange(math.floor(since + foot_plan.LANDS * ticks), math.ceil(since + ticks) + 1)
    knees_m = np.array([joints_of(body, blended_pose(world, row, float(at)))[0][list(KNEES)] for at in landing])
    change_m = np.diff(knees_m, 2, axis=0)
    return float(np.linalg.norm(change_m, axis=2).max(initial=0.0)) / TICK_S


def land(world, row: int, tick: int, now: Pose, to: Pose, left: float) -> None:
    """Who flew until the last tick lands, and has so many ticks left up to contact: the feet that stand in the clip
    there are held where a pose is to have them, the others step.
    """
    body, f = body_of(world, row), world[Feet]
    standing = np.flatnonzero(planted_in_clip(world, row, clip_time_s(world, row, tick - 1)))

    def plan(ticks: float) -> None:
        plan_steps(world, row, tick, now, to, ticks)
        for side in standing:
            foot_plan.hold(f, row, int(side), foot_plan.footing_of(body, to, int(side)))

    plan(STEP_SHARE * left)
    hasten_steps(world, row, tick, plan, STEP_SHARE * left)


def _pose(end: BlendEnd) -> Pose:
    return Pose(end.root_m, end.rotations)


def _beyond(body, pose: Pose) -> np.ndarray:
    """How far all joints but those of the arms are beyond their limits, radians."""
    return np.maximum(excess_rad(body, pose.rotations)[list(CARRYING)], 0.0)


def _off_line_m(com_m, start: BlendEnd, end: BlendEnd) -> float:
    """How far a COM is off the straight line between those of the two ends."""
    line = vector.unit(vector.subtract(end.com_m, start.com_m), (0.0, 0.0, 0.0))
    away = vector.subtract((com_m[0], com_m[1], com_m[2]), start.com_m)
    return float(vector.length(vector.reject(away, line)))
