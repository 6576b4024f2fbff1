"""What a character may go on with after a blow: the clips of the library moved onto its body, and their index.

Who goes on with the same motion (`recover = "same"`) needs one only to get up with after a knock-down: for these the
library is what may be a get-up, and without any nothing here is done, or imported.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from behaviours.scenario_spec import CharacterSpec, Scenario
from behaviours.settings import Settings
from engine.clips.clip import Clip
from engine.clips.library import find_clip, list_clips

if TYPE_CHECKING:
    from behaviours.recover.search import Library

FindClip = Callable[[CharacterSpec], Clip]


def clip_for(spec: CharacterSpec, relative_to: str | Path | None = None) -> Clip:
    """The clip that a scenario's character plays, on a body of its sex and mass; a relative path counts from the folder
    `relative_to`, else from here. BadInput or EnvironmentTrouble where there is no such clip.
    """
    return find_clip(spec.clip, relative_to, sex=spec.sex, body_mass_kg=spec.mass_kg)


def library_names(scenario: Scenario) -> tuple[str, ...]:
    """The clips of the library that are searched: those that the scenario lists, else all that are here."""
    if scenario.library is not None:
        return scenario.library
    return tuple(listed.name for listed in list_clips() if listed.ready)


def get_up_names(scenario: Scenario) -> tuple[str, ...]:
    """Those of `library_names` that somebody may get up with: the library's get-ups, and files, which may be one."""
    upright = {listed.name for listed in list_clips() if not listed.gets_up}
    return tuple(name for name in library_names(scenario) if name not in upright)


def gather_libraries(
    scenario: Scenario, clips: tuple[Clip, ...], find: FindClip, settings: Settings
) -> tuple[tuple[Clip, ...], tuple[Library | None, ...]]:
    """All clips of the run, the characters' own (given) first, and one Library or None a character."""
    every = list(clips)
    libraries: list[Library | None] = []
    for row in range(len(scenario.character)):
        chosen = _chosen(scenario, clips, row, find)
        libraries.append(_library(chosen, every, row, settings) if chosen else None)
    return tuple(every), tuple(libraries)


def _chosen(scenario: Scenario, clips: tuple[Clip, ...], row: int, find: FindClip) -> list[Clip]:
    """The clips that a character's search looks at, its own first, no two the same; none where it has no need of any.

    For a new motion the library's and the other characters'; for the same one only what may be a get-up.
    """
    spec = scenario.character[row]
    same = spec.recover == "same"
    names = get_up_names(scenario) if same else library_names(scenario)
    if same and not names:
        return []
    named = [find(spec.model_copy(update={"clip": name, "mirrored": False})) for name in names]
    return list({clip.key: clip for clip in (clips[row], *named, *(() if same else clips))}.values())


def _library(chosen: list[Clip], every: list[Clip], row: int, settings: Settings) -> Library:
    """Moves them onto the character's body, adds them to the clips of the run, and indexes them."""
    from behaviours.recover.motion_index import index_clips
    from behaviours.recover.search import Library
    from engine.clips.retarget import retarget_clip

    body = every[row].body
    own = (every[row], *(retarget_clip(clip, body) for clip in chosen[1:]))
    rows = (row, *range(len(every), len(every) + len(own) - 1))
    every.extend(own[1:])
    index = index_clips(
        own, body, settings.timing.sustained_ahead_s, settings.search.least_left_s, settings.search.velocity_s
    )
    return Library(index, rows)
