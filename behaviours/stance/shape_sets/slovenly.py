"""A slovenly stance (section 7): the pelvis thrust forward, the back hanging behind it, the chest sunk, the head put
out.
"""

from __future__ import annotations

from behaviours.stance.around import Around
from behaviours.stance.shape import Shape, shape
from behaviours.stance.torso import SMALL_C


def shape_of(intensity: float, around: Around) -> Shape:
    a = intensity
    return shape(
        sagittal_class=SMALL_C,
        sagittal=1.5 * a,
        abdomen_x_rad=-0.2 * a,
        collar_y_rad=-0.3 * a,
        collar_z_rad=-0.12 * a,
        pelvis_x_rad=-0.25 * a,
        balance_z=0.1 * a,
        balance_x=-0.25 * a,
        knee_left_rad=max(0.12 * a, 0.0),
        arm_out_left_rad=0.06 * a,
        arm_out_right_rad=0.06 * a,
        arm_forward_left_rad=-0.05 * a,
        arm_forward_right_rad=-0.05 * a,
    )
