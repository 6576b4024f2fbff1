"""Interest (section 7, figure 6): two ways of leaning towards an object, wherever it stands.

Eager: large S curves in both planes, the collars aligned and back, chest first. Curious: large C curves in both
planes, the collars aligned and forward, head first.
"""

from __future__ import annotations

from behaviours.stance.around import Around
from behaviours.stance.shape import Shape, shape
from behaviours.stance.torso import ALIGNED, LARGE_C, LARGE_S


def eager(intensity: float, around: Around) -> Shape:
    a, ahead, left, turn = intensity, around.bow, around.left, around.turn
    return shape(
        coronal_class=LARGE_S,
        sagittal_class=LARGE_S,
        collar_y=ALIGNED,
        collar_z=ALIGNED,
        coronal=-1.6 * left * a,
        sagittal=2.0 * ahead * a,
        transverse_rad=0.45 * turn * a,
        collar_y_rad=0.25 * a,
        collar_z_rad=0.08 * a,
        balance_x=0.5 * left * a,
        balance_z=0.6 * ahead * a,
        pelvis_x_rad=0.2 * ahead * a,
        pelvis_y_rad=0.25 * turn * a,
        knee_left_rad=0.12 * max(a, 0.0),
        knee_right_rad=0.12 * max(a, 0.0),
        elbow_left_rad=0.35 * max(a, 0.0),
        elbow_right_rad=0.35 * max(a, 0.0),
        arm_forward_left_rad=-0.2 * ahead * a,
        arm_forward_right_rad=-0.2 * ahead * a,
        arm_out_left_rad=0.08 * max(a, 0.0),
        arm_out_right_rad=0.08 * max(a, 0.0),
        gaze=min(abs(a), 1.0),
    )


def curious(intensity: float, around: Around) -> Shape:
    a, ahead, left, turn = intensity, around.bow, around.left, around.turn
    return shape(
        coronal_class=LARGE_C,
        sagittal_class=LARGE_C,
        collar_y=ALIGNED,
        collar_z=ALIGNED,
        coronal=-1.2 * left * a,
        sagittal=1.5 * ahead * a,
        transverse_rad=0.5 * turn * a,
        collar_y_rad=-0.2 * a,
        collar_z_rad=0.05 * a,
        balance_x=0.5 * left * a,
        balance_z=0.4 * ahead * a,
        pelvis_x_rad=0.12 * ahead * a,
        pelvis_y_rad=0.25 * turn * a,
        knee_left_rad=0.2 * max(a, 0.0),
        knee_right_rad=0.2 * max(a, 0.0),
        elbow_left_rad=0.5 * max(a, 0.0),
        elbow_right_rad=0.5 * max(a, 0.0),
        arm_turn_left_rad=0.2 * a,
        arm_turn_right_rad=0.2 * a,
        gaze=min(abs(a), 1.0),
    )
