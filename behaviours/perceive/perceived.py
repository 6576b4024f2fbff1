"""A threat as the character perceives it: all that the rules know of it, and what it is aimed at."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body.capsules import CAPSULES, body_capsules
from engine.body.skeleton import BACK, HEAD, JOINTS, NECK, PELVIS, Body, joint_index
from engine.maths import quaternion, vector
from engine.maths.kernel import njit

# what a threat can be aimed at by name: three places of the body, then every joint
AIMS = ("head", "torso", *(name for name in JOINTS if name != "head"))
NO_JOINT = -1


class PerceivedThreat(NamedTuple):
    """World metres and unit vectors; plain numbers only, so that kernels take it whole."""

    direction: tuple[float, float, float]  # D: travel from where it is perceived to its target (lean, turn)
    tangent: tuple[float, float, float]  # of its path at contact (block)
    line_point_m: tuple[float, float, float]  # the line of approach at contact passes through here
    target_joint: int  # what it is aimed at: a joint and a point in that joint's frame,
    target_offset_m: tuple[float, float, float]  # or NO_JOINT and a point in the world
    speed_norm: float = 0.5  # 0 ... 1, as the rules see speed
    size_norm: float = 0.5  # 0 ... 1, as the rules see size
    excess_radius_m: float = 0.0  # how much larger than a volleyball it is
    head_weight: float = 1.0  # eq. 3.4: how much of the defence is the head's
    pelvis_weight: float = 0.0  # and the pelvis's


def head_centre_m(body: Body) -> tuple[float, float, float]:
    """The middle of the head's capsule, in the head's frame."""
    capsules, head = body_capsules(body), CAPSULES.index("head")
    x, y, z = 0.5 * (capsules.start_m[head] + capsules.end_m[head])
    return (float(x), float(y), float(z))


def aim_of(body: Body, name: str) -> tuple[int, tuple[float, float, float]]:
    """(joint, point in its frame, metres) of a target by name: head, torso, pelvis, a joint. ValueError lists them."""
    if name == "head":
        return HEAD, head_centre_m(body)
    if name == "torso":
        # the middle of the rib cage, half way from the back's joint to the neck's
        x, y, z = 0.5 * body.offset_m[NECK]
        return BACK, (float(x), float(y), float(z))
    if name not in AIMS:
        raise ValueError(f"unknown target {name!r}; the targets are {', '.join(AIMS)}")
    return joint_index(name), (0.0, 0.0, 0.0)


@njit(cache=True)
def target_centre(joint, offset_m, positions, orientations):
    """Where the target is in a pose (J, 3), (J, 4): world metres."""
    if joint < 0:
        return (offset_m[0] * 1.0, offset_m[1] * 1.0, offset_m[2] * 1.0)
    return vector.add(vector.at(positions, joint), quaternion.rotate(quaternion.at(orientations, joint), offset_m))


def target_weights(body: Body, target_m, positions: np.ndarray, orientations: np.ndarray) -> tuple[float, float]:
    """Hermens 2006, eq. 3.4: how much of the defence is the head's, and the pelvis's; they sum to 1.

    By the distances of the target point from head and pelvis in a pose (J, 3), (J, 4).
    """
    head_m = vector.distance(target_m, target_centre(HEAD, head_centre_m(body), positions, orientations))
    pelvis_m = vector.distance(target_m, positions[PELVIS])
    total_m = head_m + pelvis_m
    if total_m < 1e-9:
        return 1.0, 0.0
    return (total_m - head_m) / total_m, (total_m - pelvis_m) / total_m
