"""What can be taken away from the window: the run as a scenario or as a recording, the picture. Whole files or none."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import tomlkit

from behaviours.scenario import parse_scenario
from behaviours.scenario_spec import CharacterSpec
from demos.window.run import Run
from engine.clips.library import list_clips
from engine.core.clock import TICK_RATE_HZ, seconds
from engine.core.errors import BadInput
from engine.core.files import write_atomically
from engine.core.journal_file import save_journal

LONGEST_S = 600.0  # a scenario's


def free_name(folder: Path, stem: str, ending: str) -> Path:
    """`stem-1.ending` in the folder, or the next number that is not taken."""
    number = 1
    while (folder / f"{stem}-{number}{ending}").exists():
        number += 1
    return folder / f"{stem}-{number}{ending}"


def save_replay(run: Run, folder: Path) -> Path:
    """The recording of all up to the furthest tick, for `brace replay`. EnvironmentTrouble where it cannot be."""
    path = free_name(folder, "recording", ".brace")
    save_journal(run.timeline.journal, path)
    return path


def save_scenario(run: Run, folder: Path, clips_from: Path) -> Path:
    """A scenario that `brace react` runs to the very same state as the window did, throws included.

    clips_from: where the run's relative clip paths start. BadInput for a run that is longer than scenarios are.
    """
    path = free_name(folder, "scenario", ".toml")
    write_atomically(path, scenario_text(run, clips_from).encode())
    return path


def scenario_text(run: Run, clips_from: Path) -> str:
    """The TOML of it, checked by reading it again."""
    last = run.last_tick
    if not 0 < last <= LONGEST_S * TICK_RATE_HZ:
        raise BadInput("scenario", f"a run of {seconds(last):.1f} s, expected more than 0, at most {LONGEST_S:.0f} s")
    raw = run.scenario.model_dump(mode="json", exclude_defaults=True)
    raw |= {"version": 1, "seed": run.scenario.seed, "duration_s": seconds(last)}
    raw["character"] = [_with_place(spec, clips_from) for spec in run.scenario.character]
    raw["command"] = [row for tick, commands in run.inputs.items() if tick < last for row in _rows(tick, commands)]
    order = ("version", "seed", "duration_s", "library", "character", "threat", "command", "settings")
    document = tomlkit.document()
    document.add(tomlkit.comment("As it was played in the window of Brace; brace react runs it to the digest"))
    document.add(tomlkit.comment(run.timeline.journal.digest_at(last)))
    for key in order:
        if raw.get(key):
            document.add(key, tomlkit.item(raw[key]))
    document.setdefault("seed", run.scenario.seed)
    text = tomlkit.dumps(document)
    parse_scenario(text)
    return text


def _with_place(spec: CharacterSpec, clips_from: Path) -> dict[str, Any]:
    """A character; its clip, where it is a file, by its whole path: the scenario may be saved anywhere."""
    clip = spec.clip
    if clip not in {listed.name for listed in list_clips()}:
        clip = str((clips_from / Path(clip).expanduser()).resolve())
    return {"clip": clip, **spec.model_dump(mode="json", exclude_defaults=True, exclude={"clip"})}


def _rows(tick: int, commands: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Recorded commands as a scenario's `[[command]]` rows."""
    rows = []
    for command in commands:
        given = {key: value for key, value in command.items() if key != "do"}
        if command["do"] == "threaten":
            rows.append({"at_s": seconds(tick), "threat": given["threat"]})
        else:
            rows.append({"at_s": seconds(tick), "throw": {"at_character": given.pop("at", 0), **given}})
    return rows
