"""What each foot is about: it goes with the pose, is held where it stands, or makes one step.

A foot that stands is held by leg IK, to the last bit in the same place; one that must move is lifted on an arc, never
dragged (thesis 3.3, specification A4). The plan lives in the `Feet` columns; these functions read and write one row.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.blends.held_feet import FootGoals
from behaviours.components import FootMode
from behaviours.timing import arc, ease
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, TOES
from engine.maths import quaternion, vector
from engine.maths.kernel import njit

FREE, HELD, STEPPING = int(FootMode.FREE), int(FootMode.HELD), int(FootMode.STEPPING)

LIFTED, LANDS = (
    0.35,
    0.6,
)  # shares of a step: up to the first a foot that stood still bears, from the second on it does again


@njit(cache=True)
def goals_at(tick, mode, ankle_m, turned, toe, from_m, from_turned, from_toe, from_down, lift_m, since, ticks):
    """Where both feet are to be at a tick: FootGoals. Arrays are one row of the `Feet` columns, left first."""
    goal_m = np.empty((2, 3))
    goal_turned, goal_toe = np.empty((2, 4)), np.empty((2, 4))
    bound, bears = np.empty(2, np.bool_), np.empty(2)
    for side in range(2):
        bound[side] = mode[side] != FREE
        bears[side] = 1.0 if mode[side] == HELD else 0.0
        progress = 1.0 if mode[side] != STEPPING else (tick - since[side]) / ticks[side]
        eased = ease(progress)
        if mode[side] == STEPPING:
            bears[side] = max(
                from_down[side] * (1.0 - ease(progress / LIFTED)), ease((progress - LANDS) / (1.0 - LANDS))
            )
        place = vector.mix(from_m[side], ankle_m[side], eased)
        q = quaternion.slerp(from_turned[side], turned[side], eased)
        bent = quaternion.slerp(from_toe[side], toe[side], eased)
        if progress >= 1.0:
            place = (ankle_m[side, 0], ankle_m[side, 1], ankle_m[side, 2])
            q = (turned[side, 0], turned[side, 1], turned[side, 2], turned[side, 3])
            bent = (toe[side, 0], toe[side, 1], toe[side, 2], toe[side, 3])
        goal_m[side, 0], goal_m[side, 1], goal_m[side, 2] = place
        goal_m[side, 2] += lift_m[side] * arc(progress)
        goal_turned[side, 0], goal_turned[side, 1], goal_turned[side, 2], goal_turned[side, 3] = q
        goal_toe[side, 0], goal_toe[side, 1], goal_toe[side, 2], goal_toe[side, 3] = bent
    return FootGoals(goal_m, goal_turned, goal_toe, bound, bears)


class Footing(NamedTuple):
    """How a foot is placed. World; the toe in the ankle's frame."""

    ankle_m: np.ndarray  # (3,)
    turned: np.ndarray  # (4,)
    toe: np.ndarray  # (4,)


def goals_of(feet, row: int, tick: float, clips: tuple[Footing, Footing] | None = None) -> FootGoals:
    """The goals of one character's feet at a tick; of one that goes on with the clip, on its way to where it is in that
    just then, if `clips` says where both are.
    """
    ankle_m, turned, toe = feet.ankle_m[row], feet.turned[row], feet.toe[row]
    if clips is not None and feet.goes_on[row].any():
        ankle_m, turned, toe = ankle_m.copy(), turned.copy(), toe.copy()
        for side in range(2):
            if feet.goes_on[row, side]:
                ankle_m[side], turned[side], toe[side] = clips[side]
    return goals_at(
        float(tick),
        feet.mode[row],
        ankle_m,
        turned,
        toe,
        feet.from_m[row],
        feet.from_turned[row],
        feet.from_toe[row],
        feet.from_down[row],
        feet.lift_m[row],
        feet.since[row],
        feet.ticks[row],
    )


def let_go(feet, row: int, side: int) -> None:
    """The foot goes with the pose from now on."""
    feet.mode[row, side] = FREE
    feet.goes_on[row, side] = False


def footing_of(body, pose, side: int) -> Footing:
    """The foot of a pose."""
    positions, orientations = joints_of(body, pose)
    return Footing(positions[ANKLES[side]], orientations[ANKLES[side]], np.array(pose.rotations[TOES[side]]))


def planned(feet, row: int, side: int) -> Footing:
    """Where a foot is held, or steps to."""
    return Footing(feet.ankle_m[row, side].copy(), feet.turned[row, side].copy(), feet.toe[row, side].copy())


def hold(feet, row: int, side: int, at: Footing) -> None:
    """The foot stands here, and stays."""
    feet.mode[row, side] = HELD
    feet.ankle_m[row, side], feet.turned[row, side], feet.toe[row, side] = at
    feet.from_m[row, side], feet.from_turned[row, side], feet.from_toe[row, side] = at
    feet.lift_m[row, side] = 0.0
    feet.goes_on[row, side] = False


def step(feet, row: int, side: int, start: Footing, end: Footing, tick: int, ticks: float, balance) -> None:
    """One step from where the foot is to a place and turn, lifted by how far it goes."""
    feet.mode[row, side] = STEPPING
    feet.from_m[row, side], feet.from_turned[row, side], feet.from_toe[row, side] = start
    feet.ankle_m[row, side], feet.turned[row, side], feet.toe[row, side] = end
    feet.since[row, side], feet.ticks[row, side] = tick, ticks
    feet.goes_on[row, side] = False
    feet.from_down[row, side] = float(feet.planted[row, side])
    far = vector.distance(feet.from_m[row, side], feet.ankle_m[row, side])
    # full height from the distance at which a foot counts as moved; below that in proportion, so nothing pops
    feet.lift_m[row, side] = balance.lift_height_m * min(1.0, far / (2.0 * balance.lift_over_m))


def hold_or_step(feet, row: int, side: int, start: Footing, end: Footing, tick: int, ticks: float, balance) -> None:
    """Holds a foot that is as good as there already; else steps it there. It stands until `tick`, if that is yet to
    come.
    """
    if as_good_as(start, end, balance):
        hold(feet, row, side, start)
    else:
        step(feet, row, side, start, end, tick, ticks, balance)


def as_good_as(one: Footing, other: Footing, balance) -> bool:
    """Whether a foot that is in one place is as good as in the other already."""
    near = vector.distance(one.ankle_m, other.ankle_m) < balance.foot_tolerance_m * 10.0
    return bool(near and quaternion.angle_between(one.turned, other.turned) < math.radians(0.5))


def stands(feet, row: int, side: int, tick: int) -> bool:
    """Whether a foot is on the ground by the plan: held, or its step has not begun."""
    waiting = feet.mode[row, side] == STEPPING and tick <= feet.since[row, side]
    return bool(feet.mode[row, side] == HELD or waiting)


def land_finished_steps(feet, rows, tick: int) -> None:
    """Feet whose step is over stand from now on, but for those that go on with the clip."""
    for row in rows:
        for side in range(2):
            if feet.goes_on[row, side]:
                continue
            if feet.mode[row, side] == STEPPING and tick - feet.since[row, side] >= feet.ticks[row, side]:
                hold(feet, row, side, planned(feet, row, side))
