"""Putting poses somewhere: a turn about the vertical and a shift on the ground, for a whole pose at once."""

from __future__ import annotations

import numpy as np

from engine.body.skeleton import PELVIS, Pose
from engine.maths import quaternion


def placed(pose: Pose, place_m, heading_rad: float, about_m=(0.0, 0.0)) -> Pose:
    """The pose turned by a heading about a point of the ground, then shifted on the ground. Metres (2,), radians."""
    turn = quaternion.about_z(heading_rad)
    x, y, z = quaternion.rotate(turn, (pose.root_m[0] - about_m[0], pose.root_m[1] - about_m[1], pose.root_m[2]))
    rotations = np.array(pose.rotations)
    rotations[PELVIS] = quaternion.multiply(turn, rotations[PELVIS])
    return Pose(np.array([x + about_m[0] + place_m[0], y + about_m[1] + place_m[1], z]), rotations)
