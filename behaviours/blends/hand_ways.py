"""Which way each hand goes in a blend: the thesis's straight line (4.3), unless that is no way for an arm.

Straight hand lines pass through torso or head in half the cases (specification A7), and past the shoulder along ways
that no shoulder follows. Once for a blend, before it begins, each arm is tried along its whole way: straight first,
then with its elbow led otherwise; failing that it is swung, as `behaviours.blends.swung_ways` finds best.
`behaviours.blends.arm_ways` then follows what was chosen. Which arm gives way to the other is a matter of their ways,
so left and right are treated alike.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.blends.arm_ways import INTERPOLATED, KNOT_PARTS, KNOTS, SLERPED, SWUNG, follow_way, overstep, yielding
from behaviours.blends.blending import BlendEnd
from behaviours.blends.swung_ways import bend_swung, put_capsules
from behaviours.timing import ease
from engine.body.kinematics import joints_of
from engine.body.overlap import ARM_CAPSULES, PAIRS, too_deep_into
from engine.body.skeleton import ELBOWS, PELVIS, SHOULDERS, WRISTS, Pose
from engine.maths import vector
from engine.maths.copying import copy_into
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

MOMENTS = 25  # at which a way is judged
APART_M = 0.010  # skins keep this far from each other, where they are so far at the ends
TOLERATED_M = 0.008  # a way is good if it comes this near to what it should not
TOLERATED_RAD = 0.028  # or would go so far beyond a limit, of which only what a limit gives is left
STRIDE_M = 1.6  # an elbow that at its fastest would go farther than this in a whole blend turns over
FAR_AWAY_M = 1e3
ROUNDS = 3


class Moments(NamedTuple):
    """A blend at a few moments, from its start to its end, K in all, C capsules, P pairs: the body without its arms."""

    weight: np.ndarray  # (K,) eased
    joints_m: np.ndarray  # (K, J, 3)
    turned: np.ndarray  # (K, J, 4)
    rotations: np.ndarray  # (K, J, 4)
    ends_m: np.ndarray  # (K, C, 2, 3) both ends of every capsule
    allowed_m: np.ndarray  # (K, P) how deep arms may be in the body


def moments_of(body, capsules, start: BlendEnd, end: BlendEnd, progress: np.ndarray, poses: list[Pose]) -> Moments:
    """A blend between two still ends at some moments (K,), shares of its time, in which it has these poses."""
    weight = np.array([ease(u) for u in progress])
    rotations = np.array([pose.rotations for pose in poses])
    joints_m, turned = joints_of(body, Pose(np.array([pose.root_m for pose in poses]), rotations))
    ends_m = np.empty((len(weight), len(ARM_CAPSULES), 2, 3))
    allowed_m = np.empty((len(weight), len(PAIRS)))
    for k in range(len(weight)):
        put_capsules(capsules, -1, joints_m[k], turned[k], ends_m, k)
        let_be(start.depths_m, end.depths_m, weight[k], allowed_m[k])
    return Moments(weight, joints_m, turned, rotations, ends_m, allowed_m)


@njit(cache=True)
def let_be(first_m, last_m, weight, out):
    """The depth that each pair may have: what the two ends have, or else a gap of APART_M. Writes (P,)."""
    for n in range(len(out)):
        a, b = max(first_m[n], -APART_M), max(last_m[n], -APART_M)
        out[n] = a + weight * (b - a)


@inner_kernel
def put_on_way(body, capsules, start, end, moments, side, ways, k):
    """Puts one arm where its way has it at moment k, in place."""
    rotations, joints_m, turned = moments.rotations[k], moments.joints_m[k], moments.turned[k]
    follow_way(body, start, end, moments.weight[k], side, ways, rotations, joints_m, turned)
    put_capsules(capsules, side, joints_m, turned, moments.ends_m, k)


@inner_kernel
def is_good(body, capsules, start, end, moments, side, ways, other_m):
    """Whether that is a way for an arm, beside the other's capsules (K, C, 2, 3). Puts the arm on it at every moment,
    in place, up to the first that is wrong.
    """
    shoulder, elbow, here, deep_m = SHOULDERS[side], ELBOWS[side], (0.0, 0.0, 0.0), np.empty(len(PAIRS))
    for k in range(len(moments.weight)):
        put_on_way(body, capsules, start, end, moments, side, ways, k)
        weight, joints_m = moments.weight[k], moments.joints_m[k]
        before, here = here, vector.subtract(vector.at(joints_m, elbow), vector.at(joints_m, PELVIS))
        stride_m = STRIDE_M * (weight - moments.weight[max(k - 1, 0)])
        if k > 0 and ways.modes[side] != SWUNG and vector.distance(here, before) >= stride_m:
            return False
        beyond = overstep(
            body, shoulder, start.rotations[shoulder], end.rotations[shoulder], weight, moments.rotations[k, shoulder]
        )[0]
        if max(abs(beyond[0]), abs(beyond[1]), abs(beyond[2])) >= yielding(TOLERATED_RAD):
            return False
        too_deep_into(capsules.radius_m, side, k, moments.ends_m, other_m, moments.allowed_m, deep_m, 0)
        for n in range(len(PAIRS)):
            if deep_m[n] >= TOLERATED_M:
                return False
    return True


@inner_kernel
def choose_way(body, capsules, start, end, moments, side, ways, other_m):
    """Chooses one arm's way, in place: the present one if that is good; else a straight one, if one is; else swung."""
    if is_good(body, capsules, start, end, moments, side, ways, other_m):
        return
    for knot in range(KNOTS):
        for part in range(KNOT_PARTS):
            ways.bends[side, knot, part] = 0.0
    for mode in (INTERPOLATED, SLERPED):
        ways.modes[side] = mode
        if is_good(body, capsules, start, end, moments, side, ways, other_m):
            return
    ways.modes[side] = SWUNG
    bend_swung(
        body, capsules, start, end, side, moments.weight, moments.joints_m, moments.turned, moments.ends_m, other_m,
        moments.allowed_m, ways.bends[side],
    )  # fmt: skip
    for k in range(len(moments.weight)):
        put_on_way(body, capsules, start, end, moments, side, ways, k)


@njit(cache=True)
def choose_ways(body, capsules, start, end, moments, ways):
    """Chooses both arms' ways, in place: each first as if the other were not there; then the one that has the shorter
    way goes round the other where they meet, and the other round it if they still do.
    """
    other_m = np.full(moments.ends_m.shape, FAR_AWAY_M)
    for side in range(2):
        choose_way(body, capsules, start, end, moments, side, ways, other_m)
    far_m = (
        vector.distance(vector.at(start.positions, WRISTS[0]), vector.at(end.positions, WRISTS[0])),
        vector.distance(vector.at(start.positions, WRISTS[1]), vector.at(end.positions, WRISTS[1])),
    )
    shorter = 0 if far_m[0] <= far_m[1] else 1
    for n in range(ROUNDS):
        copy_into(other_m.reshape(-1), moments.ends_m.reshape(-1))
        choose_way(body, capsules, start, end, moments, shorter if n % 2 == 0 else 1 - shorter, ways, other_m)
