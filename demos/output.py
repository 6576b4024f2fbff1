"""How commands speak: results on standard output, progress to a person only."""

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


def say(message: str) -> None:
    """A word to the person at the terminal; silent in a pipe, so that only results are piped."""
    if sys.stderr.isatty():
        print(message, file=sys.stderr)


def made_folder(path: str) -> Path:
    """The folder, made where it is not there yet. EnvironmentTrouble where it cannot be."""
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as trouble:
        raise EnvironmentTrouble(
            "unwritable", f"cannot be made a folder: {trouble.strerror or trouble}", path
        ) from None
    return folder


def _plain(value: Any) -> Any:
    """numpy's numbers and arrays, and paths, as JSON's own."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{type(value).__name__} has no place in JSON")
