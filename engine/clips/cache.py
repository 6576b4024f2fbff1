"""Imported clips kept as arrays in the user's cache, so that a second load takes milliseconds.

A file is keyed by the content of what it was made from, of the wishes and of the importing code, so it is never stale.
It is written beside its name and renamed, so it is never half there; a file that cannot be read is as good as none."""

from __future__ import annotations

import contextlib
import json
import os
import threading
import zipfile
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import IO, Any

import numpy as np

from engine.body.skeleton import Body, Pose
from engine.clips.clip import Clip, ImportReport, Loop


def cache_folder() -> Path:
    """Where clips are kept: $BRACE_CACHE, else brace in $XDG_CACHE_HOME, else in ~/.cache. It need not exist yet."""
    told = os.environ.get("BRACE_CACHE")
    if told:
        return Path(told)
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "brace"


def load(key: str) -> Clip | None:
    """The clip of this key, or None if it is not there or cannot be used."""
    try:
        with open(_path(key), "rb") as file:
            arrays = np.load(file, allow_pickle=False)
            words = json.loads(str(arrays["words"]))
            return Clip(
                name=words["name"],
                fps=words["fps"],
                pose=Pose(arrays["root_m"], arrays["rotations"]),
                body=Body(*(arrays[f"body_{field}"] for field in Body._fields)),
                planted=arrays["planted"],
                loop=Loop(*words["loop"]),
                report=ImportReport(**words["report"]),
                key=key,
            )
    except (OSError, KeyError, ValueError, TypeError, EOFError, zipfile.BadZipFile):
        return None


def save(clip: Clip) -> None:
    """Keeps a clip. A cache that cannot be written is no fault: the clip is imported again next time."""
    words = {"name": clip.name, "fps": clip.fps, "loop": list(clip.loop), "report": asdict(clip.report)}
    arrays: dict[str, Any] = {
        "root_m": clip.pose.root_m,
        "rotations": clip.pose.rotations,
        "planted": clip.planted,
        "words": np.array(json.dumps(words)),
        **{f"body_{field}": value for field, value in zip(Body._fields, clip.body, strict=True)},
    }
    path = _path(clip.key)
    with contextlib.suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, lambda file: np.savez(file, **arrays))


def write_whole(path: Path, write: Callable[[IO[bytes]], object]) -> None:
    """Writes a file so that its name never stands for half of it: `write` gets an open binary file beside it. OSError
    passes on."""
    beside = path.with_name(f".{path.name}.{os.getpid()}.{threading.get_ident()}")
    try:
        with open(beside, "xb") as file:
            write(file)
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


def _path(key: str) -> Path:
    return cache_folder() / "imported" / f"{key[:40]}.npz"
