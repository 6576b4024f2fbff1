"""Recoil (section 7, figures 6 and 7): two ways of shrinking from an object, wherever it stands.

They differ in structure, not only in degree. Mild: both planes one large C away from the object, the collars one rigid unit both ways, some
weight shifted away, the pelvis turned. Strong: a large S sideways over a small C forward, the collars opposed in Y and drawn up
together in Z, more shift, more turning.
"""

from __future__ import annotations

from behaviours.stance.around import Around
from behaviours.stance.shape import Shape, shape
from behaviours.stance.shape_sets.curves import standing_on
from behaviours.stance.torso import ALIGNED, LARGE_C, LARGE_S, OPPOSED, SMALL_C


def mild(intensity: float, around: Around) -> Shape:
    a, ahead, side = intensity, around.ahead, around.side
    away = _sideways(around)  # + away to the right, from an object on the left
    return shape(
        coronal_class=LARGE_C,
        sagittal_class=LARGE_C,
        collar_y=OPPOSED,
        collar_z=OPPOSED,
        dominant=standing_on(-away * a),
        coronal=1.0 * away * a,
        sagittal=-0.9 * ahead * a,
        transverse_rad=-0.35 * side * a,
        collar_y_rad=-0.2 * side * a,
        collar_z_rad=0.08 * away * a,
        balance_x=-0.45 * away * a,
        balance_z=-0.4 * ahead * a,
        pelvis_x_rad=-0.08 * ahead * a,
        pelvis_y_rad=-0.2 * side * a,
        gaze=0.7 * min(abs(a), 1.0),
    )


def strong(intensity: float, around: Around) -> Shape:
    a, ahead, side = intensity, around.ahead, around.side
    away = _sideways(around)
    return shape(
        coronal_class=LARGE_S,
        sagittal_class=SMALL_C,
        collar_y=OPPOSED,
        collar_z=ALIGNED,
        coronal=2.2 * away * a,
        sagittal=1.3 * a,
        gaze=0.7 * min(abs(a), 1.0),
        balance_x=-0.8 * away * a,
        balance_z=-0.6 * ahead * a,
        pelvis_y_rad=-0.4 * side * a,
        transverse_rad=-0.5 * side * a,
        collar_y_rad=-0.25 * side * a,
        collar_z_rad=0.25 * a,
    )


def _sideways(around: Around) -> float:
    """How much of the recoil goes sideways: all for an object at the side, and a part even from one straight ahead."""
    return around.side * (0.6 + 0.4 * abs(around.left))
