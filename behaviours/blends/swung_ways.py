"""The way of an arm that is swung from joint to joint, bent by least squares (Levenberg 1944, Marquardt 1963) until
it is nowhere in the body, and its hand as near to a straight line as that allows.

Only the arm moves here, through a body that is given at every moment. `behaviours.blends.arm_ways` says what a bend is.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.blends.arm_ways import KNOT_PARTS, KNOTS, swing_elbow, swing_shoulder
from engine.body import limits
from engine.body.limb_ik import side_sign
from engine.body.overlap import ARM_CAPSULES, PAIRS, too_deep_into
from engine.body.skeleton import CLAVICLES, ELBOWS, SHOULDERS, WRISTS
from engine.maths import quaternion, vector
from engine.maths.copying import copy_into
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.maths.least_squares import bounded_step, normal_equations

BENDS = KNOTS * KNOT_PARTS
PARTS = 1 + len(PAIRS)  # of what may be wrong at a moment: the hand off its line, pairs too deep
# what counts as one in the sum of squares
DEPTH_SCALE_M, LINE_SCALE_M, BEND_SCALE_RAD = 0.003, 0.5, 1.5
MOST_BEND_RAD = 2.0
OFFSET_RAD = 1e-4
STEPS, MORE_STEPS, STARTS_TRIED = 3, 6, 4
GOOD_ENOUGH = 1.5  # a sum of squares: nothing too deep, and no other start is worth the time
DAMPING, LEAST_DAMPING, MOST_DAMPING = 1e-3, 1e-9, 1e4
WORTH = 0.02  # of the sum of squares: a step that gains less is the last

# both knots of the bends that the search begins with: radians
STARTS = np.array([
    (0.0, 0.0, 0.0, 0.0), (0.6, 0.0, 0.0, 0.0), (0.6, -0.6, 0.0, 0.0), (0.0, -0.8, 0.0, 0.0), (0.0, 0.6, 0.0, 0.0),
    (0.0, 0.0, 0.0, -0.8), (0.0, 0.0, 0.0, 0.8), (0.6, 0.0, 0.0, 0.8),
    # folded and raised first: so a hand gets up to a face that is bowed over the chest
    (0.0, -1.2, 0.0, -1.2), (0.6, -1.2, 0.6, -1.2),
])  # fmt: skip


class Arm(NamedTuple):
    """What one arm brings to every try, K moments of a blend; components as in `engine.body.limits`."""

    side: int
    weight: np.ndarray  # (K,)
    upper_rad: np.ndarray  # (2, 3) the shoulder's components at both ends
    lower_rad: np.ndarray  # (2, 3) the elbow's
    wrist: np.ndarray  # (K, 4) the wrist's rotation
    shoulder_m: np.ndarray  # (K, 3) world
    hangs_on: np.ndarray  # (K, 4) how the clavicle is turned in the world
    line_m: np.ndarray  # (K, 3) where the wrist would be on its straight line


@inner_kernel
def arm_of(start, end, side, weight, joints_m, turned):
    """One arm of a blend between two ends, its trunk given at K moments: (K, J, 3) and (K, J, 4)."""
    shoulder, elbow, wrist, count = SHOULDERS[side], ELBOWS[side], WRISTS[side], len(weight)
    upper, lower = np.empty((2, 3)), np.empty((2, 3))
    vector.put(upper, 0, limits.components(start.rotations[shoulder]))
    vector.put(upper, 1, limits.components(end.rotations[shoulder]))
    vector.put(lower, 0, limits.components(start.rotations[elbow]))
    vector.put(lower, 1, limits.components(end.rotations[elbow]))
    wrists, places, hangs, line = np.empty((count, 4)), np.empty((count, 3)), np.empty((count, 4)), np.empty((count, 3))
    first, last = vector.at(start.positions, wrist), vector.at(end.positions, wrist)
    for k in range(count):
        quaternion.put(wrists, k, limits.mix(start.rotations[wrist], end.rotations[wrist], weight[k]))
        quaternion.put(hangs, k, quaternion.at(turned[k], CLAVICLES[side]))
        vector.put(places, k, vector.at(joints_m[k], shoulder))
        vector.put(line, k, vector.mix(first, last, weight[k]))
    return Arm(side, weight, upper, lower, wrists, places, hangs, line)


@inner_kernel
def swing_into(body, capsules, arm, k, bends, ends_m):
    """An arm's capsules at a moment, into ends_m (K, C, 2, 3). Returns where its wrist is, world."""
    side = arm.side
    shoulder, elbow, wrist = SHOULDERS[side], ELBOWS[side], WRISTS[side]
    upper = swing_shoulder(
        body.limit_low_rad[shoulder], body.limit_high_rad[shoulder], vector.at(arm.upper_rad, 0),
        vector.at(arm.upper_rad, 1), arm.weight[k], side_sign(side), bends,
    )  # fmt: skip
    lower = swing_elbow(
        body.limit_low_rad[elbow], body.limit_high_rad[elbow], vector.at(arm.lower_rad, 0), vector.at(arm.lower_rad, 1),
        arm.weight[k], bends,
    )  # fmt: skip
    upper = quaternion.multiply(quaternion.at(arm.hangs_on, k), upper)
    elbow_m = vector.add(vector.at(arm.shoulder_m, k), quaternion.rotate(upper, vector.at(body.offset_m, elbow)))
    lower = quaternion.multiply(upper, lower)
    wrist_m = vector.add(elbow_m, quaternion.rotate(lower, vector.at(body.offset_m, wrist)))
    hand = quaternion.multiply(lower, quaternion.at(arm.wrist, k))
    for c in range(len(ARM_CAPSULES)):
        if ARM_CAPSULES[c, 0] == side:
            place, q = (wrist_m, hand) if ARM_CAPSULES[c, 1] == 1 else (elbow_m, lower)
            put_capsule(capsules, c, place, q, ends_m, k)
    return wrist_m


@inner_kernel
def put_capsule(capsules, c, place_m, turned, ends_m, k):
    """Both ends of one capsule in the world, into (K, C, 2, 3) at moment k."""
    first = vector.add(place_m, quaternion.rotate(turned, vector.at(capsules.start_m, c)))
    last = vector.add(place_m, quaternion.rotate(turned, vector.at(capsules.end_m, c)))
    for axis in range(3):
        ends_m[k, c, 0, axis], ends_m[k, c, 1, axis] = first[axis], last[axis]


@njit(cache=True)
def put_capsules(capsules, side, joints_m, turned, ends_m, k):
    """The capsules of a side's forearm and hand, or with side -1 all of a body's, into (K, C, 2, 3) at moment k."""
    for c in range(len(ARM_CAPSULES)):
        if side < 0 or ARM_CAPSULES[c, 0] == side:
            j = capsules.joint[c]
            put_capsule(capsules, c, vector.at(joints_m, j), quaternion.at(turned, j), ends_m, k)


@njit(cache=True)
def residuals_into(body, capsules, arm, bends, ends_m, other_m, allowed_m, out):
    """All that is wrong with a way, and how far it is bent: writes (R,), and the arm's capsules into ends_m. Returns
    the sum of squares.
    """
    count, total = 0, 0.0
    for k in range(1, len(arm.weight) - 1):
        wrist_m = swing_into(body, capsules, arm, k, bends, ends_m)
        out[count] = vector.distance(wrist_m, vector.at(arm.line_m, k)) / LINE_SCALE_M
        too_deep_into(capsules.radius_m, arm.side, k, ends_m, other_m, allowed_m, out, count + 1)
        for n in range(len(PAIRS)):
            out[count + 1 + n] /= DEPTH_SCALE_M
        count += PARTS
    for n in range(BENDS):
        out[count + n] = bends[n // KNOT_PARTS, n % KNOT_PARTS] / BEND_SCALE_RAD
    for value in out:
        total += value * value
    return total


@njit(cache=True)
def descend(body, capsules, arm, steps, bends, ends_m, other_m, allowed_m, residuals):
    """Bends a way, in place, for so many steps or until that is worth no more. Returns the sum of squares left."""
    knots, was = bends.reshape(BENDS), np.empty(BENDS)
    low, high = np.full(BENDS, -MOST_BEND_RAD), np.full(BENDS, MOST_BEND_RAD)
    ahead, jacobian = np.empty(len(residuals)), np.empty((len(residuals), BENDS))
    matrix, slope, step = np.empty((BENDS, BENDS)), np.empty(BENDS), np.empty(BENDS)
    least, damping = residuals_into(body, capsules, arm, bends, ends_m, other_m, allowed_m, residuals), DAMPING
    for _ in range(steps):
        for n in range(BENDS):
            knots[n] += OFFSET_RAD
            residuals_into(body, capsules, arm, bends, ends_m, other_m, allowed_m, ahead)
            knots[n] -= OFFSET_RAD
            for i in range(len(ahead)):
                jacobian[i, n] = (ahead[i] - residuals[i]) / OFFSET_RAD
        normal_equations(jacobian, residuals, matrix, slope)
        before = least
        copy_into(was, knots)
        while damping < MOST_DAMPING:
            bounded_step(matrix, slope, was, low, high, damping, step)
            for n in range(BENDS):
                knots[n] = was[n] + step[n]
            value = residuals_into(body, capsules, arm, bends, ends_m, other_m, allowed_m, ahead)
            if value < least:
                least, damping = value, max(damping * 0.1, LEAST_DAMPING)
                copy_into(residuals, ahead)
                break
            copy_into(knots, was)
            damping *= 10.0
        if least > (1.0 - WORTH) * before:
            break
    return least


@inner_kernel
def bend_swung(body, capsules, start, end, side, weight, joints_m, turned, ends_m, other_m, allowed_m, bends):
    """Writes the best bends (KNOTS, KNOT_PARTS) for one arm: a few steps from the best of STARTS, then more from where
    they led farthest.

    ends_m, other_m (K, C, 2, 3): the body's capsules, and the other arm's; allowed_m (K, P).
    """
    arm = arm_of(start, end, side, weight, joints_m, turned)
    residuals, values = np.empty((len(weight) - 2) * PARTS + BENDS), np.empty(len(STARTS))
    for n in range(len(STARTS)):
        begin(bends, n)
        values[n] = residuals_into(body, capsules, arm, bends, ends_m, other_m, allowed_m, residuals)
    least, knots, best = np.inf, bends.reshape(BENDS), np.zeros(BENDS)
    for _ in range(STARTS_TRIED):
        n = int(np.argmin(values))
        values[n] = np.inf
        begin(bends, n)
        value = descend(body, capsules, arm, STEPS, bends, ends_m, other_m, allowed_m, residuals)
        if value < least:
            least = value
            copy_into(best, knots)
        if least < GOOD_ENOUGH:
            break
    copy_into(knots, best)
    descend(body, capsules, arm, MORE_STEPS, bends, ends_m, other_m, allowed_m, residuals)


@inner_kernel
def begin(bends, n):
    """Writes one of STARTS into both knots."""
    for part in range(KNOT_PARTS):
        bends[0, part] = bends[1, part] = STARTS[n, part]
