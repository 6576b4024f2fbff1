"""Seams: the ticks at which one source of poses takes over from another, and what is left of the old motion there.

`begin_seam` is called once a character's phase, clip or blend has been changed for this tick; it measures what the shown
motion had beyond the new source at the last two ticks. `engine`-free arithmetic is in `behaviours.inertialise`.
"""

from __future__ import annotations

import numpy as np

from behaviours import inertialise
from behaviours.components import Posture, Residual
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, Pose

STILL = 1e-4  # metres and radians: below this nothing is left to see
ANKLE_ROWS = list(ANKLES)


def shown(world, row: int) -> tuple[Pose, Pose]:
    """The pose shown at the last tick, and the one before it."""
    p = world[Posture]
    return (
        Pose(p.root_m[row].copy(), p.rotations[row].copy()),
        Pose(p.before_root_m[row].copy(), p.before_rotations[row].copy()),
    )


def begin_seam(world, row: int, tick: int, body, source, source_before, goals, goals_before) -> None:
    """Keeps what the shown motion has beyond the new source.

    `source`, `source_before`: the new source's poses at the last two ticks that were shown; `goals`, `goals_before`: where
    its feet are to be then (FootGoals).
    """
    now, before = shown(world, row)
    r = world[Residual]
    r.since[row] = tick - 1
    inertialise.measure_seam(
        source.root_m,
        source.rotations,
        source_before.root_m,
        source_before.rotations,
        now.root_m,
        now.rotations,
        before.root_m,
        before.rotations,
        TICK_S,
        r.root[row],
        r.joints[row],
    )
    _keep_ankles(r, row, body, now, before, goals, goals_before)


def _keep_ankles(residual, row, body, now, before, goals, goals_before) -> None:
    at, turned = _ankles(body, now)
    at_before, turned_before = _ankles(body, before)
    for side in range(2):
        offset = at[side] - goals.ankle_m[side]
        residual.ankles[row, 0, side] = offset
        residual.ankles[row, 1, side] = (offset - (at_before[side] - goals_before.ankle_m[side])) / TICK_S
        turn = np.array(inertialise.turn_from(goals.turned[side], turned[side]))
        was = np.array(inertialise.turn_from(goals_before.turned[side], turned_before[side]))
        residual.ankle_turns[row, 0, side] = turn
        residual.ankle_turns[row, 1, side] = (turn - was) / TICK_S


def _ankles(body, pose: Pose) -> tuple[np.ndarray, np.ndarray]:
    positions, orientations = joints_of(body, pose)
    return positions[ANKLE_ROWS], orientations[ANKLE_ROWS]


def forget_velocity(world, row: int) -> None:
    """Keeps only the offsets of a seam: the new source already moves as the old one did."""
    r = world[Residual]
    for column in (r.root, r.joints, r.ankles, r.ankle_turns):
        column[row, 1] = 0.0


def elapsed_s(world, row: int, tick: int) -> float:
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

