"""Seams: the ticks at which one source of poses takes over from another, and what is left of the old motion there.

Before a character's phase, clip or blend is changed, what is shown a moment before the seam is asked of the old source; after the
change `begin_seam` measures what that motion has beyond the new one. The arithmetic is in `behaviours.inertialise`.
"""

from __future__ import annotations

import numpy as np

from behaviours import inertialise
from behaviours.components import Posture, Residual
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, Pose

MOMENT = 1.0 / 64.0  # of a tick: short enough for a velocity, long enough for its digits
STILL = 1e-4  # metres and radians: below this nothing is left to see
ANKLE_ROWS = list(ANKLES)


def shown(world, row: int) -> tuple[Pose, Pose]:
    """The pose shown at the last tick, and the one before it."""
    p = world[Posture]
    return (
        Pose(p.root_m[row].copy(), p.rotations[row].copy()),
        Pose(p.before_root_m[row].copy(), p.before_rotations[row].copy()),
    )


def begin_seam(world, row: int, tick: int, body, shown_before: Pose, source, source_before, goals, goals_before) -> None:
    """Keeps what the shown motion has beyond the new source.

    `source`: the new source's pose at the last tick; `goals`: where its feet are to be then (FootGoals); `..._before`: the same,
    and what was shown, a MOMENT before. The shown velocity is thus the old source's own, one-sided.
    """
    now, _ = shown(world, row)
    r = world[Residual]
    r.since[row] = tick - 1
    inertialise.measure_seam(
        source.root_m,
        source.rotations,
        source_before.root_m,
        source_before.rotations,
        now.root_m,
        now.rotations,
        shown_before.root_m,
        shown_before.rotations,
        MOMENT * TICK_S,
        r.root[row],
        r.joints[row],
    )
    _keep_ankles(r, row, body, now, shown_before, goals, goals_before)


def _keep_ankles(residual, row, body, now, before, goals, goals_before) -> None:
    at, turned = _ankles(body, now)
    at_before, turned_before = _ankles(body, before)
    for side in range(2):
        offset = at[side] - goals.ankle_m[side]
        residual.ankles[row, 0, side] = offset
        residual.ankles[row, 1, side] = (offset - (at_before[side] - goals_before.ankle_m[side])) / (MOMENT * TICK_S)
        turn = np.array(inertialise.turn_from(goals.turned[side], turned[side]))
        was = np.array(inertialise.turn_from(goals_before.turned[side], turned_before[side]))
        residual.ankle_turns[row, 0, side] = turn
        residual.ankle_turns[row, 1, side] = (turn - was) / (MOMENT * TICK_S)


def _ankles(body, pose: Pose) -> tuple[np.ndarray, np.ndarray]:
    positions, orientations = joints_of(body, pose)
    return positions[ANKLE_ROWS], orientations[ANKLE_ROWS]


def elapsed_s(world, row: int, tick: float) -> float:
    """Time since the last seam."""
    return float(tick - world[Residual].since[row]) * TICK_S


def is_over(world, row: int, tick: int, half_life_s: float) -> bool:
    """Whether nothing of the last seam can be seen any more."""
    return elapsed_s(world, row, tick) > 14.0 * half_life_s


def foot_is_still(world, row: int, side: int, tick: int, half_life_s: float) -> bool:
    """Whether what is left of the last seam can no longer move this foot."""
    r = world[Residual]
    t, y = elapsed_s(world, row, tick), 2.0 * np.log(2.0) / half_life_s
    left = np.abs(r.ankles[row, 0, side]).sum() * (1.0 + y * t) + np.abs(r.ankles[row, 1, side]).sum() * max(t, 1.0 / y)
    return bool(left * np.exp(-y * t) < STILL * 10.0)

