"""Scenarios as the commands run them: opened by name or path, recorded, and brought back from a recording."""

from __future__ import annotations

import importlib
import re
import sys
from collections.abc import Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from behaviours.recover.library import clip_for, library_names
from behaviours.scenario import check_scenario, load_scenario, parse_scenario
from behaviours.scenario_spec import Scenario
from behaviours.simulation import Simulation, apply_command
from demos.kernels import get_kernels_ready
from demos.scenarios import FOLDER, PROGRAMS, find_scenario
from engine.core.errors import BadInput
from engine.core.journal import Journal
from engine.core.recorder import Recorder, new_journal, replay

T = TypeVar("T")


def open_scenario(name_or_path: str, overrides: Sequence[str] = ()) -> tuple[Scenario, Path]:
    """A scenario by name or path, and the folder that its relative paths start from."""
    if name_or_path in PROGRAMS:
        import tomlkit

        text = tomlkit.dumps(importlib.import_module(f"demos.{name_or_path}").scenario())
        return parse_scenario(text, name_or_path, tuple(overrides)), FOLDER
    path = find_scenario(name_or_path)
    folder = path.resolve().parent
    return load_scenario(path, tuple(with_clips_from_here(overrides, folder))), folder


def with_clips_from_here(overrides: Sequence[str], folder: Path) -> list[str]:
    """The overrides, a clip's file by its whole path where it lies here and not beside the scenario: what is typed
    counts from where one stands.
    """
    out = []
    for override in overrides:
        key, _, value = override.partition("=")
        file = Path(value.strip("'\" ")).expanduser()
        is_clip = re.fullmatch(r"character\.\d+\.clip", key.strip()) is not None
        found = is_clip and file.is_file() and not (folder / file).is_file()
        out.append(f"{key}='{file.resolve()}'" if found else override)
    return out


def start(scenario: Scenario, folder: Path, observe: bool = False) -> Simulation:
    """The scenario at its first tick, with kernels that match their sources; with `observe`, able to report."""
    get_kernels_ready()
    return Simulation(scenario, partial(clip_for, relative_to=folder), observe=observe)


def journal_of(simulation: Simulation, folder: Path) -> Journal:
    """An empty recording of a run, with all that a replay on this machine needs."""
    header = {
        "scenario": {**simulation.scenario.model_dump(mode="json"), "library": searched_names(simulation)},
        "folder": str(folder),
        # own clips first; then what a search looked through
        "clips": [clip.key for clip in simulation.world.assets.clips],
        "indexes": [library.motions.key for library in simulation.world.assets.libraries if library],
    }
    return new_journal(header, simulation.world)


def searched_names(simulation: Simulation) -> list[str]:
    """The library's clips by name, so that a replay searches these and not what has been fetched since."""
    searches = any(simulation.world.assets.libraries)
    return list(library_names(simulation.scenario)) if searches else []


def recorder_of(simulation: Simulation, folder: Path) -> Recorder:
    """Records every tick from here on."""
    return Recorder(simulation.world, simulation.step, apply_command, journal_of(simulation, folder))


def replayed(journal: Journal, where: str) -> tuple[Simulation, Recorder]:
    """The run that a recording is of, at its first tick. BadInput where its clips are no longer what they were."""
    try:
        header: dict[str, Any] = journal.header
        scenario, folder, keys, indexes = header["scenario"], Path(header["folder"]), header["clips"], header["indexes"]
    except (KeyError, TypeError) as trouble:
        raise BadInput("recording", f"its header lacks {trouble}", where) from None
    if not indexes:  # nothing was searched, whatever is here now
        scenario = {**scenario, "library": []}
    simulation = start(check_scenario(scenario, where), folder)
    assets = simulation.world.assets
    for clip, key in zip(assets.clips, keys, strict=False):
        if clip.key != key:
            raise BadInput("recording", f"the clip {clip.name!r} is not the one that was recorded with", where)
    if len(keys) != len(assets.clips) or indexes != [library.motions.key for library in assets.libraries if library]:
        raise BadInput("recording", "the library that is searched is not the one that was recorded with", where)
    return simulation, replay(simulation.world, simulation.step, apply_command, journal)


def with_progress(steps: Iterable[T], what: str, total: int | None) -> Iterable[T]:
    """The same steps, with a bar on a terminal (a count where no total is known) and silence in a pipe."""
    if not sys.stderr.isatty():
        return steps
    from tqdm import tqdm

    return tqdm(steps, desc=what, total=total, leave=False, unit="tick" if what == "simulating" else "frame")
