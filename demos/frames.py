"""Frames at a steady rate, out of ticks: what films and exports are made of."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

from engine.core.clock import TICK_RATE_HZ


def frame_count(ticks: int, fps: float) -> int:
    """How many frames that many ticks give, one at either end."""
    return math.floor(ticks * fps / TICK_RATE_HZ + 1e-9) + 1


def frames_of(world, advance: Callable[[], None], ticks: int, fps: float) -> Iterator[float]:
    """Advances a world from tick 0 and stops at every frame: yields how much of the last tick has passed by then."""
    for frame in range(frame_count(ticks, fps)):
        at = frame * TICK_RATE_HZ / fps
        tick = min(math.ceil(at - 1e-9), ticks)
        while world.tick < tick:
            advance()
        yield 1.0 - (tick - at)


def slowed_frames_of(
    world, advance: Callable[[], None], ticks: int, fps: float, pace: Callable[[float], float]
) -> Iterator[float]:
    """`frames_of` with time passing slower at times: `pace` is told how long a frame lasts and answers which share of
    it counts, at the tick that the world has come to.
    """
    at = 0.0
    while at <= ticks:
        while world.tick < math.ceil(at - 1e-9):
            advance()
        yield 1.0 - (world.tick - at)
        at += TICK_RATE_HZ / fps * pace(1.0 / fps)
