"""The shape sets (section 6): a name, a number, and a procedure that makes a shape of them.

To add one: copy a neighbour, give it a name in SETS. A procedure takes the intensity (1 is a full, clear instance; it
may be negative and go past 1) and the surroundings (`around.Around`), and returns a `shape`. At intensity 0 it is
neutral.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable
from typing import NamedTuple

from behaviours.stance.around import Around
from behaviours.stance.shape import Shape
from behaviours.stance.shape_sets import beauty_line, interest, posture, reach, recoil, slovenly, straight_spine
from engine.core.errors import BadInput


class ShapeSet(NamedTuple):
    """A named family of stances."""

    shape_of: Callable[[float, Around], Shape]
    low: float  # the intensities that it was made for
    high: float
    meaning: str
    needs_object: bool = False


SETS = {
    "posture": ShapeSet(posture.shape_of, -1.0, 1.0, "Alberts' scale: -1 hunched, 0 relaxed, +1 over-erect"),
    "beauty-line": ShapeSet(beauty_line.shape_of, -1.0, 1.0, "the S of Venus; + bends the left knee, - the right one"),
    "slovenly": ShapeSet(slovenly.shape_of, 0.0, 1.0, "pelvis thrust forward, chest sunk"),
    "straight-spine": ShapeSet(straight_spine.shape_of, -1.0, 1.0, "a straight back, tipped at the abdomen; + forward"),
    "recoil-mild": ShapeSet(recoil.mild, 0.0, 1.0, "apprehension: curls and turns away from the object", True),
    "recoil-strong": ShapeSet(recoil.strong, 0.0, 1.0, "aversion: thrown off line, away from the object", True),
    "interest": ShapeSet(interest.eager, 0.0, 1.0, "an open, S-shaped leaning towards the object", True),
    "interest-curious": ShapeSet(interest.curious, 0.0, 1.0, "bends over to the object to see", True),
    "reach": ShapeSet(reach.plain, 0.0, 1.0, "reaches without a word about it"),
    "reach-beauty-line": ShapeSet(reach.with_beauty_line, -1.0, 1.0, "reaches out of the beauty line"),
    "reach-eager": ShapeSet(reach.eager, 0.0, 1.0, "goes to meet what it reaches for"),
    "reach-reluctant": ShapeSet(reach.reluctant, 0.0, 1.0, "the hand goes, the body does not want to"),
}


class Named(NamedTuple):
    """A set and an intensity that a word stands for."""

    set_name: str
    intensity: float


def meaning_of(name: str, intensity: float = 1.0) -> Named:
    """What a set's name, or one of Alberts' words for a posture, stands for; a word's own intensity is scaled by the
    given one.

    BadInput for an unknown name lists all, nearest first.
    """
    if name in SETS:
        return Named(name, intensity)
    if name in posture.WORDS:
        return Named("posture", posture.WORDS[name] * intensity)
    known = (*SETS, *posture.WORDS)
    near = difflib.get_close_matches(name, known, n=3, cutoff=0.4)
    every = [*near, *(k for k in known if k not in near)]
    raise BadInput("stance", f"unknown stance {name!r}, expected one of {', '.join(every)}")


def shape_of(name: str, intensity: float, around: Around) -> Shape:
    """The shape of a set, or of Alberts' word, at an intensity."""
    set_name, intensity = meaning_of(name, intensity)
    return SETS[set_name].shape_of(float(intensity), around)
