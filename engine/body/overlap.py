"""What of a body is inside itself: hands and forearms in head, neck or trunk, or in those of the other side."""

from __future__ import annotations

import numpy as np

from engine.body.capsules import CAPSULES, Capsules, body_capsules, capsules_at
from engine.body.kinematics import joints_of
from engine.body.skeleton import Body, Pose
from engine.maths import vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.maths.shapes import boxes_apart, nearest_between

TRUNK = ("pelvis", "belly", "chest", "upper_chest", "neck", "head")
ARMS = tuple((f"{side}_forearm", f"{side}_hand") for side in ("left", "right"))
# every hand and forearm against trunk and head, then against both of the other side
PAIRS = np.array(
    [(CAPSULES.index(arm), CAPSULES.index(trunk)) for arms in ARMS for arm in arms for trunk in TRUNK]
    + [(CAPSULES.index(left), CAPSULES.index(right)) for left in ARMS[0] for right in ARMS[1]]
)

# of every capsule: which side's arm it belongs to (-1: no arm), and whether it is the hand
ARM_CAPSULES = np.array(
    [
        next(((side, part) for side in range(2) for part in range(2) if ARMS[side][part] == name), (-1, 0))
        for name in CAPSULES
    ]
)


@inner_kernel
def depths_at(capsules, positions, orientations, out):
    """How deep each of PAIRS lies in each other in one pose, metres, negative when apart. Writes (P,)."""
    depths_into(capsules_at(capsules, positions, orientations), capsules.radius_m, PAIRS, out)


@njit(cache=True)
def depths_into(ends, radius_m, pairs, out):
    """How deep the capsules of each pair (P, 2) lie in each other, metres; negative when apart. ends (C, 2, 3)."""
    for n in range(len(pairs)):
        a, b = pairs[n]
        s, t = nearest_between(ends[a, 0], ends[a, 1], ends[b, 0], ends[b, 1])
        apart = vector.distance(vector.mix(ends[a, 0], ends[a, 1], s), vector.mix(ends[b, 0], ends[b, 1], t))
        out[n] = radius_m[a] + radius_m[b] - apart


@inner_kernel
def too_deep_into(radius_m, side, k, own_m, other_m, allowed_m, out, first):
    """How much deeper than allowed (K, P) each of PAIRS is at moment k, metres; 0 where a side's arm has no part in it.
    Writes (P,), from `first` on.

    Both ends of all capsules (K, C, 2, 3): own_m has this side's arm and the trunk, other_m the other arm. All pairs in
    one call: to hand these arrays on costs more than a pair does.
    """
    for n in range(len(PAIRS)):
        out[first + n] = 0.0
        a, b = PAIRS[n, 0], PAIRS[n, 1]
        if ARM_CAPSULES[a, 0] != side and ARM_CAPSULES[b, 0] != side:
            continue
        p, q = segment(own_m, k, a), segment(own_m, k, b)
        if ARM_CAPSULES[a, 0] == 1 - side:
            p = segment(other_m, k, a)
        if ARM_CAPSULES[b, 0] == 1 - side:
            q = segment(other_m, k, b)
        if boxes_apart(p[0], p[1], q[0], q[1], radius_m[a] + radius_m[b] - allowed_m[k, n]):
            continue
        s, t = nearest_between(p[0], p[1], q[0], q[1])
        apart = vector.distance(vector.mix(p[0], p[1], s), vector.mix(q[0], q[1], t))
        out[first + n] = max(0.0, radius_m[a] + radius_m[b] - apart - allowed_m[k, n])


@inner_kernel
def segment(ends_m, k, c):
    """Both ends of a capsule out of (K, C, 2, 3), as tuples: views would cost more than what is done with them."""
    return (
        (ends_m[k, c, 0, 0], ends_m[k, c, 0, 1], ends_m[k, c, 0, 2]),
        (ends_m[k, c, 1, 0], ends_m[k, c, 1, 1], ends_m[k, c, 1, 2]),
    )


def overlaps_m(body: Body, poses: Pose) -> np.ndarray:
    """(T, P) depth of each of PAIRS in each of T poses, metres; negative when apart."""
    capsules: Capsules = body_capsules(body)
    out = np.empty((len(poses.root_m), len(PAIRS)))
    for k in range(len(out)):
        pose = Pose(np.ascontiguousarray(poses.root_m[k]), np.ascontiguousarray(poses.rotations[k]))
        depths_into(capsules_at(capsules, *joints_of(body, pose)), capsules.radius_m, PAIRS, out[k])
    return out


def pair_name(row: int) -> str:
    """The words for one of PAIRS."""
    return " in ".join(CAPSULES[c] for c in PAIRS[row])
