"""One run of a scenario as the window holds it: every tick recorded, every tick within reach, what came in included."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from behaviours.recover.library import clip_for
from behaviours.scenario_spec import CharacterSpec, Scenario
from behaviours.simulation import Simulation, apply_command
from demos.running import journal_of
from demos.window.history import History
from engine.clips.clip import Clip
from engine.core.clock import ticks
from engine.core.journal import Command
from engine.core.timeline import Timeline

Inputs = dict[int, list[Command]]


class ClipBox:
    """Finds clips, and keeps those that were found: a changed scenario must not read files again."""

    def __init__(self, folder: Path):
        self.folder = folder
        self._kept: dict[tuple, Clip] = {}

    def __call__(self, spec: CharacterSpec) -> Clip:
        """BadInput or EnvironmentTrouble where there is no such clip."""
        key = (spec.clip, spec.sex, spec.mass_kg)
        if key not in self._kept:
            self._kept[key] = clip_for(spec, self.folder)
        return self._kept[key]


class Run:
    """A simulation under its timeline. `inputs`: what is to come in, by tick; the scenario's own commands join them."""

    def __init__(self, scenario: Scenario, find: Callable[[CharacterSpec], Clip], folder: Path, inputs: Inputs):
        self.scenario = scenario.model_copy(update={"command": ()})
        self.simulation = Simulation(self.scenario, find)
        journal = journal_of(self.simulation, folder)
        journal.inputs = {tick: list(commands) for tick, commands in sorted(inputs_of(scenario, inputs).items())}
        self.timeline = Timeline(self.simulation.world, self.simulation.step, apply_command, journal)
        self.history = History(self.world)

    @property
    def world(self):
        return self.simulation.world

    @property
    def inputs(self) -> Inputs:
        return self.timeline.journal.inputs

    @property
    def last_tick(self) -> int:
        return self.timeline.last_tick

    def advance(self) -> None:
        """One tick, replayed where it is known."""
        self.timeline.advance()
        self.history.note(self.world)

    def command(self, command: Command) -> None:
        """Something comes in now. What was known of the future is gone."""
        self.timeline.command(command)
        self.history.forget_after(self.world)

    def seek(self, tick: int) -> None:
        """To a tick that was reached, or the nearest."""
        self.timeline.seek(tick)


def inputs_of(scenario: Scenario, inputs: Inputs) -> Inputs:
    """What a scenario has coming in from outside, and then these."""
    joined: Inputs = {}
    for given in scenario.command:
        joined.setdefault(ticks(given.at_s), []).append(given.as_command())
    for tick, commands in inputs.items():
        joined.setdefault(tick, []).extend(commands)
    return joined
