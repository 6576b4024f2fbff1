"""What a sculpted part is, and the few cuts that all of them share."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body import skeleton as sk
from engine.render.surface import Shape, carve, half_space

SHELL, JOINT, VISOR, SHOE = range(4)  # materials: the figure's colour, its darker joints, the face's glass, the shoe


class Part(NamedTuple):
    """One rigid piece, in the frame of its joint."""

    joint: int
    material: int
    shape: Shape
    cell_m: float  # of the grid it is meshed on: about a fifth of its radius
    coarsest_m: float = np.inf  # cells beyond which something thin would break up


def cut(limb: Shape, bone_m: np.ndarray, short_m: float, round_m: float, start_m: float | None = None) -> Shape:
    """A limb squared off short of the joint at its bone's end, and of its own where told: a rim around the ball there.

    The cuts are level, so that they fall on one layer of the grid and come out straight.
    """
    cutters = [half_space(bone_m + (0, 0, short_m), (0, 0, 1.0))]
    if start_m is not None:
        cutters.append(half_space((0, 0, -start_m), (0, 0, -1.0)))
    return carve(round_m, limb, *cutters)


def outwards(side: int) -> float:
    """+1 on the left, -1 on the right: away from the body along Y."""
    return 1.0 if side == sk.LEFT else -1.0
