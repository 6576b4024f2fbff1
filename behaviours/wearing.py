"""A stance under everything a character does: where the two sources meet (specification S9).

A character's stance (shape set and intensity: personality and mood) is worn under its clip: the stance's turns lie
under the clip's own at spine, neck, head, collars and pelvis, the pelvis sinks and shifts as the stance asks, and
both feet stay exactly where the clip has them, by leg IK. All that follows - startle, rules, bracing, recovery -
starts from that pose. How bold the character is colours what it makes of a threat: to the timid the same ball is
larger and faster.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from engine.body.footing import drop_to_reach, leg_length_m
from engine.body.kinematics import joints_into
from engine.body.limb_ik import apply_leg, leg_swivel
from engine.body.limits import clamp_keeping
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, PELVIS, Body, Pose
from engine.maths import quaternion
from engine.maths.kernel import njit

if TYPE_CHECKING:
    from behaviours.stance.shape import Shape


MOST_SOFTNESS_M = 0.05


class Worn(NamedTuple):
    """What a stance puts under a pose; numbers only, so that kernels take it whole."""

    turns: np.ndarray  # (J, 4) local, after the clip's own
    drop_m: float  # how much lower the pelvis is
    ahead_m: float  # and how far it is shifted, in the pelvis's heading
    left_m: float


def worn_by(body: Body, name: str, intensity: float) -> Worn:
    """What a set of `behaviours.stance` at an intensity puts under this body. BadInput lists the sets."""
    from behaviours.stance.around import Around
    from behaviours.stance.shape_sets import shape_of

    return worn_shape(body, shape_of(name, intensity, Around()))


def worn_shape(body: Body, shape: Shape) -> Worn:
    """What a shape of one's own puts under this body."""
    from behaviours.stance.offsets import offsets_of

    offsets = offsets_of(body, shape)
    ahead_m, left_m = offsets.pelvis_shift_m
    return Worn(np.ascontiguousarray(offsets.rotations), offsets.pelvis_drop_m, float(ahead_m), float(left_m))


def worn_pose(body: Body, pose: Pose, worn: Worn) -> Pose:
    """A pose with a stance under it, the feet as they were. A copy."""
    root_m, rotations = np.array(pose.root_m, float), np.array(pose.rotations, float)
    wear(body, root_m, rotations, worn)
    return Pose(root_m, rotations)


@njit(cache=True)
def wear(body, root_m, rotations, worn):
    """Puts the stance under a pose, in place: root_m (3,), rotations (J, 4)."""
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    ankles_m = positions[np.array(ANKLES)]
    feet = orientations[np.array(ANKLES)]
    swivels = (leg_swivel(positions, orientations, 0), leg_swivel(positions, orientations, 1))
    own_drops = (
        drop_to_reach(body, positions[HIPS[0]], ankles_m[0], 0),
        drop_to_reach(body, positions[HIPS[1]], ankles_m[1], 1),
    )
    yaw = quaternion.heading(rotations[PELVIS])
    for j in range(JOINT_COUNT):
        q = quaternion.multiply(rotations[j], worn.turns[j])
        if j != PELVIS:
            q = clamp_keeping(body.limit_low_rad[j], body.limit_high_rad[j], rotations[j], q)
        rotations[j, 0], rotations[j, 1], rotations[j, 2], rotations[j, 3] = q
    root_m[0] += math.cos(yaw) * worn.ahead_m - math.sin(yaw) * worn.left_m
    root_m[1] += math.sin(yaw) * worn.ahead_m + math.cos(yaw) * worn.left_m
    root_m[2] -= worn.drop_m
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    # a pelvis that shifts or turns may leave a foot behind: it sinks by what that costs beyond the clip's own stretch
    drop, width_m = 0.0, _softness_m(worn)
    for side in range(2):
        needed = drop_to_reach(body, positions[HIPS[side]], ankles_m[side], side) - own_drops[side]
        needed = max(needed, _least_drop(body, positions[HIPS[side]], ankles_m[side], side))
        drop = _soft_max(drop, needed, width_m)
    root_m[2] -= drop
    for j in range(JOINT_COUNT):
        positions[j, 2] -= drop
    for side in range(2):
        apply_leg(body, rotations, positions, orientations, side, ankles_m[side], feet[side], swivels[side], 0.0)


@njit(cache=True)
def _softness_m(worn):
    """Over how many metres a pelvis begins to sink: with the stance's own shift, so that nothing is worn at none."""
    shift = math.sqrt(worn.drop_m * worn.drop_m + worn.ahead_m * worn.ahead_m + worn.left_m * worn.left_m)
    return min(0.5 * shift, MOST_SOFTNESS_M)


@njit(cache=True)
def _soft_max(a, b, width):
    """The larger of two, never less, its corner rounded over a width: a pelvis that sinks does not set out at once."""
    near = width - abs(a - b)
    return max(a, b) + (near * near / (4.0 * width) if near > 0.0 else 0.0)


@njit(cache=True)
def _least_drop(body, hip_m, ankle_m, side):
    """How far the hip has to sink for a straight leg to reach the ankle at all, metres; negative where it is nearer."""
    reach = leg_length_m(body, side)
    across2 = (hip_m[0] - ankle_m[0]) ** 2 + (hip_m[1] - ankle_m[1]) ** 2
    return hip_m[2] - ankle_m[2] - math.sqrt(max(reach * reach - across2, 0.0))


def as_felt(norm: float, boldness: float, share: float) -> float:
    """A threat's size or speed, 0 to 1, as a character of this boldness (-1 timid ... +1 bold) takes it: clamped to
    [0, 1].
    """
    return min(1.0, max(0.0, norm - share * boldness))
