"""What panels act on: the run that the window shows, the scenario it is a run of, and how time passes in it.

The window always shows a run of a scenario that could be saved. So a change of rules, clip or stance is a change of
the scenario: what has happened so far happens again under the new one, with the same throws at the same moments, and
is shown when it has come to where the old run is. That takes part of a few frames; the old run is shown meanwhile.
"""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from behaviours.components import Character, Phase, Reaction
from behaviours.playing import body_of, joint_frames
from behaviours.scenario import check_scenario
from behaviours.scenario_spec import CharacterSpec, Scenario
from behaviours.simulation import flat_settings
from demos.stage import pelvis_m
from demos.window.phases import WORDS
from demos.window.rehearsal import Rehearsal
from demos.window.rerunning import Rerun
from demos.window.run import ClipBox, Inputs, Run
from demos.window.slow_motion import SlowMotion
from demos.window.threat_draft import ThreatDraft, draft_of
from demos.window.throwing import thrown
from demos.window.toasts import Toasts
from demos.window.view import View
from engine.body.skeleton import Body
from engine.core.clock import TICK_RATE_HZ, Clock
from engine.core.errors import BraceError
from engine.core.journal import Command
from engine.render.camera import Camera, ray_through

RATES = (0.05, 0.1, 0.25, 0.5, 1.0, 2.0)
TICKS_BUDGET_S = 0.025  # a frame spends at most this on ticks: what does not fit slows the show down, not the window


class Session:
    """One window's. Everything that panels read and call; `demos.play` feeds it time and events."""

    def __init__(
        self,
        scenario: Scenario,
        folder: Path,
        save_in: Path,
        stopwatch: Callable[[], float] = time.perf_counter,
    ):
        """folder: where the scenario's relative paths start; save_in: where pictures and files go; stopwatch: seconds,
        to keep ticks from slowing the window.
        """
        self.folder, self.save_in, self._stopwatch = folder, save_in, stopwatch
        self.find = ClipBox(folder)
        self.run = self._run_of(scenario, {})
        self.clock, self.slow_motion = Clock(), SlowMotion()
        self.view, self.toasts = View(), Toasts()
        self.threat = draft_of(scenario.threat[0]) if scripted(scenario) else ThreatDraft()
        self.auto_fire, self.auto_fire_s, self.auto_vary = False, 3.0, True
        self.selected = 0  # which character panels are about
        self.camera, self.size_px, self.cursor_px = Camera(), (1, 1), (0.0, 0.0)
        self.dropped: list[str] = []  # clip files that were brought in
        self.filming = self.fetching = False
        self.asked: list[str] = []  # what only the window can do: screenshot, film, scenario, recording, clips
        self._dice = random.Random(scenario.seed)
        self._next_fire = 0
        self._rehearsal = Rehearsal()
        self._rerun = Rerun(self._run_of, lambda line: self.say(line, alarm=True))

    # --- what there is -------------------------------------------------------------------------------------------

    @property
    def world(self):
        """As it is now. Look, but change it by the methods here alone."""
        return self.run.world

    @property
    def tick(self) -> int:
        return self.world.tick

    @property
    def scenario(self) -> Scenario:
        """As it was last wanted, whether it is shown already or not."""
        return self._rerun.newest(self.run)[0]

    @property
    def character(self) -> CharacterSpec:
        """Of the scenario, the one that is selected."""
        return self.scenario.character[self.selected]

    @property
    def row(self) -> int:
        """The selected character's row of the world."""
        return int(self.world.rows(Character)[self.selected])

    def rows(self) -> np.ndarray:
        """All characters' rows of the world."""
        return self.world.rows(Character)

    @property
    def body(self) -> Body:
        return body_of(self.world, self.row)

    @property
    def phase(self) -> Phase:
        return Phase(int(self.world[Reaction].phase[self.row]))

    @property
    def paused(self) -> bool:
        return self.clock.paused

    @property
    def busy(self) -> bool:
        """Whether a changed scenario is still being run."""
        return self._rerun.going

    @property
    def rerun_share(self) -> float:
        """How far it has come, 0 to 1."""
        return self._rerun.share(self.run)

    def centre_m(self) -> np.ndarray:
        """What the camera keeps up with: the selected character, at chest height."""
        x, y, _ = pelvis_m(self.world, self.row)
        return np.array([x, y, 0.95])

    def frames(self, row: int) -> tuple[np.ndarray, np.ndarray]:
        """Where the joints of a character are now (J, 3), and how they are turned (J, 4), world."""
        return joint_frames(self.world, row)

    def joints_m(self, row: int) -> np.ndarray:
        """(J, 3) where the joints of a character are now, world."""
        return self.frames(row)[0]

    def doing(self, row: int) -> str:
        """What a character is about, in words."""
        return WORDS[Phase(int(self.world[Reaction].phase[row]))]

    def ray(self) -> tuple[np.ndarray, np.ndarray]:
        """Where the cursor looks: the eye (3,) and a unit direction (3,)."""
        return ray_through(self.camera, self.cursor_px, self.size_px)

    def say(self, text: str, *, alarm: bool = False) -> None:
        """A line that is shown for a few seconds."""
        self.toasts.say(text, alarm=alarm)

    def ask(self, what: str) -> None:
        """For a screenshot, a film's start or end, a scenario, a recording, clips: done with the next picture."""
        self.asked.append(what)

    # --- time ----------------------------------------------------------------------------------------------------

    def advance(self, passed_s: float) -> None:
        """Real time has passed: the ticks that are due are run, as far as the frame has time for them."""
        self.toasts.fade(passed_s)
        share = 1.0 if self.clock.paused else self.slow_motion.ease(self.world, passed_s)
        due, begun_s = self.clock.ticks_due(passed_s * share), self._stopwatch()
        for done in range(due):
            if done and self._stopwatch() - begun_s > TICKS_BUDGET_S:
                self.clock.dropped_s += (due - done) / TICK_RATE_HZ
                break
            self._fire()
            self.run.advance()
        self.run = self._rerun.go_on(self.run, self._stopwatch)
        self._rehearsal.go_on(self._rehearsed, self._stopwatch)

    def pause(self) -> None:
        self.clock.paused = not self.clock.paused

    def step(self, ticks: int) -> None:
        """So many ticks forth or back, and stands still there."""
        self.clock.paused = True
        if ticks > 0:
            for _ in range(ticks):
                self.run.advance()
        else:
            self.run.seek(self.tick + ticks)

    def change_rate(self, by: int) -> None:
        """To the next slower or faster of RATES."""
        nearest = min(range(len(RATES)), key=lambda i: abs(RATES[i] - self.clock.rate))
        self.clock.rate = RATES[min(max(nearest + by, 0), len(RATES) - 1)]

    def seek(self, tick: int) -> None:
        """To any tick of this future."""
        self.run.seek(tick)
        self._next_fire = 0

    def restart(self) -> None:
        self.seek(self.run.timeline.first_tick)

    # --- what comes in -------------------------------------------------------------------------------------------

    def command(self, command: Command) -> None:
        """Something comes in at this moment; what was known of the future is gone. What was changed is shown before."""
        self.run = self._rerun.finish(self.run)
        self.run.command(command)

    def throw(self, speed_mps: float) -> None:
        """A ball from the eye at what is under the cursor."""
        self.command(thrown(self.world, *self.ray(), speed_mps))
        self.clock.paused = False

    def send(self) -> None:
        """The threat that the Threat panel describes, now, at the selected character."""
        self.command({"do": "threaten", "threat": self.threat.spec(self.selected)})
        self.clock.paused = False

    def _fire(self) -> None:
        """Auto-fire, in the run's own time; what is only played again is not fired into."""
        if not self.auto_fire or not self.run.timeline.at_end or self.tick < self._next_fire:
            return
        self._next_fire = self.tick + round(self.auto_fire_s * TICK_RATE_HZ)
        if self.phase == Phase.PLAY:
            draft = self.threat.varied(self._dice) if self.auto_vary else self.threat
            self.command({"do": "threaten", "threat": draft.spec(self.selected)})

    # --- another scenario ----------------------------------------------------------------------------------------

    def change_setting(self, name: str, value: Any) -> None:
        """One constant of behaviours/settings.py by its dotted name, angles also by `..._deg`."""
        group, field = name.split(".")
        settings = {key: dict(values) for key, values in self.scenario.settings.items()}
        settings.setdefault(group, {})[field] = value
        self.change(settings=settings)

    def forget_settings(self, *groups: str) -> None:
        """These groups as the thesis has them."""
        self.change(settings={key: values for key, values in self.scenario.settings.items() if key not in groups})

    def change_character(self, **changes: Any) -> None:
        """Keys of a scenario's `[[character]]`, of the selected one."""
        characters = [spec.model_dump(mode="json") for spec in self.scenario.character]
        characters[self.selected] |= changes
        self.change(character=characters)

    def change(self, inputs: Inputs | None = None, **changes: Any) -> None:
        """Whatever else differs in the scenario or in what comes in. An impossible change is said, and not made."""
        try:
            raw = {**self.scenario.model_dump(mode="json"), **changes}
            self._rerun.want(check_scenario(raw), self._inputs() if inputs is None else inputs)
        except BraceError as trouble:
            self.say(trouble.line(), alarm=True)

    def play_clip(self, clip: str) -> bool:
        """The selected character plays another clip, from the start. False, and a line said, if it cannot."""
        characters = [spec.model_dump(mode="json") for spec in self.scenario.character]
        characters[self.selected] |= {"clip": clip, "start_s": 0.0}
        try:
            raw = {**self.scenario.model_dump(mode="json"), "character": characters}
            self.begin(check_scenario(raw), relative_inputs(self.run.inputs))
        except BraceError as trouble:
            self.say(trouble.line(), alarm=True)
            return False
        return True

    def begin(self, scenario: Scenario, inputs: Inputs) -> None:
        """Another scenario from its first tick. BadInput or EnvironmentTrouble, and nothing changed, if it cannot."""
        self.run = self._run_of(scenario, inputs)
        self._rerun.forget()
        self._next_fire = 0

    def alter_last_threat(self) -> None:
        """What came last of scripted threats, from the panel or the scenario, is now as the panel describes it."""
        spec = self.threat.spec(self.selected)
        inputs = {tick: list(commands) for tick, commands in self._inputs().items()}
        for tick in sorted((tick for tick in inputs if tick <= self.tick), reverse=True):
            for number, command in reversed(list(enumerate(inputs[tick]))):
                if command["do"] == "threaten":
                    inputs[tick][number] = {"do": "threaten", "threat": spec}
                    self.change(inputs=inputs)
                    return
        if scripted(self.scenario):
            old = self.scenario.threat[0].model_dump(mode="json", exclude_defaults=True)
            kept = {key: old[key] for key in ("perceived_s", "contact_s", "at_character") if key in old}
            rest = [threat.model_dump(mode="json") for threat in self.scenario.threat[1:]]
            self.change(threat=[{**spec, **kept}, *rest])

    def changed_settings(self) -> dict[str, Any]:
        """Dotted name -> value of every constant that is not as the thesis has it."""
        return flat_settings(self.scenario.settings)

    def _inputs(self) -> Inputs:
        return self._rerun.newest(self.run)[1]

    def _run_of(self, scenario: Scenario, inputs: Inputs) -> Run:
        return Run(scenario, self.find, self.folder, inputs)

    def _rehearsed(self) -> Run:
        """The run of the threat that the panel describes, beside the one that is shown."""
        inputs: Inputs = {0: [{"do": "threaten", "threat": self.threat.spec(self.selected)}]}
        return self._run_of(self.run.scenario, inputs)


def scripted(scenario: Scenario) -> bool:
    """Whether the scenario's first threat is a scripted one."""
    return bool(scenario.threat) and not scenario.threat[0].free


def relative_inputs(inputs: Inputs) -> Inputs:
    """What still makes sense with another clip: threats come at whoever it is, thrown balls flew at a place."""
    kept = {tick: [command for command in commands if command["do"] == "threaten"] for tick, commands in inputs.items()}
    return {tick: commands for tick, commands in kept.items() if commands}
