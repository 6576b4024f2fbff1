"""A startle pose that its owner can be in: on the feet that stand, within the legs' limits, no arm in the body.

The reflex (thesis 3.2.6) is laid on the pose of the clip a moment ahead. A planted foot stays behind the pelvis there,
and the recoil takes the hands of arms that hang into the hips. Both are then done by a smaller share.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from engine.body import support
from engine.body.kinematics import joints_of
from engine.body.limb_ik import KEEP, apply_leg
from engine.body.limits import excess_rad
from engine.body.overlap import overlaps_m
from engine.body.skeleton import ANKLES, CLAVICLES, ELBOWS, HIPS, JOINT_COUNT, PELVIS, SHOULDERS, WRISTS, Body, Pose
from engine.maths import quaternion

SHARES = np.linspace(1.0, 0.0, 6)
TOLERATED_RAD, TOLERATED_M = 0.005, 0.002
BELOW = (PELVIS, *range(HIPS[0], JOINT_COUNT))  # pelvis and legs
ARMS = (*CLAVICLES, *SHOULDERS, *ELBOWS, *WRISTS)


def within_reach(body: Body, now: Pose, ahead: Pose, startled: Pose, stand: Callable[[Pose], Pose]) -> Pose:
    """The startle pose, stood on the feet by `stand`: the largest share of its recoil at which no arm goes deeper into
    the body than now or in the clip ahead, and of its pelvis's way at which the legs go no farther beyond their limits.

    The pelvis turns, and the legs begin, by the same share from how they are now: where nothing of it can be stood in,
    the feet stay under a pelvis that neither moves nor turns.
    """
    own = np.maximum(excess_rad(body, now.rotations), excess_rad(body, ahead.rotations))[HIPS[0] :]
    pose = clear_of_body(body, now, ahead, startled)
    for share in SHARES:
        part = Pose(now.root_m + share * (pose.root_m - now.root_m), pose.rotations.copy())
        for joint in BELOW:
            part.rotations[joint] = quaternion.slerp(now.rotations[joint], pose.rotations[joint], share)
        stood = stand(part)
        if (excess_rad(body, stood.rotations)[HIPS[0] :] - own).max() < TOLERATED_RAD:
            break
    return stood


def lift_out_of_floor(body: Body, pose: Pose, swings) -> Pose:
    """The pose with the feet that swing (2,) no lower than the floor: a pelvis that stays behind, or has sunk for the
    other foot, would put them under it.
    """
    positions, orientations = joints_of(body, pose)
    rotations = pose.rotations.copy()
    for side in range(2):
        under_m = -float(support.sole_points(body, positions, orientations)[side, :, 2].min())
        if swings[side] and under_m > 0.0:
            ankle = positions[ANKLES[side]] + [0.0, 0.0, under_m]
            turned = orientations[ANKLES[side]].copy()
            apply_leg(body, rotations, positions, orientations, side, ankle, turned, KEEP)
    return Pose(pose.root_m, rotations)


def clear_of_body(body: Body, now: Pose, ahead: Pose, startled: Pose) -> Pose:
    """The startle pose, its arms recoiled from those of the clip ahead only so far as is free."""
    own = np.maximum(overlaps_m(body, _one(now)), overlaps_m(body, _one(ahead))).max(axis=0)
    for share in SHARES:
        pose = Pose(startled.root_m.copy(), startled.rotations.copy())
        for joint in ARMS:
            pose.rotations[joint] = quaternion.slerp(ahead.rotations[joint], startled.rotations[joint], share)
        if (overlaps_m(body, _one(pose))[0] - np.maximum(own, 0.0)).max() < TOLERATED_M:
            break
    return pose


def _one(pose: Pose) -> Pose:
    """With a leading axis of one."""
    return Pose(pose.root_m[np.newaxis], pose.rotations[np.newaxis])
