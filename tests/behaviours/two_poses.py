"""Blends for tests: two still poses, and what lies between them."""

from __future__ import annotations

import numpy as np
from numba import njit

from behaviours.blends.arm_ways import straight_ways
from behaviours.blends.blending import blend_end, blend_into
from behaviours.blends.held_feet import FootGoals, knees_between
from engine.body.capsules import body_capsules
from engine.body.kinematics import joints_of
from engine.body.limits import from_components
from engine.body.skeleton import ANKLES, ELBOWS, JOINT_COUNT, KNEES, SHOULDERS, TOES, Body, Pose
from tests.behaviours.people import BODY, standing

SHAPE = body_capsules(BODY)
components_to_rotation = njit(lambda x, y, z: from_components(x, y, z))


def with_arm(pose: Pose, side: int, shoulder_deg, elbow_deg: float, forearm_deg: float = 0.0) -> Pose:
    """The pose with one arm put otherwise: a shoulder's components and an elbow's flexion, degrees, as on the left."""
    sign = 1.0 - 2.0 * side
    rotations = pose.rotations.copy()
    x, y, z = np.radians(shoulder_deg)
    rotations[SHOULDERS[side]] = components_to_rotation(sign * x, y, sign * z)
    rotations[ELBOWS[side]] = components_to_rotation(0.0, -np.radians(elbow_deg), sign * np.radians(forearm_deg))
    return Pose(pose.root_m.copy(), rotations)


def end_of(pose: Pose, body: Body = BODY):
    """A pose as the end of a blend."""
    return blend_end(body, SHAPE if body is BODY else body_capsules(body), pose.root_m.copy(), pose.rotations.copy())


def held(pose: Pose, body: Body = BODY) -> FootGoals:
    """Both feet held where a pose has them."""
    at, turned = joints_of(body, pose)
    toes = pose.rotations[list(TOES)].copy()
    return FootGoals(at[list(ANKLES)], turned[list(ANKLES)], toes, np.ones(2, bool), np.ones(2))


def between(first: Pose, last: Pose, weight: float, ways=None, goals: FootGoals | None = None, support=0) -> Pose:
    """The pose a weight of the way from one to the other, on the first one's feet, rooted at the left one."""
    start, end = end_of(first), end_of(last)
    knees = knees_between(start, end, False, start.positions[list(KNEES)])
    root_m, rotations = np.empty(3), np.empty((JOINT_COUNT, 4))
    ways = straight_ways() if ways is None else ways
    blend_into(BODY, start, end, weight, support, goals or held(first), ways, knees, root_m, rotations)
    return Pose(root_m, rotations)


def at_ease() -> Pose:
    """Standing, the arms a little away from the body, which those of the identity pose touch."""
    return with_arm(with_arm(standing(), 0, (20.0, 0.0, 0.0), 20.0), 1, (20.0, 0.0, 0.0), 20.0)


def on_guard() -> Pose:
    """Standing with both hands before the face."""
    return with_arm(with_arm(standing(), 0, (20.0, -55.0, 0.0), 100.0), 1, (20.0, -55.0, 0.0), 100.0)
