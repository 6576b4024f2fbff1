"""Scenarios as the commands run them: opened by name or path, recorded, and brought back from a recording."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, TypeVar

from behaviours.scenario import CharacterSpec, Scenario, check_scenario, load_scenario
from behaviours.simulation import Simulation, apply_command
from demos.kernels import announce_compiling, forget_stale
from demos.scenarios import find_scenario
from engine.clips.clip import Clip
from engine.clips.library import find_clip
from engine.core.errors import BadInput
from engine.core.journal import Journal
from engine.core.recorder import Recorder, new_journal, replay

T = TypeVar("T")


def open_scenario(name_or_path: str, overrides: Sequence[str] = ()) -> tuple[Scenario, Path]:
    """A scenario by name or path, and the folder that its relative paths start from."""
    path = find_scenario(name_or_path)
    return load_scenario(path, tuple(overrides)), path.resolve().parent


def start(scenario: Scenario, folder: Path, observe: bool = False) -> Simulation:
    """The scenario at its first tick, with kernels that match their sources; with `observe`, able to report."""
    forget_stale()
    if sys.stderr.isatty():
        announce_compiling()

    def find(spec: CharacterSpec) -> Clip:
        return find_clip(spec.clip, relative_to=folder, sex=spec.sex, body_mass_kg=spec.mass_kg)

    return Simulation(scenario, find, observe=observe)


def journal_of(simulation: Simulation, folder: Path) -> Journal:
    """An empty recording of a run, with all that a replay on this machine needs."""
    header = {
        "scenario": simulation.scenario.model_dump(mode="json"),
        "folder": str(folder),
        "clips": [clip.key for clip in simulation.world.assets.clips],
    }
    return new_journal(header, simulation.world)


def recorder_of(simulation: Simulation, folder: Path) -> Recorder:
    """Records every tick from here on."""
    return Recorder(simulation.world, simulation.step, apply_command, journal_of(simulation, folder))


def replayed(journal: Journal, where: str) -> tuple[Simulation, Recorder]:
    """The run that a recording is of, at its first tick. BadInput where its clips are no longer what they were."""
    try:
        header: dict[str, Any] = journal.header
        scenario, folder, keys = header["scenario"], Path(header["folder"]), header["clips"]
    except (KeyError, TypeError) as trouble:
        raise BadInput("recording", f"its header lacks {trouble}", where) from None
    simulation = start(check_scenario(scenario, where), folder)
    for spec, clip, key in zip(simulation.scenario.character, simulation.world.assets.clips, keys, strict=True):
        if clip.key != key:
            raise BadInput("recording", f"the clip {spec.clip!r} is not the one that was recorded with", where)
    return simulation, replay(simulation.world, simulation.step, apply_command, journal)


def with_progress(steps: Iterable[T], what: str, total: int) -> Iterable[T]:
    """The same steps, with a bar on a terminal and silence in a pipe."""
    if not sys.stderr.isatty():
        return steps
    from tqdm import tqdm

    return tqdm(steps, desc=what, total=total, leave=False, unit="tick" if what == "simulating" else "frame")
