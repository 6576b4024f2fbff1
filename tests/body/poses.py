"""Poses that the body's tests start from: like people, not like quaternions drawn from a hat."""

from __future__ import annotations

import numpy as np

from engine.body import kinematics
from engine.body.limits import from_components
from engine.body.skeleton import ELBOWS, JOINT_COUNT, KNEES, MIRRORED, Pose


def identity_pose(height_m: float = 1.0) -> Pose:
    return Pose(np.array([0.0, 0.0, height_m]), np.tile([1.0, 0.0, 0.0, 0.0], (JOINT_COUNT, 1)))


def random_pose(rng: np.random.Generator, spread: float = 0.6) -> Pose:
    """A bent and twisted pose, elbows and knees perfect hinges, forearms twisted; anywhere, facing any way."""
    rotations = np.array([from_components(*(spread * rng.uniform(-1, 1, 3))) for _ in range(JOINT_COUNT)])
    for side in range(2):
        rotations[ELBOWS[side]] = from_components(0.0, -rng.uniform(0.0, 2.4), spread * rng.uniform(-1, 1))
        rotations[KNEES[side]] = from_components(0.0, rng.uniform(0.0, 2.2), 0.0)
    rotations[0] = from_components(*(0.3 * rng.uniform(-1, 1, 2)), rng.uniform(-3, 3))
    return Pose(rng.uniform(-1, 1, 3) + [0, 0, 1], rotations)


def mirrored(pose: Pose) -> Pose:
    """The pose in a mirror that stands in the X-Z plane: turns about X and Z reverse, left and right change places."""
    return Pose(pose.root_m * [1, -1, 1], pose.rotations[MIRRORED] * [1, -1, 1, -1])


def unpacked(body, pose: Pose):
    """(rotations, positions, orientations), fresh arrays that a kernel may write in."""
    positions, orientations = kinematics.joints_of(body, pose)
    return pose.rotations.copy(), positions, orientations
