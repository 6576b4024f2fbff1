"""The user's settings of the window, from one start to the next: a small JSON file that may be lost without harm."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from engine.core.errors import EnvironmentTrouble
from engine.core.files import write_atomically

VERSION = 1
MOST = 1e6  # a number beyond is none of ours


def memory_path() -> Path:
    """`window.json` in the user's folder of settings: $XDG_CONFIG_HOME/brace, else ~/.config/brace."""
    given = Path(os.environ.get("XDG_CONFIG_HOME", ""))
    base = given if given.is_absolute() else Path("~/.config").expanduser()
    return base / "brace" / "window.json"


def load_memory(path: Path) -> tuple[dict[str, Any], str | None]:
    """What was kept, and a line if it could not be read: then the window starts as it does for the first time."""
    try:
        kept = json.loads(path.read_text(encoding="utf-8"))
        if not isinstance(kept, dict) or kept.get("version") != VERSION:
            raise ValueError("it is of another version of Brace")
        return kept, None
    except FileNotFoundError:
        return {}, None
    except OSError as trouble:
        return {}, f"settings not read, {path}: {trouble.strerror or trouble}; starting afresh"
    except (ValueError, RecursionError) as trouble:
        said = "no JSON" if isinstance(trouble, json.JSONDecodeError | UnicodeDecodeError) else str(trouble)
        return {}, f"settings not read, {path}: {said}; starting afresh"


def save_memory(path: Path, kept: dict[str, Any]) -> str | None:
    """Whole or not at all; a line where it cannot be."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, json.dumps({"version": VERSION, **kept}, indent=1).encode())
    except OSError as trouble:
        return f"settings not kept, {path}: {trouble.strerror or trouble}"
    except EnvironmentTrouble as trouble:
        return f"settings not kept, {path}: {trouble.message}"
    return None


def kept_size(kept: dict[str, Any]) -> tuple[int, int] | None:
    """The window's size when it was last closed, in points; None where it was none (minimised, or damaged)."""
    size = kept.get("size")
    if not isinstance(size, list) or len(size) != 2 or not all(isinstance(side, int) for side in size):
        return None
    width, height = size
    return (width, height) if 160 <= width <= 8192 and 120 <= height <= 8192 else None


def taken_over(target: object, kept: Any) -> None:
    """Puts values of known names and of the same kind into an object's attributes; anything else is passed over."""
    if not isinstance(kept, dict):
        return
    for name, value in kept.items():
        now = getattr(target, name, None)
        if isinstance(now, bool) or isinstance(value, bool):
            fits = isinstance(now, bool) and isinstance(value, bool)
        elif isinstance(now, int | float):
            fits = isinstance(value, int | float) and abs(value) < MOST
        else:
            fits = isinstance(now, str) and isinstance(value, str)
        if fits and not name.startswith("_"):
            setattr(target, name, float(value) if isinstance(now, float) else value)
