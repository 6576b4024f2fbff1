"""A shape as a file: its states and numbers in TOML, with the points that it is about. What the window's panel saves
and `brace stance FILE.toml` shows.

    version = 1

    [states]
    sagittal_class = "LargeC"

    [numbers]
    sagittal = 1.5

    [points]                      # metres: ahead, left and up of where the character stands
    object_m = [1.2, 0.4, 1.3]

    [wishes.sagittal]             # how firmly the solver keeps to a number; only where it differs
    low = [0.5, 0.01, 4.0, 1.0]   # a penalty's side: basin, its height, far, its height
    high = [0.5, 0.01, 4.0, 1.0]
    weight = 1.0

What is not said is neutral.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from behaviours.stance.penalty import Side, row
from behaviours.stance.shape import WISHES, Numbers, Shape, States, Wish, shape
from engine.core.errors import BadInput

VERSION = 1
POINTS = ("object_m", "reach_left_m", "reach_right_m")
Point = tuple[float, float, float]


class SavedShape(NamedTuple):
    """A shape and the points that it is about, by the names of `solve.solve_stance`; those that are given."""

    shape: Shape
    points: dict[str, Point]


def shape_text(saved: SavedShape) -> str:
    """The file of it: what is neutral is left out. Reading it again gives the very same numbers."""
    lines = ["# a stance of Brace: brace stance FILE.toml -o picture.png", f"version = {VERSION}", ""]
    for title, values, neutral in (
        ("states", saved.shape.states._asdict(), States()._asdict()),
        ("numbers", saved.shape.numbers._asdict(), Numbers()._asdict()),
    ):
        lines += [f"[{title}]", *(f"{k} = {_toml(v)}" for k, v in values.items() if v != neutral[k]), ""]
    if saved.points:
        lines += ["[points]", *(f"{name} = {_toml(list(point))}" for name, point in saved.points.items()), ""]
    for (name, usual), wish in zip(WISHES.items(), saved.shape.wishes, strict=True):
        if wish != usual:
            lines += [f"[wishes.{name}]", f"low = {_toml(list(wish.low))}", f"high = {_toml(list(wish.high))}"]
            lines += [f"weight = {_toml(wish.weight)}", ""]
    return "\n".join(lines)


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return f"[{', '.join(_toml(float(part)) for part in value)}]"
    return repr(float(value)) if isinstance(value, int | float) else f'"{value}"'


def read_shape(path: str | Path) -> SavedShape:
    """The shape of a file. BadInput, in one line, where there is none or it says what no shape can be."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as trouble:
        reason = trouble.strerror if isinstance(trouble, OSError) else "it is no text"
        raise BadInput("stance", f"cannot be read: {reason}", str(path)) from None
    return parse_shape(text, str(path))


def parse_shape(text: str, where: str = "the stance") -> SavedShape:
    """The shape of a file's text. BadInput names what is wrong in it."""
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as trouble:
        raise BadInput("stance", f"no TOML: {trouble}", where) from None
    for key in raw:
        if key not in ("version", "states", "numbers", "points", "wishes"):
            raise BadInput("stance", f"unknown key {key!r}, expected version, states, numbers, points, wishes", where)
    if raw.get("version") != VERSION:
        raise BadInput("stance", f"version is {raw.get('version')!r}, expected {VERSION}", where)
    try:
        wishes = {name: _wish(name, given) for name, given in _table(raw, "wishes").items()}
        numbers = {name: _number(name, value) for name, value in _table(raw, "numbers").items()}
        made = shape(wishes=wishes, **_table(raw, "states"), **numbers)
        return SavedShape(made, {name: _point(name, point) for name, point in _table(raw, "points").items()})
    except BadInput as trouble:
        raise BadInput(trouble.code, trouble.message, where) from None


def _table(raw: Mapping[str, Any], name: str) -> dict[str, Any]:
    table = raw.get(name, {})
    if not isinstance(table, dict):
        raise BadInput("stance", f"{name} is {table!r}, expected a table")
    return table


def _number(name: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise BadInput("stance", f"{name} is {value!r}, expected a number")
    return float(value)


def _point(name: str, value: Any) -> Point:
    if name not in POINTS:
        raise BadInput("stance", f"unknown point {name!r}, expected one of {', '.join(POINTS)}")
    if not isinstance(value, list) or len(value) != 3:
        raise BadInput("stance", f"{name} is {value!r}, expected three numbers")
    x, y, z = (_number(name, part) for part in value)
    return x, y, z


def _wish(name: str, given: Any) -> Wish:
    """One wish; `shape` says which names there are."""
    usual = WISHES.get(name, Wish(Side(1.0, 0.0, 2.0, 1.0), Side(1.0, 0.0, 2.0, 1.0)))
    if not isinstance(given, dict) or not set(given) <= set(Wish._fields):
        raise BadInput("stance", f"wishes.{name} is {given!r}, expected low, high and weight")
    wish = Wish(
        _side(f"wishes.{name}.low", given["low"]) if "low" in given else usual.low,
        _side(f"wishes.{name}.high", given["high"]) if "high" in given else usual.high,
        _number(f"wishes.{name}.weight", given.get("weight", usual.weight)),
    )
    try:
        row(0.0, wish.low, wish.high)
    except ValueError as trouble:
        raise BadInput("stance", f"wishes.{name}: {trouble}") from None
    if wish.weight <= 0.0:
        raise BadInput("stance", f"wishes.{name}.weight is {wish.weight:g}, expected more than 0")
    return wish


def _side(name: str, values: Any) -> Side:
    if not isinstance(values, list) or len(values) != len(Side._fields):
        raise BadInput("stance", f"{name} is {values!r}, expected {', '.join(Side._fields)}")
    return Side(*(_number(name, value) for value in values))
