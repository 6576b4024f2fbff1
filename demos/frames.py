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
