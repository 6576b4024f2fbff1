"""Recoil (section 7, figures 6 and 7): two ways of shrinking from an object, wherever it stands.

They differ in structure, not only in degree. Mild: both planes one large C away from the object, the collars one
rigid unit both ways, some weight shifted away, the pelvis turned. Strong: a large S sideways over a small C forward,
the collars opposed in Y and drawn up together in Z, more shift, more turning.
"""

from __future__ import annotations

from typing import Any

from behaviours.stance.around import Around
from behaviours.stance.shape import LEFT_FOOT, RIGHT_FOOT, Shape, shape
from behaviours.stance.torso import ALIGNED, LARGE_C, LARGE_S, OPPOSED, SMALL_C


def mild(intensity: float, around: Around) -> Shape:
    a, ahead, side = intensity, around.ahead, around.side
    away = _sideways(around)  # + to the right, from an object on the left
    return shape(
        coronal_class=LARGE_C,
        sagittal_class=LARGE_C,
        collar_y=OPPOSED,
        collar_z=OPPOSED,
        dominant=_standing_on(-away * a),
        coronal=1.2 * away * a,
        sagittal=-1.0 * ahead * a,
        transverse_rad=-0.4 * side * a,
        collar_y_rad=-0.22 * side * a,
        collar_z_rad=0.09 * away * a,
        balance_x=-0.45 * away * a,
        balance_z=-0.45 * ahead * a,
        pelvis_x_rad=-0.1 * ahead * a,
        pelvis_y_rad=-0.22 * side * a,
        knee_left_rad=0.12 * max(a, 0.0),
        knee_right_rad=0.12 * max(a, 0.0),
        gaze=0.75 * min(abs(a), 1.0),
        **_arms(around, 0.5 * a),
    )


def strong(intensity: float, around: Around) -> Shape:
    a, ahead, side = intensity, around.ahead, around.side
    away = _sideways(around)
    turn = 0.7 if any(around.reaching) else 1.0  # a hand that has to be somewhere holds the body back
    over = 1.0 - around.low  # from something on the ground it draws itself up instead of curling over it
    knees: dict[str, Any] = {f"knee_{'left' if side > 0.0 else 'right'}_rad": 0.35 * over * abs(a)}
    return shape(
        coronal_class=LARGE_S,
        sagittal_class=SMALL_C,
        collar_y=OPPOSED,
        collar_z=ALIGNED,
        dominant=_standing_on(-away * a),
        coronal=-2.4 * away * a,  # the upper part of the S, chest to head, bends away
        sagittal=(0.2 + 1.0 * over) * a,
        abdomen_x_rad=-(0.22 + 0.15 * around.low) * ahead * a,
        transverse_rad=-0.6 * turn * side * a,
        collar_y_rad=-0.28 * side * a,
        collar_z_rad=0.3 * a,
        balance_x=-0.8 * away * a,
        balance_z=-0.65 * ahead * a,
        pelvis_x_rad=-0.12 * ahead * a,
        pelvis_y_rad=-0.42 * turn * side * a,
        gaze=0.75 * min(abs(a), 1.0),
        **_arms(around, a),
        **knees,
    )


def _sideways(around: Around) -> float:
    """How much of the recoil goes sideways: all for an object at the side, and a part even from one straight ahead."""
    return around.side * (0.6 + 0.4 * abs(around.left))


def _standing_on(side: float) -> str:
    return LEFT_FOOT if side >= 0.0 else RIGHT_FOOT


def _arms(around: Around, a: float) -> dict[str, Any]:
    """The near hand comes up between body and object, the far one is drawn along behind."""
    near, far = ("left", "right") if around.side > 0.0 else ("right", "left")
    return {
        f"elbow_{near}_rad": 0.9 * max(a, 0.0),
        f"arm_forward_{near}_rad": 0.3 * around.ahead * a,
        f"arm_out_{near}_rad": 0.12 * max(a, 0.0),
        f"arm_turn_{near}_rad": 0.35 * a,
        f"elbow_{far}_rad": 0.35 * max(a, 0.0),
        f"arm_forward_{far}_rad": -0.3 * around.ahead * a,
        f"arm_out_{far}_rad": 0.2 * max(a, 0.0),
    }
