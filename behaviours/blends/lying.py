"""Blending between two poses that lie on the floor: nothing stands, so nothing has to be balanced or held."""

from __future__ import annotations

import numpy as np

from behaviours.blends.arm_ways import follow_way
from behaviours.blends.blending import mix_joint
from engine.body.footing import lowest_m
from engine.body.kinematics import joints_into
from engine.body.skeleton import JOINT_COUNT
from engine.maths import quaternion
from engine.maths.kernel import njit


@njit(cache=True)
def blend_lying(body, start, end, weight, ways, root_m, rotations):
    """Every rotation slerped, a knee's as it turns, but the arms', which go their ways, the root on a straight line, on
    the floor: what is lowest goes evenly from the one height to the other.

    `start`, `end`: BlendEnds; ways: HandWays. Writes root_m (3,) and rotations (J, 4).
    """
    for j in range(JOINT_COUNT):
        quaternion.put(rotations, j, mix_joint(j, start.rotations[j], end.rotations[j], weight))
    for k in range(3):
        root_m[k] = start.root_m[k] + weight * (end.root_m[k] - start.root_m[k])
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    for side in range(2):
        follow_way(body, start, end, weight, side, ways, rotations, positions, orientations)
    first_m = lowest_m(body, start.positions, start.orientations)
    last_m = lowest_m(body, end.positions, end.orientations)
    root_m[2] += first_m + weight * (last_m - first_m) - lowest_m(body, positions, orientations)
