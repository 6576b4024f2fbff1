"""Seams: the ticks at which one source of poses takes over from another, and what is left of the old motion there.

Before a character's phase, clip or blend is changed, what is shown a moment before the seam is asked of the old
source; after the change `begin_seam` measures what that motion has beyond the new one. The arithmetic is in
`behaviours.settle.inertialise`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.blends.held_feet import FootGoals, legs_to
from behaviours.blends.leg_limits import EARLY_RAD
from behaviours.blends.pushed_out import deeper_into
from behaviours.components import Posture, Residual
from behaviours.playing import capsules_of
from behaviours.settle import inertialise
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.body.limits import beyond_limits
from engine.body.skeleton import ANKLES, TOES, Body, Pose
from engine.maths.kernel import njit

MOMENT = 1.0 / 512.0  # of a tick: short enough for a velocity, long enough for its digits
STILL_FOOT_M = 5e-4  # a foot that goes no farther than this stands
FOOT_LEVER_M, TOE_LEVER_M = 0.25, 0.08  # from the ankle, and the toe's joint, to the farthest point of the sole
ANKLE_ROWS = list(ANKLES)


def shown(world, row: int) -> tuple[Pose, Pose]:
    """The pose shown at the last tick, and the one before it."""
    p = world[Posture]
    return (
        Pose(p.root_m[row].copy(), p.rotations[row].copy()),
        Pose(p.before_root_m[row].copy(), p.before_rotations[row].copy()),
    )


class Moving(NamedTuple):
    """A source, or what it shows, at the last tick and a moment later, with the places of its ankles."""

    pose: Pose
    later: Pose
    goals: FootGoals
    goals_later: FootGoals


def begin_seam(world, row: int, tick: int, body: Body, shown_before: Pose, source: Moving) -> None:
    """Keeps what the shown motion has beyond the new source.

    `shown_before` is what was shown a MOMENT before the last tick. So the shown velocity is the old source's own, up
    to the seam, and the new one's is its own from there on.
    """
    now, _ = shown(world, row)
    ahead = Pose(np.empty_like(now.root_m), np.empty_like(now.rotations))
    inertialise.carry_on(*now, *shown_before, *ahead)
    r, moment_s = world[Residual], MOMENT * TICK_S
    r.since[row] = tick - 1
    inertialise.measure_seam(*source.pose, *source.later, *now, *ahead, moment_s, r.root[row], r.joints[row])
    inertialise.calm_legs(r.joints[row])
    deeper_into(body, capsules_of(world, row), source.pose.rotations, now.rotations, r.deeper_m[row])
    low, high = body.limit_low_rad + EARLY_RAD, body.limit_high_rad - EARLY_RAD
    r.beyond[row, 0] = beyond_limits(low, high, now.rotations)
    r.beyond[row, 1] = (beyond_limits(low, high, ahead.rotations) - r.beyond[row, 0]) / moment_s
    _keep_ankles(r, row, body, now, ahead, source, moment_s)


def _keep_ankles(residual, row: int, body: Body, now: Pose, ahead: Pose, source: Moving, moment_s: float) -> None:
    at, turned = _ankles(body, now)
    at_later, turned_later = _ankles(body, ahead)
    stretch = np.subtract(legs_to(body, *now, at), legs_to(body, *source.pose, source.goals.ankle_m))
    later = np.subtract(legs_to(body, *ahead, at_later), legs_to(body, *source.later, source.goals_later.ankle_m))
    residual.stretch[row] = stretch, (later - stretch) / moment_s
    for side in range(2):
        offset = at[side] - source.goals.ankle_m[side]
        residual.ankles[row, 0, side] = offset
        residual.ankles[row, 1, side] = (at_later[side] - source.goals_later.ankle_m[side] - offset) / moment_s
        turn = np.array(inertialise.turn_from(source.goals.turned[side], turned[side]))
        to_be = np.array(inertialise.turn_from(source.goals_later.turned[side], turned_later[side]))
        residual.ankle_turns[row, 0, side] = turn
        residual.ankle_turns[row, 1, side] = (to_be - turn) / moment_s


def _ankles(body, pose: Pose) -> tuple[np.ndarray, np.ndarray]:
    positions, orientations = joints_of(body, pose)
    return positions[ANKLE_ROWS], orientations[ANKLE_ROWS]


def elapsed_s(world, row: int, tick: float) -> float:
    """Time since the last seam."""
    return float(tick - world[Residual].since[row]) * TICK_S


def is_over(world, row: int, tick: float, half_life_s: float) -> bool:
    """Whether nothing of the last seam can be seen any more."""
    return elapsed_s(world, row, tick) > 14.0 * half_life_s


def foot_is_still(world, row: int, side: int, tick: int, half_life_s: float) -> bool:
    """Whether what is left of the last seam can no longer move this foot, place or sole."""
    r = world[Residual]
    toe = r.joints[row, :, TOES[side]]
    most_m = still_moves_m(
        r.ankles[row, :, side], r.ankle_turns[row, :, side], toe, elapsed_s(world, row, tick), half_life_s
    )
    return most_m < STILL_FOOT_M


@njit(cache=True)
def still_moves_m(ankle, ankle_turn, toe, elapsed_s, half_life_s):
    """The most that what is left of a foot's residuals, (2, 3) each, offset and velocity, can still move it; metres."""
    y, offsets, speeds = 2.0 * math.log(2.0) / half_life_s, 0.0, 0.0
    for k in range(3):
        offsets += abs(ankle[0, k]) + FOOT_LEVER_M * abs(ankle_turn[0, k]) + TOE_LEVER_M * abs(toe[0, k])
        speeds += abs(ankle[1, k]) + FOOT_LEVER_M * abs(ankle_turn[1, k]) + TOE_LEVER_M * abs(toe[1, k])
    return (offsets * (1.0 + y * elapsed_s) + speeds * max(elapsed_s, 1.0 / y)) * math.exp(-y * elapsed_s)
