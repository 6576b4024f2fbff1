"""The constants of behaviours/settings.py as sliders: what each is called, in which unit it is shown, how far it goes.

The settings declare unit, section and default, not ends; those follow from the unit and the default. A slider that
ends too early takes a typed number (Ctrl-click), and a scenario takes any.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any, NamedTuple

from behaviours.overriding import constants
from behaviours.settings import CHOICES, Settings

UNITS = {"1": "", "yes/no": "", "name": "", "count": "", "1/rad": "/rad", "rad": "°", "N s": "N s"}


class Knob(NamedTuple):
    """One constant. `kind`: number, angle (shown in degrees), triple (three angles), whole, switch, word."""

    name: str  # dotted
    label: str
    kind: str
    default: Any  # in what is shown: degrees for angles
    low: float
    high: float
    unit: str
    help: str
    options: tuple[str, ...] = ()

    @property
    def setting(self) -> str:
        """The name under which a changed value goes into a scenario: angles in degrees."""
        return self.name.removesuffix("_rad") + "_deg" if self.kind in ("angle", "triple") else self.name


@lru_cache(maxsize=1)
def knobs() -> dict[str, list[Knob]]:
    """All of them by group, in the order of the file."""
    groups: dict[str, list[Knob]] = {}
    defaults: Any = Settings()
    for name, constant in constants().items():
        group, field = name.split(".")
        groups.setdefault(group, []).append(_knob(name, constant, getattr(getattr(defaults, group), field)))
    return groups


def _knob(name: str, constant, default: Any) -> Knob:
    label = _label(name.split(".")[1])
    help = f"{constant.meaning} ({constant.section})"
    unit = UNITS.get(constant.unit, constant.unit)
    if name in CHOICES:
        return Knob(name, label, "word", default, 0, 0, unit, help, CHOICES[name])
    if isinstance(default, bool):
        return Knob(name, label, "switch", default, 0, 1, unit, help)
    if isinstance(default, int):
        return Knob(name, label, "whole", default, 0, max(4 * default, 10), unit, help)
    if isinstance(default, tuple):
        degrees = tuple(round(math.degrees(angle), 3) for angle in default)
        return Knob(name, label, "triple", degrees, 0, 180.0 if max(degrees) > 90 else 90.0, "°", help)
    if constant.unit == "rad":
        turned = round(math.degrees(default), 3)
        return Knob(name, label, "angle", turned, 0, 180.0 if turned > 20 else 20.0, "°", help)
    return Knob(name, label, "number", default, *_ends(constant.unit, default), unit, help)


def _ends(unit: str, default: float) -> tuple[float, float]:
    """Shares go from 0 (or -1) to 1; other numbers to about three times the default, a round number."""
    if unit == "1" and abs(default) <= 1.0:
        return (-1.0, 1.0) if default < 0.0 else (0.0, 1.0)
    if default == 0.0:
        return -0.1, 0.1
    magnitude = 10.0 ** math.floor(math.log10(3.0 * abs(default)))
    return (0.0, math.ceil(3.0 * abs(default) / magnitude) * magnitude)


def _label(field: str) -> str:
    """`reach_far_m` -> `reach far`."""
    for ending in ("_rad", "_mps", "_m", "_s", "_Ns"):
        field = field.removesuffix(ending)
    return field.replace("_", " ")
