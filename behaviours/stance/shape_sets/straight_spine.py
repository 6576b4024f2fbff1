"""A straight spine (section 7): the back is a board; only the abdomen tips it, forward for +, back for -."""

from __future__ import annotations

from behaviours.stance.around import Around
from behaviours.stance.shape import Shape, shape
from behaviours.stance.shape_sets import curves


def shape_of(intensity: float, around: Around) -> Shape:
    forward, back = curves.soft_positive(intensity), curves.soft_positive(-intensity)
    rest = curves.soft_positive(0.0)  # the rounded corners, taken off so that 0 stays neutral
    return shape(
        abdomen_x_rad=0.65 * (forward - rest) - 0.4 * (back - rest),
        pelvis_x_rad=0.2 * (forward - rest) - 0.1 * (back - rest),
    )
