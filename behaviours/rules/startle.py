"""Startle (Hermens 2006, 3.2.6): the reflex before the considered defence. A fifth of a full recoil, both sides
alike.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from behaviours.rules.recoil import raise_clavicle, retract_arm
from behaviours.settings import Settings
from engine.body.kinematics import joints_of
from engine.body.limits import clamp_keeping
from engine.body.skeleton import CLAVICLES, ELBOWS, HEAD, NECK, SHOULDERS, Body, Pose
from engine.maths import quaternion


def recoiled(rotations: np.ndarray, settings: Settings) -> np.ndarray:
    """The full recoil of table 3.2, lower half, arms too, on a pose's rotations (J, 4); a copy."""
    out = np.array(rotations, float)
    for side in range(2):
        raise_clavicle(out, side, 1.0, settings.recoil)
        retract_arm(out, side, 1.0, settings.recoil)
    return out


@njit(cache=True)
def turn_towards(head_orientation, toward, share):
    """The yaw, radians, that turns the face a share of the way to a threat; `toward` is the direction to it, world."""
    if toward[0] * toward[0] + toward[1] * toward[1] < 1e-9:
        return 0.0
    way = math.atan2(toward[1], toward[0]) - quaternion.heading(head_orientation)
    return share * ((way + math.pi) % (2.0 * math.pi) - math.pi)


def startle_pose(body: Body, pose_ahead: Pose, toward, settings: Settings) -> Pose:
    """The startle pose: the clip 1/12 s ahead, mixed with its own full recoil, the head turned some of the way to the
    threat.

    toward (3,): unit vector to the threat, world. The turn is shared by neck and head, within their limits. No balance.
    """
    s = settings.startle
    full = recoiled(pose_ahead.rotations, settings)
    rotations = np.array(pose_ahead.rotations, float)
    for joint in CLAVICLES + SHOULDERS + ELBOWS:
        rotations[joint] = quaternion.slerp(pose_ahead.rotations[joint], full[joint], s.recoil_weight)
    _, orientations = joints_of(body, Pose(pose_ahead.root_m, rotations))
    yaw = turn_towards(orientations[HEAD], (float(toward[0]), float(toward[1])), s.head_turn_share)
    for joint in (NECK, HEAD):
        up = quaternion.unrotate(orientations[joint], (0.0, 0.0, 1.0))
        turned = quaternion.multiply(rotations[joint], quaternion.from_axis_angle(up, 0.5 * yaw))
        rotations[joint] = clamp_keeping(
            body.limit_low_rad[joint], body.limit_high_rad[joint], pose_ahead.rotations[joint], turned
        )
    for joint in CLAVICLES + SHOULDERS + ELBOWS:
        rotations[joint] = clamp_keeping(
            body.limit_low_rad[joint], body.limit_high_rad[joint], pose_ahead.rotations[joint], rotations[joint]
        )
    return Pose(np.array(pose_ahead.root_m, float), rotations)
