"""What a stance is made of (section 6): a *state set* that says which kind of shape, and a *shape vector* of numbers.
All zeros is neutral.

Signs are the paper's: X bends forward, Z bends or leans to the right, Y turns to the left; balance X is to the left,
Z ahead.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple, Protocol

import numpy as np

from behaviours.stance.lower_body import KNEES_EXACT, TRADE_OFFS
from behaviours.stance.penalty import Side
from behaviours.stance.torso import ALIGNED, COLLAR_STATES, SHAPE_CLASSES, STRAIGHT
from engine.core.errors import BadInput
from engine.core.random import Stream

# the foot that carries the balance: the one with more weight on it, or one that is named (the other may then be
# lifted)
DOMINANT = ("heavier", "left", "right")
HEAVIER, LEFT_FOOT, RIGHT_FOOT = DOMINANT


class Chance(Protocol):
    """A stream of chance, such as a world's (`engine.core.random`)."""

    def normal(self) -> float: ...


class States(NamedTuple):
    """Which kind of shape: the space that the numbers move in."""

    sagittal_class: str = STRAIGHT
    coronal_class: str = STRAIGHT
    collar_y: str = ALIGNED
    collar_z: str = ALIGNED
    trade_off: str = KNEES_EXACT
    dominant: str = HEAVIER
    solve_abdomen: bool = False  # whether the solver may tip the whole torso at the abdomen


ALLOWED = {
    "sagittal_class": SHAPE_CLASSES,
    "coronal_class": SHAPE_CLASSES,
    "collar_y": COLLAR_STATES,
    "collar_z": COLLAR_STATES,
    "trade_off": TRADE_OFFS,
    "dominant": DOMINANT,
    "solve_abdomen": (False, True),
}


class Numbers(NamedTuple):
    """The shape vector. Amplitudes are wanted values: the solver keeps to them unless a wrist target or a limit
    forbids.
    """

    coronal: float = 0.0
    sagittal: float = 0.0
    transverse_rad: float = 0.0
    collar_y_rad: float = 0.0
    collar_z_rad: float = 0.0
    abdomen_x_rad: float = 0.0
    pelvis_x_rad: float = 0.0
    pelvis_y_rad: float = 0.0
    pelvis_z_rad: float = 0.0
    balance_x: float = 0.0
    balance_z: float = 0.0
    knee_left_rad: float = 0.0
    knee_right_rad: float = 0.0
    rise_rad: float = 0.0
    width_m: float = 0.0
    arm_out_left_rad: float = 0.0
    arm_out_right_rad: float = 0.0
    arm_forward_left_rad: float = 0.0
    arm_forward_right_rad: float = 0.0
    arm_turn_left_rad: float = 0.0
    arm_turn_right_rad: float = 0.0
    elbow_left_rad: float = 0.0
    elbow_right_rad: float = 0.0
    swivel_left_rad: float = 0.0
    swivel_right_rad: float = 0.0
    palm_left_rad: float = 0.0
    palm_right_rad: float = 0.0
    gaze: float = 0.0


class Range(NamedTuple):
    """How far a number of the vector goes on a slider, and what it does."""

    low: float
    high: float
    meaning: str


RANGES = {
    "coronal": Range(-4.0, 4.0, "amplitude of the spine's curve sideways, + bends right"),
    "sagittal": Range(-4.0, 4.0, "amplitude of the spine's curve forward and back"),
    "transverse_rad": Range(-1.2, 1.2, "twist of the spine, shared equally by its joints, + turns left"),
    "collar_y_rad": Range(-0.5, 0.5, "collar bones back (aligned), turned left (opposed)"),
    "collar_z_rad": Range(-0.17, 0.5, "collar bones up (aligned), left one up (opposed)"),
    "abdomen_x_rad": Range(-0.6, 1.0, "offset of the abdomen, + bows the whole torso forward"),
    "pelvis_x_rad": Range(-0.6, 0.9, "pelvis tipped forward"),
    "pelvis_y_rad": Range(-0.7, 0.7, "pelvis turned left against the line through the ankles"),
    "pelvis_z_rad": Range(-0.3, 0.3, "left hip up (gives way to the knees unless the pelvis is exact)"),
    "balance_x": Range(-1.5, 1.5, "weight over the left foot (+1) or the right one (-1)"),
    "balance_z": Range(-1.5, 1.5, "weight ahead or back, in half feet"),
    "knee_left_rad": Range(0.0, 2.0, "left knee bent"),
    "knee_right_rad": Range(0.0, 2.0, "right knee bent"),
    "rise_rad": Range(0.0, 0.8, "heels up, standing on ball and toes"),
    "width_m": Range(-0.15, 0.6, "feet farther apart than neutral"),
    "arm_out_left_rad": Range(-0.15, 2.5, "left arm away from the body"),
    "arm_out_right_rad": Range(-0.15, 2.5, "right arm away from the body"),
    "arm_forward_left_rad": Range(-0.8, 2.5, "left arm forward"),
    "arm_forward_right_rad": Range(-0.8, 2.5, "right arm forward"),
    "arm_turn_left_rad": Range(-1.0, 1.5, "left upper arm turned in, so that a bent elbow brings the hand to the body"),
    "arm_turn_right_rad": Range(-1.0, 1.5, "right upper arm turned in"),
    "elbow_left_rad": Range(-0.28, 2.2, "left elbow bent more than neutral"),
    "elbow_right_rad": Range(-0.28, 2.2, "right elbow bent more than neutral"),
    "swivel_left_rad": Range(-0.8, 1.5, "left elbow away from the body, when the wrist has a target"),
    "swivel_right_rad": Range(-0.8, 1.5, "right elbow away from the body, when the wrist has a target"),
    "palm_left_rad": Range(-1.5, 1.5, "left forearm turned, palm back"),
    "palm_right_rad": Range(-1.5, 1.5, "right forearm turned, palm back"),
    "gaze": Range(0.0, 1.0, "how far the head turns to what it looks at"),
}


class Wish(NamedTuple):
    """How firmly the solver keeps to one wanted number: its penalty (see `penalty`) and its weight in eq. 5."""

    low: Side
    high: Side
    weight: float = 1.0


def evenly(basin: float, far: float, weight: float = 1.0) -> Wish:
    """A wish that is alike on both sides: next to nothing in the basin, and 1 at the far point."""
    side = Side(basin, 0.01, far, 1.0)
    return Wish(side, side, weight)


# by the solver's unknowns; units are those of the numbers
WISHES = {
    "coronal": evenly(0.2, 2.0),
    "sagittal": evenly(0.2, 2.5),
    "transverse": evenly(0.08, 0.8),
    "collar_y": evenly(0.06, 0.5),
    "collar_z": evenly(0.04, 0.3),
    "abdomen_x": evenly(0.06, 0.6),
}


class Shape(NamedTuple):
    """A state set, a shape vector, and how firmly the solver keeps to it."""

    states: States = States()
    numbers: Numbers = Numbers()
    wishes: tuple[Wish, ...] = tuple(WISHES.values())


def shape(*, wishes: Mapping[str, Wish] | None = None, **values: Any) -> Shape:
    """A shape from the names of its states and numbers; wishes: by unknown, those that differ from WISHES.

    BadInput names what is unknown, not allowed or not finite.
    """
    states, numbers = {}, {}
    for name in wishes or {}:
        if name not in WISHES:
            raise BadInput("stance", f"unknown wish {name!r}, expected some of {', '.join(WISHES)}")
    for name, value in values.items():
        if name in ALLOWED:
            if value not in ALLOWED[name]:
                raise BadInput("stance", f"{name} is {value!r}, expected one of {', '.join(map(str, ALLOWED[name]))}")
            states[name] = value
        elif name in RANGES:
            if not np.isfinite(value):
                raise BadInput("stance", f"{name} is {value}, expected a finite number")
            numbers[name] = float(value)
        else:
            known = (*ALLOWED, *RANGES)
            close = difflib.get_close_matches(name, known, n=3)
            raise BadInput("stance", f"unknown shape parameter {name!r}, expected one of {', '.join(close or known)}")
    return Shape(States(**states), Numbers(**numbers), tuple({**WISHES, **(wishes or {})}.values()))


def changed(base: Shape, **values) -> Shape:
    """A shape with some states and numbers replaced."""
    new = shape(**{**base.states._asdict(), **base.numbers._asdict(), **values})
    return new._replace(wishes=base.wishes)


def mix(start: Shape, end: Shape, weight: float) -> Shape:
    """The numbers between (or, past 0 and 1, beyond) two shape vectors; the states of `end`, but of `start` at 0."""
    a, b = np.array(start.numbers), np.array(end.numbers)
    return (start if weight == 0.0 else end)._replace(numbers=Numbers(*(a + weight * (b - a)).tolist()))


def varied(base: Shape, chance: Stream, amount: float) -> Shape:
    """The same stance, never quite the same: each number strays by about `amount` of its range (section 6).

    Width, rise and gaze, which are decisions and not looseness, stay.
    """
    numbers = {}
    for name, value in base.numbers._asdict().items():
        stray = chance.normal() * amount * 0.5 * (RANGES[name].high - RANGES[name].low)
        numbers[name] = value if name in ("width_m", "rise_rad", "gaze") else within(name, value + stray)
    return base._replace(numbers=Numbers(**numbers))


def wind_up(base: Shape, share: float = 0.3) -> Shape:
    """The shape taken before moving into another: its vector negated and reduced (section 6), as far as ranges
    allow.
    """
    opposite = {name: within(name, -share * value) for name, value in base.numbers._asdict().items()}
    return base._replace(numbers=Numbers(**{**opposite, "width_m": base.numbers.width_m, "gaze": base.numbers.gaze}))


def within(name: str, value: float) -> float:
    """A number held in its range."""
    return min(max(value, RANGES[name].low), RANGES[name].high)


def mirrored(base: Shape) -> Shape:
    """The shape as a mirror shows it."""
    states, numbers = base.states, base.numbers._asdict()
    flipped = {name: -numbers[name] for name in _changing_sign(states)}
    sides = {name: numbers[_other_side(name)] for name in numbers if "left" in name or "right" in name}
    other = {LEFT_FOOT: RIGHT_FOOT, RIGHT_FOOT: LEFT_FOOT}.get(states.dominant, HEAVIER)
    return base._replace(states=states._replace(dominant=other), numbers=Numbers(**{**numbers, **flipped, **sides}))


def _changing_sign(states: States) -> Iterable[str]:
    yield from ("coronal", "transverse_rad", "pelvis_y_rad", "pelvis_z_rad", "balance_x")
    if states.collar_y != ALIGNED:
        yield "collar_y_rad"
    if states.collar_z != ALIGNED:
        yield "collar_z_rad"


def _other_side(name: str) -> str:
    return name.replace("left", "right") if "left" in name else name.replace("right", "left")
