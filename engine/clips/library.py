"""The clips that have a name, and how any clip is found: by that name, or as a file.

What compiles kernels is imported where it is used, so that listing the library is instant.
"""

from __future__ import annotations

import difflib
from dataclasses import dataclass, replace
from pathlib import Path

from engine.clips import cache
from engine.clips.cache import cache_folder as cache_folder
from engine.clips.clip import Clip
from engine.clips.fetching import clip_folder
from engine.clips.fetching import fetch as fetch
from engine.clips.making import FORMATS, Wanted, content_key
from engine.clips.mirror import mirror_clip as mirror_clip
from engine.core.errors import BadInput, EnvironmentTrouble

FETCH_SIZE = "103 MB"  # of the archive that brings what is `extra`


@dataclass(frozen=True)
class Listed:
    """One clip of the library."""

    name: str
    about: str
    file: str | None = None  # in the folder of fetched clips; None for the embedded one
    frames: tuple[int, int] | None = None  # of the file, if not all of it
    extra: bool = False  # comes only when asked for: its archive is large
    gets_up: bool = False  # begins lying, ends standing

    @property
    def path(self) -> Path | None:
        return clip_folder() / self.file if self.file else None

    @property
    def ready(self) -> bool:
        """Whether it can be played now, without network."""
        return self.path is None or self.path.is_file()


LIBRARY = (
    Listed("walk", "straight walk, 1.5 m/s, goes round", "walk.npz"),
    Listed("run", "run, 3.4 m/s, goes round", "run.npz"),
    Listed("dance", "dancing upright, 15 s", "dance.npz"),
    Listed("hop", "hops ahead, turns, hops back, 23 s (CMU 01_01)", "hop.amc"),
    # after two seconds he bends down to kneel
    Listed("stand", "standing still, goes round", "stand.bvh", (0, 64)),
    Listed("kneel", "stands, kneels down, stands up again, 15 s", "stand.bvh"),
    Listed("getup_faceup", "gets up from lying on the back, 4 s", "getup_faceup.json", extra=True, gets_up=True),
    Listed("getup_facedown", "gets up from lying on the front, 3 s", "getup_facedown.json", extra=True, gets_up=True),
    Listed("punch", "two punches, 2 s", "punch.json", extra=True),
    Listed("kick", "a kick, 1.5 s", "kick.json", extra=True),
    Listed("sway", "standing, shifting weight, breathing; embedded, goes round"),
)


def list_clips() -> list[Listed]:
    """The library, with what is ready. Looks only whether files are there."""
    return list(LIBRARY)


def find_clip(
    name_or_path: str | Path,
    relative_to: str | Path | None = None,
    *,
    sex: str = "male",
    body_mass_kg: float | None = None,
    as_captured: bool = False,
) -> Clip:
    """The clip of that library name or in that file; a relative path counts from the folder `relative_to`, else from
    here.

    as_captured: glitches of a frame or two are left in. BadInput for a name or file that is not there;
    EnvironmentTrouble for a library clip that has not been fetched.
    """
    named = next((listed for listed in LIBRARY if listed.name == str(name_or_path)), None)
    if named is None:
        return load_clip(_file(str(name_or_path), relative_to), Wanted(sex, body_mass_kg, as_captured=as_captured))
    if named.path is None:
        from engine.clips.synthetic import sway

        return sway(sex, body_mass_kg)
    if not named.ready:
        how = "brace clips fetch --extra" if named.extra else "brace clips fetch"
        message = f"clip {named.name!r} is not here yet; `{how}` brings it, `sway` needs no fetching"
        raise EnvironmentTrouble("clip-not-fetched", message)
    first, last = named.frames or (0, None)
    return load_clip(named.path, Wanted(sex, body_mass_kg, first, last, as_captured), named.name)


def load_clip(path: Path, wanted: Wanted, name: str | None = None) -> Clip:
    """A file's clip, from the cache if this content was imported before."""
    key = content_key(path, wanted)
    name = name or path.stem
    clip = cache.load(key)
    if clip is None:
        from engine.clips.importing import build_clip, read_tracks

        clip = build_clip(read_tracks(path), path, wanted, name, key)
        cache.save(clip)
    return replace(clip, name=name, report=replace(clip.report, name=name))


def _file(text: str, relative_to: str | Path | None) -> Path:
    path = Path(text).expanduser()
    if not path.is_absolute() and relative_to is not None:
        path = Path(relative_to) / path
    if path.is_file() or path.suffix.lower() in FORMATS:
        return path
    names = [listed.name for listed in LIBRARY]
    near = difflib.get_close_matches(text, names, n=len(names), cutoff=0.0)
    raise BadInput(
        "clip-missing", f"found no clip or file {text!r}, expected {', '.join(near)}, or a {', '.join(FORMATS)} file"
    )
