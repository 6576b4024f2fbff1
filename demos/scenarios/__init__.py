"""Scenarios that come with Brace, known by name: TOML files here, and programs of `demos` that make one."""

from __future__ import annotations

from pathlib import Path

from engine.core.errors import BadInput

FOLDER = Path(__file__).resolve().parent
PROGRAMS = ("gauntlet", "crowd")  # modules of demos with scenario() -> what a file would say, as plain data


def names() -> list[str]:
    """The names of all scenario files that come with Brace."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def find_scenario(name_or_path: str) -> Path:
    """The scenario file that a user means: a path, or the name of one of ours. BadInput lists ours, nearest first."""
    path = Path(name_or_path)
    if name_or_path in names():
        return FOLDER / f"{name_or_path}.toml"
    if path.suffix == ".toml" or path.exists():
        return path
    from demos.cli import nearest

    known = [*names(), *PROGRAMS]
    raise BadInput("scenario", f"no file and no scenario {name_or_path!r}; {nearest(name_or_path, known)}")
