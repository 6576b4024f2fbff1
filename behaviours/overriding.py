"""Constants listed and changed by name, as a scenario's `[settings]`, `--set` and the window's sliders do.

settings = override(Settings(), {"block.reach_far_m": 0.8, "lean_turn.neck_deg": [50, 50, 65]})
"""

from __future__ import annotations

from difflib import get_close_matches
from math import isfinite, pi
from typing import Any, get_type_hints

from behaviours.settings import CHOICES, Constant, Settings
from engine.core.errors import BadInput

WORDS = {float: "a finite number", int: "a whole number", bool: "true or false"}
MOST_COUNT, LONGEST_S = 1_000_000, 60.0


def constants() -> dict[str, Constant]:
    """Dotted name -> unit, section, meaning, of every constant there is, in the order of `behaviours.settings`."""
    table = {}
    groups: tuple[Any, ...] = Settings()
    for group_name, group in zip(Settings._fields, groups, strict=True):
        hints = get_type_hints(type(group), include_extras=True)
        for field in group._fields:
            table[f"{group_name}.{field}"] = hints[field].__metadata__[0]
    return table


def override(settings: Settings, changes: dict[str, Any]) -> Settings:
    """A copy with some constants replaced, by dotted name. Angles also by `..._deg`. BadInput names what is wrong.

    Values keep the type of the default (a kernel compiled for a float never meets an int).
    """
    for name, value in changes.items():
        group_name, _, field = name.partition(".")
        group = getattr(settings, group_name, None) if group_name in Settings._fields else None
        in_degrees = field.endswith("_deg")
        if in_degrees:
            field = field.removesuffix("_deg") + "_rad"
        if group is None or field not in group._fields:
            raise BadInput("setting", f"unknown setting {name!r}; expected {_nearest(name)}")
        settings = settings._replace(
            **{group_name: group._replace(**{field: _as_default(name, value, getattr(group, field), in_degrees)})}
        )
    return settings


def _as_default(name: str, value: Any, default: Any, in_degrees: bool) -> Any:
    """The value in the default's own type, degrees turned into radians."""
    scale = pi / 180.0 if in_degrees else 1.0
    try:
        if isinstance(default, tuple):
            if len(value) != len(default):
                raise ValueError
            return tuple(_number(v) * scale for v in value)
        if isinstance(default, bool):
            if not isinstance(value, bool):
                raise ValueError
            return value
        if isinstance(default, str):
            if value not in CHOICES[name]:
                raise BadInput("setting", f"{name} is {value!r}; expected {' | '.join(CHOICES[name])}")
            return str(value)
        number = _number(value)
    except (TypeError, ValueError, OverflowError):
        wanted = f"{len(default)} numbers" if isinstance(default, tuple) else WORDS[type(default)]
        raise BadInput("setting", f"{name} is {value!r}; expected {wanted}") from None
    _check_range(name, value, number, default)
    return int(number) if isinstance(default, int) else number * scale


def _number(value: Any) -> float:
    """A finite number. ValueError or TypeError for anything else, `true` and the text of a number included."""
    if isinstance(value, (bool, str)) or not isfinite(float(value)):
        raise ValueError
    return float(value)


def _check_range(name: str, value: Any, number: float, default: Any) -> None:
    """BadInput for a count below one, a duration below zero, a half-life or period of nothing: there a tick would
    divide by zero, or wait for what is over. Anything else that is a number may be tried.
    """
    if isinstance(default, int):
        if number != int(number) or not 1 <= number <= MOST_COUNT:
            raise BadInput("setting", f"{name} is {value!r}; expected a whole number from 1 to {MOST_COUNT}")
    elif name.endswith("_s"):
        never_none = name.endswith(("half_life_s", "period_s"))
        if number < 0.0 or number > LONGEST_S or (never_none and number == 0.0):
            least = "above 0" if never_none else "from 0"
            raise BadInput("setting", f"{name} is {value!r}; expected seconds, {least} to {LONGEST_S:g}")


def _nearest(name: str) -> str:
    """The few names most like a misspelt one."""
    near = get_close_matches(name, list(constants()), n=3, cutoff=0.5)
    return " or ".join(near) if near else f"one of the groups {', '.join(Settings._fields)}"
