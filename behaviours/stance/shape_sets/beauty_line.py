"""The beauty line (2.1, 7, figure 2): a large S of legs, torso and neck in the coronal plane, as in the Venus de Milo.

The weight is on one straight leg and its hip out; the other knee is bent, which lets that hip drop; the torso curves
back over the standing foot and the head against it. The sign chooses the bent knee: + the left one, - the right one.
"""

from __future__ import annotations

from behaviours.stance.around import Around
from behaviours.stance.shape import Shape, mirrored, shape
from behaviours.stance.torso import LARGE_S, OPPOSED


def shape_of(intensity: float, around: Around) -> Shape:
    bent_left = _left_knee_bent(abs(intensity))
    return bent_left if intensity >= 0.0 else mirrored(bent_left)


def _left_knee_bent(a: float) -> Shape:
    return shape(
        coronal_class=LARGE_S,
        sagittal_class=LARGE_S,
        coronal=-1.7 * a,
        sagittal=0.5 * a,
        transverse_rad=-0.2 * a,
        collar_z=OPPOSED,
        collar_z_rad=0.07 * a,
        balance_x=-0.65 * a,
        knee_left_rad=0.52 * a,
        pelvis_x_rad=0.06 * a,
        pelvis_y_rad=0.14 * a,
        pelvis_z_rad=-0.2 * a,
        arm_out_left_rad=0.08 * a,
        elbow_left_rad=0.35 * a,
        arm_out_right_rad=0.1 * a,
        elbow_right_rad=0.15 * a,
    )
