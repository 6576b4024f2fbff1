"""Reading scenario files: who plays which clip, what is thrown at them, and which constants differ from their defaults.

A scenario is TOML (see the README for a whole one; `behaviours.scenario_spec` has every key). An unknown or impossible
key is reported with its path and, where the file tells, its line.
"""

from __future__ import annotations

import itertools
import re
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from pydantic import ValidationError

from behaviours.scenario_spec import (
    CharacterSpec,
    CommandSpec,
    Scenario,
    Section,
    StanceSpec,
    ThreatSpec,
    ThrowSpec,
    one_of,
)
from behaviours.settings import Settings
from engine.core.errors import BadInput

PLAIN_WORDS = {  # for what pydantic says in words of Python
    "tuple_type": "expected a list",
    "too_short": "expected at least one",
    "model_type": "expected a table of keys",
    "dict_type": "expected a table of keys",
    "missing": "is missing",
}


def load_scenario(path: str | Path, overrides: tuple[str, ...] = ()) -> Scenario:
    """Reads and checks a scenario file, after `key=value` overrides such as `threat.0.speed_mps=28`.

    BadInput names the file, the line where the key stands if it can be found, and what was expected.
    """
    path = Path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as trouble:
        raise BadInput("scenario", f"cannot be read: {trouble.strerror or trouble}", str(path)) from None
    except UnicodeDecodeError:
        raise BadInput("scenario", "is not text; a scenario is a TOML file", str(path)) from None
    return parse_scenario(text, str(path), overrides)


def parse_scenario(text: str, where: str = "scenario", overrides: tuple[str, ...] = ()) -> Scenario:
    """A scenario from its text; `where` names it in errors."""
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as trouble:
        line = re.search(r"at line (\d+)", str(trouble))
        raise BadInput("toml", str(trouble), f"{where}:{line[1]}" if line else where) from None
    for override in overrides:
        _override(raw, override)
    return check_scenario(raw, where, text, overrides)


def check_scenario(
    raw: dict[str, Any], where: str = "scenario", text: str = "", overrides: tuple[str, ...] = ()
) -> Scenario:
    """A scenario from plain data, every key checked. BadInput on the first trouble, counting the rest.

    text, overrides: what the data was read from, so that the trouble's line, or its `--set`, can be named.
    """
    try:
        return Scenario.model_validate(raw)
    except ValidationError as trouble:
        errors = trouble.errors()
        first = errors[0]
        keys = [str(key) for key in first["loc"] if key not in ("str", "tuple[float, float, float]")]
        message = _explain(first, keys)
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        raise BadInput("scenario", message + more, _place_of(keys, where, text, overrides)) from None


def check_threat(raw: Any) -> ThreatSpec:
    """One scripted threat from plain data. BadInput on the first trouble."""
    try:
        return ThreatSpec.model_validate(raw)
    except ValidationError as trouble:
        first = trouble.errors()[0]
        raise BadInput("threat", _explain(first, ["threat", *(str(key) for key in first["loc"])])) from None


def check_throw(command: dict[str, Any]) -> ThrowSpec:
    """The ball of a command {"do": "throw", "at": character, ...}; places and velocities may be arrays. BadInput on
    the first trouble.
    """
    raw = {"at_character" if key == "at" else key: value for key, value in command.items() if key != "do"}
    for key in ("position_m", "velocity_mps", "spin_radps"):
        if isinstance(raw.get(key), np.ndarray):
            raw[key] = raw[key].tolist()
    try:
        return ThrowSpec.model_validate(raw)
    except ValidationError as trouble:
        first = trouble.errors()[0]
        raise BadInput("command", _explain(first, ["throw", *(str(key) for key in first["loc"])])) from None


def _explain(error: Any, keys: list[str]) -> str:
    dotted = ".".join(keys)
    if error["type"] == "extra_forbidden":
        sections: dict[str, type[Section]] = {
            "character": CharacterSpec,
            "threat": ThreatSpec,
            "command": CommandSpec,
            "throw": ThrowSpec,
        }
        section = StanceSpec if "stance" in keys[:-1] else sections.get(keys[0], Scenario)
        return f"unknown key {dotted!r}; {one_of(keys[-1], tuple(section.model_fields))}"
    reason = PLAIN_WORDS.get(error["type"]) or error["msg"].removeprefix("Value error, ")
    given = error.get("input")
    shown = "" if isinstance(given, dict) or given is None else f", found {given!r}"
    return f"{dotted}: {reason}{shown}" if dotted else reason


def _place_of(keys: list[str], where: str, text: str, overrides: tuple[str, ...]) -> str:
    """Where a value comes from: the `--set` that gave it, else the file and, where it can be told, its line."""
    for override in reversed(overrides):
        given = override.partition("=")[0].strip().split(".")
        if keys[: len(given)] == given:
            return f"--set {override}"
    line = _line_of(text, keys)
    return f"{where}:{line}" if line else where


def _line_of(text: str, keys: list[str]) -> int | None:
    """The line of a key such as threat.1.speed_mps in the text; None where it cannot be told."""
    section, nth, seen = keys[0] if keys else "", 0, -1
    if len(keys) > 1 and keys[1].isdigit():
        nth = int(keys[1])
    inside = len(keys) <= 1
    for number, line in enumerate(text.splitlines(), 1):
        head = re.match(r"\s*\[\[?\s*([\w.]+)\s*\]\]?", line)
        if head:
            seen += head[1] == section
            inside = head[1] == section and seen == nth
        elif inside and keys and re.match(rf"\s*{re.escape(keys[-1])}\s*=", line):
            return number
    return None


def _override(raw: dict[str, Any], text: str) -> None:
    """Sets one `a.0.b=value` in the raw data; the value is read as TOML, else taken as a plain word. A constant may be
    named without its `settings.`, as everywhere else.
    """
    dotted, equals, value_text = text.partition("=")
    keys = dotted.strip().split(".")
    if keys[0] in Settings._fields:
        keys.insert(0, "settings")
    if not equals or not all(keys):
        raise BadInput("set", f"{text!r} is not of the form key=value, for instance threat.0.speed_mps=28")
    try:
        value = tomllib.loads(f"v = {value_text}")["v"]
    except tomllib.TOMLDecodeError:
        value = value_text.strip()
    at: Any = raw
    for key, following in itertools.pairwise(keys):
        if isinstance(at, list):
            at = at[_row(at, key, text)]
        else:
            at = at.setdefault(key, [{}] if following.isdigit() else {})
        if not isinstance(at, (dict, list)):
            raise BadInput("set", f"{text!r}: {key!r} holds a value, nothing lies below it")
    if isinstance(at, list):
        at[_row(at, keys[-1], text)] = value
    else:
        at[keys[-1]] = value


def _row(rows: list[Any], key: str, text: str) -> int:
    if not key.isdigit() or int(key) >= len(rows):
        raise BadInput("set", f"{text!r}: there is no entry {key!r}, only 0 to {len(rows) - 1}")
    return int(key)
