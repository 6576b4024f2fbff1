"""Interest (section 7, figure 6): two ways of leaning towards an object, wherever it stands.

Eager: large S curves in both planes, the collars aligned and back, chest first. Curious: large C curves in both planes, the collars aligned
and forward, head first.
"""

from __future__ import annotations

from behaviours.stance.around import Around
from behaviours.stance.shape import Shape, shape
from behaviours.stance.torso import ALIGNED, LARGE_C, LARGE_S


def eager(intensity: float, around: Around) -> Shape:
    a, ahead, left = intensity, around.ahead, around.left
    return shape(
        coronal_class=LARGE_S,
        sagittal_class=LARGE_S,
        collar_y=ALIGNED,
        collar_z=ALIGNED,
        coronal=-1.0 * left * a,
        sagittal=1.6 * ahead * a,
        transverse_rad=0.35 * left * a,
        collar_y_rad=0.25 * a,
        collar_z_rad=0.08 * a,
        balance_x=0.5 * left * a,
        balance_z=0.6 * ahead * a,
        pelvis_x_rad=0.2 * ahead * a,
        pelvis_y_rad=0.2 * left * a,
        gaze=min(abs(a), 1.0),
    )


def curious(intensity: float, around: Around) -> Shape:
    a, ahead, left = intensity, around.ahead, around.left
    return shape(
        coronal_class=LARGE_C,
        sagittal_class=LARGE_C,
        collar_y=ALIGNED,
        collar_z=ALIGNED,
        coronal=-1.0 * left * a,
        sagittal=1.2 * ahead * a,
        transverse_rad=0.5 * left * a,
        collar_y_rad=-0.2 * a,
        collar_z_rad=0.05 * a,
        balance_x=0.6 * left * a,
        balance_z=0.4 * ahead * a,
        pelvis_y_rad=0.25 * left * a,
        gaze=min(abs(a), 1.0),
    )
