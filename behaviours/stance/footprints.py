"""Where the feet stand, and what goes with it: rising on the toes, the ground that bears, the middle of the stance."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from engine.body import footing
from engine.body.skeleton import HIPS, TOES
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

# feet of a neutral stance
TOES_OUT_RAD = math.radians(7.0)
WIDTH_OVER_HIPS = 1.15  # the ankles a little farther apart than the hips
# the share of a foot's length, from heel to tip of the toes, over which a quiet body stands
MIDDLE_OF_FOOT = 0.45
FULL_RISE_RAD = math.radians(20.0)  # from here on only ball and toes bear


class Footprints(NamedTuple):
    """Both feet in the world, left first."""

    ankle_m: np.ndarray  # (2, 3)
    foot_turned: np.ndarray  # (2, 4)
    toe_rad: np.ndarray  # (2,) toes bent up against the foot, so that they lie flat when the heel is up


def neutral_width_m(body) -> float:
    """Between the ankles of a neutral stance."""
    return WIDTH_OVER_HIPS * vector.distance(body.offset_m[HIPS[0]], body.offset_m[HIPS[1]])


def stand(
    body, *, width_m: float | None = None, place_m=(0.0, 0.0), heading_rad=0.0, toes_out_rad=TOES_OUT_RAD, ahead_m=0.0
) -> Footprints:
    """Feet flat on the ground, side by side about a place (2,). ahead_m: how far the left foot is ahead of the right
    one.
    """
    width_m = neutral_width_m(body) if width_m is None else width_m
    facing = quaternion.about_z(heading_rad)
    ankle_m, foot_turned = np.empty((2, 3)), np.empty((2, 4))
    for side, out in enumerate((1.0, -1.0)):
        x, y, _ = quaternion.rotate(facing, (0.5 * out * ahead_m, 0.5 * out * width_m, 0.0))
        ankle_m[side] = (place_m[0] + x, place_m[1] + y, footing.sole_depth_m(body, side))
        foot_turned[side] = footing.flat_orientation(heading_rad + out * toes_out_rad)
    return Footprints(ankle_m, foot_turned, np.zeros(2))


def raised(body, feet: Footprints, rise_rad) -> Footprints:
    """The same feet with the heels up by an angle (one number or left, right): toes and balls stay where they are."""
    if not np.any(rise_rad):
        return feet
    return Footprints(*_raised(body, *feet, np.array(np.broadcast_to(np.asarray(rise_rad, float), (2,)))))


@njit(cache=True)
def _raised(body, ankle_m, foot_turned, toe_rad, rise_rad):
    ankle_m, foot_turned = ankle_m.copy(), foot_turned.copy()
    for side in range(2):
        toe = body.offset_m[TOES[side]]
        ball = vector.add(ankle_m[side], quaternion.rotate(foot_turned[side], toe))
        turned = quaternion.multiply(foot_turned[side], quaternion.about_y(rise_rad[side]))
        ankle = vector.subtract(ball, quaternion.rotate(turned, toe))
        foot_turned[side, 0], foot_turned[side, 1], foot_turned[side, 2], foot_turned[side, 3] = turned
        ankle_m[side, 0], ankle_m[side, 1], ankle_m[side, 2] = ankle
    return ankle_m, foot_turned, toe_rad + rise_rad


def middle_m(body, feet: Footprints, balance_x: float = 0.0, balance_z: float = 0.0) -> np.ndarray:
    """The place (2,) of the ground that a balance asks for. 0, 0: the middle of the stance.

    balance_x (the paper's X): +1 over the left foot, -1 over the right one. balance_z (the paper's Z): +1 as far
    ahead as half the foot is long, -1 as far back. Nothing forbids to go past the edge: precarious balance is wanted.
    """
    return _middle(body, *feet, float(balance_x), float(balance_z))


@njit(cache=True)
def _middle(body, ankle_m, foot_turned, toe_rad, balance_x, balance_z):
    place = np.zeros(2)
    for side in range(2):
        x, y = _middle_of_foot(body, side, ankle_m[side], foot_turned[side], toe_rad[side], balance_z)
        weight = 0.5 + (0.5 - side) * balance_x
        place[0] += weight * x
        place[1] += weight * y
    return place


@inner_kernel
def _middle_of_foot(body, side, ankle_m, foot_turned, toe_rad, balance_z):
    """The place (x, y) of one foot over which a balance of 0, moved ahead by balance_z half feet, stands."""
    toe, sole = body.offset_m[TOES[side]], body.sole_m[side]
    heel, tip = sole[0, 0], toe[0] + sole[4, 0]
    flat = heel + MIDDLE_OF_FOOT * (tip - heel)
    t = min(max(toe_rad / FULL_RISE_RAD, 0.0), 1.0)
    on_toes = toe[0] + 0.3 * sole[4, 0]
    ahead = flat + t * t * (3.0 - 2.0 * t) * (on_toes - flat) + balance_z * 0.5 * (tip - heel)
    # measured from the ball, which is where it is whether the heel is up or down
    ball = vector.add(ankle_m, quaternion.rotate(foot_turned, toe))
    facing = quaternion.about_z(quaternion.heading(foot_turned))
    place = vector.add(ball, quaternion.rotate(facing, (ahead - toe[0], -toe[1], 0.0)))
    return place[0], place[1]
