"""A changed scenario, run again to where the old run is, a part of every frame: what is shown goes on meanwhile."""

from __future__ import annotations

from collections.abc import Callable

from behaviours.scenario_spec import Scenario
from demos.window.run import Inputs, Run
from engine.core.errors import BraceError

BUDGET_S = 0.020  # a frame spends at most this on it


class Rerun:
    """Holds what is wanted, and the run of it while that is on its way."""

    def __init__(self, make: Callable[[Scenario, Inputs], Run], say: Callable[[str], None]):
        """make: a scenario's run at its first tick, BraceError where it cannot be; say: is told why."""
        self._make, self._say = make, say
        self._wanted: tuple[Scenario, Inputs] | None = None
        self._run: Run | None = None

    @property
    def going(self) -> bool:
        return self._run is not None

    def share(self, shown: Run) -> float:
        """How much of it is done, 0 to 1."""
        if self._run is None:
            return 0.0
        return min(self._run.world.tick / max(shown.last_tick, 1), 1.0)

    def want(self, scenario: Scenario, inputs: Inputs) -> None:
        """Instead of whatever was wanted before; what is on its way already comes first, and is then replaced."""
        self._wanted = (scenario, inputs)

    def forget(self) -> None:
        self._wanted = self._run = None

    def newest(self, shown: Run) -> tuple[Scenario, Inputs]:
        """What was last wanted, whether it is shown already or not."""
        run = self._run or shown
        return self._wanted or (run.scenario, run.inputs)

    def go_on(self, shown: Run, stopwatch: Callable[[], float]) -> Run:
        """Works on it for part of a frame. The run to show from now on: the new one once it has come as far."""
        begun_s = stopwatch()
        while stopwatch() - begun_s < BUDGET_S:
            if self._run is None and not self._start():
                break
            shown = self._step(shown)
        return shown

    def finish(self, shown: Run) -> Run:
        """All of it, now. The run to show from now on."""
        while self._run is not None or self._start():
            shown = self._step(shown)
        return shown

    def _start(self) -> bool:
        """False where nothing is wanted, or it cannot be."""
        if self._wanted is None:
            return False
        (scenario, inputs), self._wanted = self._wanted, None
        try:
            self._run = self._make(scenario, inputs)
        except BraceError as trouble:
            self._say(trouble.line())
            return False
        return True

    def _step(self, shown: Run) -> Run:
        """One tick of it; once it has come as far as the one that is shown, it is shown, at the same moment."""
        assert self._run is not None
        if self._run.world.tick < shown.last_tick:
            self._run.advance()
            return shown
        done, self._run = self._run, None
        done.seek(shown.world.tick)
        return done
