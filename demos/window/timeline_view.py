"""Which stretch of a run the timeline shows, and which tick lies where on it."""

from __future__ import annotations

from dataclasses import dataclass

from engine.core.clock import TICK_RATE_HZ

LEAST_S, MOST_S, USUAL_S = 2.0, 120.0, 12.0
ZOOM_A_STEP = 0.85


@dataclass
class TimelineView:
    """From tick `first`, `span` ticks over the whole width. At the live edge it goes along by itself."""

    first: float = 0.0
    span: float = USUAL_S * TICK_RATE_HZ

    def keep_up(self, tick: int, last: int) -> None:
        """Shows from the start while everything fits; then so that the tick that is shown stays in sight."""
        room = 0.06 * self.span
        if tick > self.first + self.span - room:
            self.first = tick - self.span + room
        if tick < self.first:
            self.first = tick - room
        self.first = max(0.0, min(self.first, max(0.0, last - self.span + room)))

    def zoom(self, steps: float, at_share: float) -> None:
        """In for positive steps; what lies under the cursor, a share of the width, stays there."""
        kept = self.first + at_share * self.span
        self.span = min(max(self.span * ZOOM_A_STEP**steps, LEAST_S * TICK_RATE_HZ), MOST_S * TICK_RATE_HZ)
        self.first = max(0.0, kept - at_share * self.span)

    def x_of(self, tick: float, width: float) -> float:
        return (tick - self.first) / self.span * width

    def tick_at(self, x: float, width: float) -> int:
        """The nearest tick."""
        return round(self.first + x / max(width, 1.0) * self.span)

    def seconds_marks(self) -> list[float]:
        """Whole moments to write down, in seconds: at most about ten."""
        span_s = self.span / TICK_RATE_HZ
        every = next(step for step in (0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0) if span_s / step <= 12.0)
        first = -(-self.first / TICK_RATE_HZ // every) * every
        count = int((self.first + self.span) / TICK_RATE_HZ / every) - round(first / every) + 1
        return [first + k * every for k in range(max(count, 0))]
