"""From the outer loop's real seconds to whole ticks. They meet only here; the time itself is passed in."""

from __future__ import annotations

import math

TICK_RATE_HZ = 120
TICK_S = 1.0 / TICK_RATE_HZ
CATCH_UP_S = 0.25


class Clock:
    """Counts out ticks. After a hitch it catches up at most 250 ms; whatever is beyond slows the show down instead.

    `rate`: 1 is real time, 0.25 slow motion. `paused`: no time passes, `step` still gives single ticks.
    `alpha`: in [0, 1), how far the moment now is past the last tick: draw between the tick before and it.
    `dropped_s`: real seconds that were never caught up on, for the overlay.
    """

    __slots__ = ("_owed_ticks", "_steps", "dropped_s", "paused", "rate")

    def __init__(self, rate: float = 1.0, paused: bool = False):
        self.rate = rate
        self.paused = paused
        self.dropped_s = 0.0
        self._owed_ticks = 0.0
        self._steps = 0

    def ticks_due(self, real_s_since_last: float) -> int:
        """How many ticks to run now, this long after the last call. A clock that was set back counts as no time."""
        elapsed_s = max(real_s_since_last, 0.0) if math.isfinite(real_s_since_last) else 0.0
        steps, self._steps = self._steps, 0
        if self.paused:
            return steps
        counted_s = min(elapsed_s, CATCH_UP_S)
        self.dropped_s += elapsed_s - counted_s
        self._owed_ticks += counted_s * self.rate * TICK_RATE_HZ
        # 1e-9: a frame of exactly n ticks must not give n - 1 and then n + 1 through rounding alone
        due = math.floor(self._owed_ticks + 1e-9)
        self._owed_ticks = max(self._owed_ticks - due, 0.0)
        return due + steps

    @property
    def alpha(self) -> float:
        return self._owed_ticks

    def step(self, ticks: int = 1) -> None:
        """Ask for single ticks, paused or not; they come with the next `ticks_due`, exactly at their moment."""
        self._steps += ticks
        self._owed_ticks = 0.0


def seconds(tick: int) -> float:
    """The moment of a tick, in seconds from the start."""
    return tick / TICK_RATE_HZ


def ticks(time_s: float) -> int:
    """The tick nearest to a moment; exact halves go to the later one."""
    return math.floor(time_s * TICK_RATE_HZ + 0.5)
