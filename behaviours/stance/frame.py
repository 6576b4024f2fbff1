"""The one place where the paper's frame (X left, Y up, Z forward) meets the project's (X forward, Y left, Z up).

Both are right-handed and the axes change places in a circle, so a turn about a paper axis is the turn about the
project axis that it becomes: X, sagittal, +X bends forward: about project Y. Z, coronal, +Z bends to the right: about
project X. Y, twist, +Y turns to the left: about project Z. A joint's three angles are taken together as
`engine.body.limits` takes them apart, so each of the paper's degrees of freedom is one number with one limit.
"""

from __future__ import annotations

from engine.body import limits
from engine.maths.kernel import njit


@njit(cache=True)
def rotation(x_rad, y_rad, z_rad):
    """A joint's local rotation from the paper's three angles, radians."""
    return limits.from_components(z_rad, x_rad, y_rad)


@njit(cache=True)
def angles(q):
    """The paper's angles (X, Y, Z), radians, of a joint's local rotation; the inverse of `rotation`."""
    swing_x, swing_y, twist = limits.components(q)
    return (swing_y, twist, swing_x)


@njit(cache=True)
def point(paper):
    """A point or direction of the paper's frame in the project's."""
    return (paper[2], paper[0], paper[1])
