"""Turn away (Hermens 2006, 3.2.3, fig. 3.4): better struck on the back of the head than in the face."""

from __future__ import annotations

import math

from behaviours.rules.lean import SPINE
from engine.maths import quaternion
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

TURN_LEFT, TURN_RIGHT = 1.0, -1.0


@njit(cache=True)
def turn_side(direction, dead_ahead_rad, previous_side):
    """Which way to turn, +1 left or -1 right: away from the side the threat comes from.

    direction: unit travel of the threat in the heading's frame. Within a narrow band dead ahead or dead behind the
    side last chosen is kept (0: none yet, then right), so that a threat that wavers there does not make the character
    flicker.
    """
    if abs(direction[1]) <= math.sin(dead_ahead_rad) * math.sqrt(direction[0] ** 2 + direction[1] ** 2):
        return TURN_LEFT if previous_side > 0.0 else TURN_RIGHT
    return TURN_RIGHT if direction[1] < 0.0 else TURN_LEFT


@njit(cache=True)
def wanted_turn(head_yaw_rad, direction, side):
    """The yaw, radians, positive left, that would bring the back of the head to the threat, going round by `side`.

    head_yaw_rad: where the face points, in the heading's frame, like `direction`. A head that is already past the
    goal gets a small turn back: the result lies between a quarter turn against `side` and three quarters with it.
    """
    if direction[0] * direction[0] + direction[1] * direction[1] < 1e-12:
        return 0.0
    turn = side * (math.atan2(direction[1], direction[0]) - head_yaw_rad)
    turn = turn - 2.0 * math.pi * math.floor((turn + 0.5 * math.pi) / (2.0 * math.pi))
    return side * turn


@inner_kernel
def _within(angle_rad, greatest_rad):
    return min(greatest_rad, max(-greatest_rad, angle_rad))


@njit(cache=True)
def turn_angles(wanted_rad, turn, maxima):
    """What pelvis, waist, back and neck each contribute, radians: the neck first, the trunk shares what remains."""
    neck = _within(wanted_rad, maxima.neck_rad[2])
    left_over = wanted_rad - neck
    back = _within(left_over * maxima.back_share, maxima.back_rad[2])
    waist = _within(left_over * maxima.waist_share, maxima.waist_rad[2])
    pelvis = _within(left_over * maxima.pelvis_share, maxima.pelvis_rad[2])
    return (pelvis * turn, waist * turn, back * turn, neck * turn)


@njit(cache=True)
def turn_away(rotations, wanted_rad, turn, maxima):
    """Turns each joint about its own Z, as the lean has left it, in place. `maxima` is the settings' LeanTurn group."""
    angles = turn_angles(wanted_rad, turn, maxima)
    for i in range(len(SPINE)):
        turned = quaternion.multiply(quaternion.at(rotations, SPINE[i]), quaternion.about_z(angles[i]))
        quaternion.put(rotations, SPINE[i], turned)
