"""A reaction that nobody sees, in the window's first frames: what it needs of compiled code is loaded then, and not in
the middle of the first real one.
"""

from __future__ import annotations

from collections.abc import Callable

from demos.window.run import Run

TICKS = 200  # of the run that is rehearsed
FIRST_FRAMES = 3  # are shown before anything is rehearsed
BUDGET_S = 0.020  # a frame spends at most this on it


class Rehearsal:
    """Goes on a little with every frame until it is through: `left` is how many ticks there are to go."""

    def __init__(self) -> None:
        self._run: Run | None = None
        self.left, self._frames = TICKS, 0

    def go_on(self, begin: Callable[[], Run], stopwatch: Callable[[], float]) -> None:
        """Some ticks more; `begin` makes the run when it is first needed, `stopwatch` tells seconds."""
        self._frames += 1
        if self.left <= 0 or self._frames <= FIRST_FRAMES:
            return
        if self._run is None:
            self._run = begin()
        begun_s = stopwatch()
        while self.left > 0 and stopwatch() - begun_s < BUDGET_S:
            self._run.advance()
            self.left -= 1
        if self.left <= 0:
            self._run = None
