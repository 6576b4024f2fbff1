"""Arms kept out of the way of the body while they blend: hands and forearms out of head and trunk and each other.

A straight line between two good places for a hand often leads through the head or the chest. The arm is then pushed
out by as much as it would be too deep, and no more: what the two ends of the blend have themselves is let be, so a
blend still begins and ends exactly where it should. All constraints push at once, from one state, so that left and
right are treated alike.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from behaviours.overlap import ARM_CAPSULES, PAIRS
from engine.body.capsules import capsules_at
from engine.body.limb_ik import CARRIED, KEEP, apply_arm, arm_swivel
from engine.body.limits import components
from engine.body.skeleton import ELBOWS, SHOULDERS, WRISTS
from engine.maths import vector
from engine.maths.shapes import nearest_between

APART_M = 0.010  # skins that come nearer than this begin to give way
YIELD_M = 0.008  # and let each other at most this much nearer than that
LEVER_M = 0.15  # an elbow that far off the line shoulder - wrist moves as readily as the wrist
PUSHES = 12
EAGERNESS = 0.8  # share of what is missing that one push makes good
TURN_RAD = 0.3  # an elbow swings no farther than this in one push
UNDECIDED = 1e-9


@njit(cache=True)
def depths_at(capsules, positions, orientations, out):
    """How deep each of `overlap.PAIRS` lies in each other, metres, negative when apart. Writes (P,)."""
    ends = capsules_at(capsules, positions, orientations)
    for n in range(len(PAIRS)):
        a, b = PAIRS[n]
        s, t = nearest_between(ends[a, 0], ends[a, 1], ends[b, 0], ends[b, 1])
        apart = vector.distance(vector.mix(ends[a, 0], ends[a, 1], s), vector.mix(ends[b, 0], ends[b, 1], t))
        out[n] = capsules.radius_m[a] + capsules.radius_m[b] - apart


@njit(cache=True)
def let_be(first_m, last_m, weight, out):
    """The depth that each pair may have: what the two ends have, or else a gap of APART_M. Writes (P,)."""
    for n in range(len(out)):
        a, b = max(first_m[n], -APART_M), max(last_m[n], -APART_M)
        out[n] = a + weight * (b - a)


@njit(cache=True)
def yielding(excess_m):
    """What is left of an excess: nothing is taken away at first, in the end all but YIELD_M."""
    return excess_m * YIELD_M / (excess_m + YIELD_M) if excess_m > 0.0 else 0.0


@njit(cache=True)
def bring_arms(body, targets_m, turns, rotations, positions, orientations):
    """Both wrists onto their targets (2, 3) the shortest way, then the elbows about shoulder - wrist by turns (2,).
    In place.

    A turn is counted from where the elbow is: any fixed direction to count from turns over somewhere, and arms that are
    wrapped around a head are there.
    """
    for side in range(2):
        apply_arm(body, rotations, positions, orientations, side, targets_m[side], KEEP, CARRIED)
        if turns[side] != 0.0:
            swivel = arm_swivel(positions, orientations, side, CARRIED) + turns[side]
            apply_arm(body, rotations, positions, orientations, side, targets_m[side], swivel, CARRIED)


@njit(cache=True)
def elbow_travel(positions, side):
    """How an elbow moves as its swivel grows: metres a radian, world. The swivel's sense is away from the body on
    both sides.
    """
    shoulder, elbow, wrist = positions[SHOULDERS[side]], positions[ELBOWS[side]], positions[WRISTS[side]]
    axis = vector.unit(vector.subtract(wrist, shoulder), (0.0, 0.0, -1.0))
    return vector.scale(vector.cross(axis, vector.subtract(elbow, shoulder)), 1.0 - 2.0 * side)


@njit(cache=True)
def _pull(point_share, is_hand, travel, normal):
    """What a push along a normal at one place of an arm asks of wrist and swivel: (share of the wrist, metres a
    radian).
    """
    if is_hand:
        return 1.0, 0.0
    return point_share, (1.0 - point_share) * vector.inner(travel, normal)


@njit(cache=True)
def push_arms(capsules, levels_m, positions, orientations, targets_m, turns):
    """One push: how to move the wrists' targets (2, 3) and turn the elbows (2,) so that no pair is deeper than its
    level (P,).

    Writes both. Returns whether anything is to be done.
    """
    ends = capsules_at(capsules, positions, orientations)
    moves, counts = np.zeros((2, 3)), np.zeros(2)
    turns[:] = 0.0
    travels = (elbow_travel(positions, 0), elbow_travel(positions, 1))
    for n in range(len(PAIRS)):
        a, b = PAIRS[n]
        s, t = nearest_between(ends[a, 0], ends[a, 1], ends[b, 0], ends[b, 1])
        apart = vector.subtract(vector.mix(ends[a, 0], ends[a, 1], s), vector.mix(ends[b, 0], ends[b, 1], t))
        distance = vector.length(apart)
        excess = capsules.radius_m[a] + capsules.radius_m[b] - distance - levels_m[n]
        if excess <= 0.0 or distance < UNDECIDED:
            continue
        normal = vector.scale(apart, 1.0 / distance)
        for role in range(2):
            c, share, sense = (a, s, 1.0) if role == 0 else (b, t, -1.0)
            side = ARM_CAPSULES[c, 0]
            if side < 0:
                continue
            both = 2.0 if ARM_CAPSULES[a, 0] >= 0 and ARM_CAPSULES[b, 0] >= 0 else 1.0
            wrist, swivel = _pull(share, ARM_CAPSULES[c, 1] == 1, travels[side], normal)
            ease = max(wrist * wrist + swivel * swivel / LEVER_M**2, 0.15)
            strength = EAGERNESS * excess * sense / (ease * both)
            for k in range(3):
                moves[side, k] += strength * wrist * normal[k]
            turns[side] += strength * swivel / LEVER_M**2
            counts[side] += 1.0
    for side in range(2):
        # several capsules of a trunk push for one and the same reason
        share = 1.0 / math.sqrt(max(counts[side], 1.0))
        for k in range(3):
            targets_m[side, k] += share * moves[side, k]
        turns[side] = min(max(share * turns[side], -TURN_RAD), TURN_RAD)
    return counts[0] + counts[1] > 0.0


@njit(cache=True)
def clear_arms(body, capsules, allowed_m, targets_m, rotations, positions, orientations):
    """Pushes both arms out of the body, in place, from their targets (2, 3).

    Moves the targets to where the wrists are led. Returns how far that is, metres: (left, right).
    """
    depths = np.empty(len(PAIRS))
    depths_at(capsules, positions, orientations, depths)
    levels, led, turns = np.empty(len(PAIRS)), targets_m.copy(), np.zeros(2)
    for n in range(len(PAIRS)):
        levels[n] = allowed_m[n] + yielding(depths[n] - allowed_m[n])
    for _ in range(PUSHES):
        if not push_arms(capsules, levels, positions, orientations, led, turns):
            break
        bring_arms(body, led, turns, rotations, positions, orientations)
    way = (vector.distance(led[0], targets_m[0]), vector.distance(led[1], targets_m[1]))
    for side in range(2):
        vector.put(targets_m, side, vector.at(led, side))
    return way


@njit(cache=True)
def overrun_between(body, joint, first, last, q):
    """How far a rotation lies beyond a joint's limits, as the two ends of a blend widen them, radians."""
    low, high = body.limit_low_rad[joint], body.limit_high_rad[joint]
    a, b, c = components(first), components(last), components(q)
    worst = 0.0
    for axis in range(3):
        worst = max(worst, min(low[axis], a[axis], b[axis]) - c[axis], c[axis] - max(high[axis], a[axis], b[axis]))
    return worst
