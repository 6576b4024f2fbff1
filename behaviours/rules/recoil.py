"""Recoil (Hermens 2006, 3.2.4, fig. 3.5): the head is buried in the shoulders, the arms drawn to the chest."""

from __future__ import annotations

from engine.body.skeleton import CLAVICLES, ELBOWS, LEFT, SHOULDERS
from engine.maths import quaternion
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


@inner_kernel
def _turn_joint(rotations, joint, turn):
    quaternion.put(rotations, joint, quaternion.multiply(quaternion.at(rotations, joint), turn))


@njit(cache=True)
def raise_clavicle(rotations, side, recoil, maxima):
    """Lifts one shoulder and brings it forward, in place: raised about X first, then swung about Y as it stood before.

    In this order only does the Y angle move the shoulder: about the raised bone it would merely spin it.
    """
    outward = 1.0 if side == LEFT else -1.0
    lift = quaternion.about_x(outward * maxima.clavicle_rad[0] * recoil)
    swing = quaternion.about_y(maxima.clavicle_rad[1] * recoil)
    _turn_joint(rotations, CLAVICLES[side], quaternion.multiply(swing, lift))


@njit(cache=True)
def retract_arm(rotations, side, recoil, maxima):
    """Draws one arm in before the chest, in place; block overrides this part of the rule."""
    outward = 1.0 if side == LEFT else -1.0
    _turn_joint(rotations, SHOULDERS[side], quaternion.about_x(outward * maxima.shoulder_rad[0] * recoil))
    # the elbow flexes by negative Y: hand forward and up
    _turn_joint(rotations, ELBOWS[side], quaternion.about_y(-maxima.elbow_rad[1] * recoil))
