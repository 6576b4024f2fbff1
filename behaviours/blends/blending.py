"""The transitional blend mechanism (thesis 4.3): from one still pose to another, balanced, feet held, hands on
straight lines.

First pass: a chain rooted at the primary support foot, that foot eased along a line, every rotation slerped. Second
pass (`behaviours.blends.second_pass`): the pelvis is moved until the COM is on the straight line between its two ends,
the feet held by leg IK, the neck on its line, the head's orientation slerped, the hands on their ways by arm IK.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.blends.second_pass import balance
from engine.body import limits
from engine.body.kinematics import centre_of_mass, joints_into
from engine.body.overlap import PAIRS, depths_at
from engine.body.skeleton import ANKLES, ELBOWS, JOINT_COUNT, KNEES, PELVIS, WRISTS
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


class BlendEnd(NamedTuple):
    """One still end of a blend, and what the passes read off it."""

    root_m: np.ndarray  # (3,)
    rotations: np.ndarray  # (J, 4)
    positions: np.ndarray  # (J, 3) world
    orientations: np.ndarray  # (J, 4) world
    com_m: tuple[float, float, float]
    depths_m: np.ndarray  # (P,) how deep arms are in the body, see `engine.body.overlap`


@njit(cache=True)
def blend_end(body, capsules, root_m, rotations):
    """A pose with its joints in the world and its COM."""
    positions = np.empty((JOINT_COUNT, 3))
    orientations = np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    depths = np.empty(len(PAIRS))
    depths_at(capsules, positions, orientations, depths)
    com_m = centre_of_mass(body, positions, orientations)
    return BlendEnd(root_m, rotations, positions, orientations, com_m, depths)


@njit(cache=True)
def primary_support(planted, ankles_m, com_m):
    """The planted foot nearest to the projected COM; of two lifted feet, the nearest of both. Side 0 or 1."""
    best, nearest = 0, np.inf
    for side in range(2):
        away = math.hypot(ankles_m[side][0] - com_m[0], ankles_m[side][1] - com_m[1])
        if not planted[side] and (planted[0] or planted[1]):
            continue
        if away < nearest:
            best, nearest = side, away
    return best


@inner_kernel
def mix_joint(joint, first, last, weight):
    """A joint between two rotations: slerped; elbow, wrist and knee component by component, as hinges want it."""
    if joint in ELBOWS or joint in WRISTS or joint in KNEES:
        return limits.mix(first, last, weight)
    return quaternion.slerp(first, last, weight)


@inner_kernel
def slerp_from_support(body, start, end, weight, support, root_m, rotations, positions, orientations):
    """First pass: every joint slerped, and the pelvis placed so that the support foot goes straight from end to end."""
    for j in range(JOINT_COUNT):
        quaternion.put(rotations, j, mix_joint(j, start.rotations[j], end.rotations[j], weight))
    for k in range(3):
        root_m[k] = 0.0
    quaternion.put(rotations, PELVIS, quaternion.IDENTITY)
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    ankle = ANKLES[support]
    foot_turned = quaternion.slerp(start.orientations[ankle], end.orientations[ankle], weight)
    foot_m = vector.mix(start.positions[ankle], end.positions[ankle], weight)
    pelvis_turned = quaternion.normalise(quaternion.multiply(foot_turned, quaternion.conjugate(orientations[ankle])))
    pelvis_m = vector.subtract(foot_m, quaternion.rotate(pelvis_turned, positions[ankle]))
    for k in range(3):
        root_m[k] = pelvis_m[k]
    quaternion.put(rotations, PELVIS, pelvis_turned)
    joints_into(body.offset_m, root_m, rotations, positions, orientations)


@njit(cache=True)
def blend_into(body, start, end, weight, support, goals, ways, knees, root_m, rotations):
    """The pose a weight (already eased, 0 to 1, a little more where it overshoots) of the way from one end to the
    other. Writes root_m (3,) and rotations (J, 4).

    Returns how far its joints' limits keep either hand off its way, metres.
    """
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    slerp_from_support(body, start, end, weight, support, root_m, rotations, positions, orientations)
    return balance(body, start, end, weight, goals, ways, knees, root_m, rotations, positions, orientations)
