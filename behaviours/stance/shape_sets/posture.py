"""Alberts' posture scale (section 7, figure 5), from hunched at -1 over relaxed at 0 to over-erect at +1.

Below zero the whole body makes one large C forward, above it the spine alone a small S. The collars go forward and
down below, back above. Knees are straight over most of the range and bend only towards the hunched end.
"""

from __future__ import annotations

from behaviours.stance.around import Around
from behaviours.stance.shape import Shape, shape
from behaviours.stance.shape_sets import curves
from behaviours.stance.torso import LARGE_C, SMALL_S

# Alberts' thirteen words
WORDS = {
    "hunched": -1.0,
    "stooped": -0.88,
    "slumped": -0.76,
    "drooped": -0.64,
    "slouched": -0.52,
    "sagging": -0.4,
    "tired": -0.28,
    "relaxed": 0.0,
    "straight": 0.2,
    "upright": 0.4,
    "uptight": 0.6,
    "erect": 0.8,
    "over-erect": 1.0,
}


def shape_of(intensity: float, around: Around) -> Shape:
    return _collapsed(-intensity) if intensity < 0.0 else _erect(intensity)


def _collapsed(a: float) -> Shape:
    knees = 0.85 * curves.late(a, 0.3)
    arms = 0.12 * curves.late(a, 0.2)
    return shape(
        sagittal_class=LARGE_C,
        sagittal=2.7 * a,
        collar_y_rad=-0.4 * a,
        collar_z_rad=-0.1 * a,
        pelvis_x_rad=-0.15 * a,
        balance_z=0.1 * a,
        knee_left_rad=knees,
        knee_right_rad=knees,
        arm_forward_left_rad=arms,
        arm_forward_right_rad=arms,
        elbow_left_rad=0.2 * a,
        elbow_right_rad=0.2 * a,
    )


def _erect(a: float) -> Shape:
    return shape(
        sagittal_class=SMALL_S,
        sagittal=1.5 * a,
        collar_y_rad=0.4 * a,
        collar_z_rad=0.08 * curves.late(a, 0.3),
        pelvis_x_rad=0.06 * a,
        balance_z=0.12 * a,
        elbow_left_rad=-0.2 * a,
        elbow_right_rad=-0.2 * a,
        arm_out_left_rad=-0.04 * a,
        arm_out_right_rad=-0.04 * a,
    )
