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
    print(_laid_out(json.loads(json.dumps(data, allow_nan=False, default=_plain)), ""))


def _laid_out(data: Any, indent: str) -> str:
    """JSON with a line for each entry, but arrays of plain values on one: points and contacts stay readable."""
    within = indent + "  "
    if isinstance(data, dict) and data:
        entries = [f"{within}{json.dumps(key)}: {_laid_out(value, within)}" for key, value in data.items()]
        return "{\n" + ",\n".join(entries) + f"\n{indent}}}"
    if isinstance(data, list) and any(isinstance(value, dict) for value in data):
        return "[\n" + ",\n".join(f"{within}{_laid_out(value, within)}" for value in data) + f"\n{indent}]"
    return json.dumps(data)


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
    """numpy's numbers and arrays, and paths, as JSON's own."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{type(value).__name__} has no place in JSON")
