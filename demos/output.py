"""How commands speak: results on standard output, progress to a person only, a refusal before the long work."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from typing import Any

from engine.core.errors import EnvironmentTrouble


def print_json(data: Any) -> None:
    """One JSON document on standard output. NaN or infinity in it is a fault of ours, and raises."""
    print(json.dumps(data, indent=1, allow_nan=False, default=_plain))


def check_writable(path: str | os.PathLike[str]) -> Path:
    """The path, if a file may be put there: asked before long work, so that no one waits for a refusal."""
    path = Path(path)
    folder = path.parent
    if not folder.is_dir():
        raise EnvironmentTrouble("unwritable", f"there is no folder {folder}", str(path))
    if path.is_dir() or not os.access(folder, os.W_OK | os.X_OK) or (path.exists() and not os.access(path, os.W_OK)):
        raise EnvironmentTrouble("unwritable", "cannot be written", str(path))
    return path


def say(message: str) -> None:
    """A word to the person at the terminal; silent in a pipe, so that only results are piped."""
    if sys.stderr.isatty():
        print(message, file=sys.stderr)


def _plain(value: Any) -> Any:
    """numpy's numbers and arrays as JSON's own."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} has no place in JSON")
