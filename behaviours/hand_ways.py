"""Which way each hand goes in a blend: the thesis's straight line (4.3), unless that is no way for an arm.

Straight hand lines pass through torso or head in half the cases (specification A7). Once for a blend, a few ways are
tried along their whole length and the straightest good one is kept; `behaviours.blending` then follows it.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from behaviours.blending import arms_between, blend_trunk_and_legs
from behaviours.clearing import depths_at, let_be, overrun_between
from behaviours.overlap import ARM_CAPSULES, PAIRS
from engine.body.skeleton import ELBOWS, JOINT_COUNT, PELVIS, SHOULDERS
from engine.maths import vector

# (share of the slerped arm's way, bow): straight; straight, but with the slerped arm's elbow; ever more the slerped
# arm's way, with a negative share the shoulder mixed by components; then bowed out, metres, ahead and aside, round
# the trunk
ARC_WAYS = np.array([
    (0.0, 0.0), (1e-3, 0.0), (-1e-3, 0.0), (0.25, 0.0), (-0.25, 0.0),
    (0.5, 0.0), (-0.5, 0.0), (0.75, 0.0), (1.0, 0.0), (-1.0, 0.0),
    (1e-3, 0.12), (-1e-3, 0.12), (0.5, 0.12), (-0.5, 0.12), (1.0, 0.12),
    (1e-3, 0.24), (-1e-3, 0.24), (0.5, 0.24), (1.0, 0.24),
])  # fmt: skip
ARC_SAMPLES = 16
ARC_STRIDE_M = 0.15  # an elbow that goes farther than this from one sample to the next turns over
ARC_LIMIT_RAD = 0.005  # a line on which the shoulder goes this far beyond its limits, or
ARC_DEPTH_M = 0.05  # the arm lies this deep in the body, is no line to follow
ARC_LEVER_M = 0.3  # this much too deep is as bad as a radian beyond the limits


@njit(cache=True)
def arm_trouble(body, capsules, start, end, weight, side, rotations, positions, orientations):
    """What is wrong with an arm on the way: radians beyond its shoulder's limits, and metres too deep in the body."""
    joint = SHOULDERS[side]
    beyond = overrun_between(body, joint, start.rotations[joint], end.rotations[joint], rotations[joint])
    depths, allowed, deepest = np.empty(len(PAIRS)), np.empty(len(PAIRS)), 0.0
    depths_at(capsules, positions, orientations, depths)
    let_be(start.depths_m, end.depths_m, weight, allowed)
    for n in range(len(PAIRS)):
        # the other arm's way is not yet known: hands are kept apart as they go
        if ARM_CAPSULES[PAIRS[n, 0], 0] == side and ARM_CAPSULES[PAIRS[n, 1], 0] < 0:
            deepest = max(deepest, depths[n] - allowed[n])
    return beyond, deepest


@njit(cache=True)
def choose_arcs(body, capsules, start, end, support, goals):
    """How each hand goes, (2, 2), one of ARC_WAYS: the first, a straight line, unless that is no way for an arm.

    A line that leads deep through the body, or where the shoulder cannot follow, is bent towards the way that
    slerping the arm takes, or round the trunk: by the first way that is good enough, else by the one that leaves
    least wrong.
    """
    arcs, least = np.zeros((2, 2)), np.full(2, np.inf)
    found = np.zeros(2, np.bool_)
    root_m, rotations = np.empty(3), np.empty((JOINT_COUNT, 4))
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    for way in range(len(ARC_WAYS)):
        both, worst, elbows_m = np.empty((2, 2)), np.zeros(2), np.empty((2, 3))
        for side in range(2):
            both[side, 0], both[side, 1] = ARC_WAYS[way, 0], ARC_WAYS[way, 1]
        for k in range(ARC_SAMPLES + 1):
            weight = k / ARC_SAMPLES
            blend_trunk_and_legs(
                body, start, end, weight, support, goals, both, root_m, rotations, positions, orientations
            )
            arms_between(body, start, end, weight, both, rotations, positions, orientations)
            for side in range(2):
                beyond, deep = arm_trouble(body, capsules, start, end, weight, side, rotations, positions, orientations)
                wrong = max(0.0, beyond - ARC_LIMIT_RAD) + max(0.0, deep - ARC_DEPTH_M) / ARC_LEVER_M
                elbow = vector.subtract(positions[ELBOWS[side]], positions[PELVIS])
                if k > 0:
                    wrong += max(0.0, vector.distance(elbow, elbows_m[side]) - ARC_STRIDE_M) / ARC_LEVER_M
                for axis in range(3):
                    elbows_m[side, axis] = elbow[axis]
                worst[side] = max(worst[side], wrong)
        for side in range(2):
            if not found[side] and worst[side] < least[side]:
                least[side] = worst[side]
                arcs[side, 0], arcs[side, 1] = ARC_WAYS[way, 0], ARC_WAYS[way, 1]
                found[side] = worst[side] == 0.0
        if found[0] and found[1]:
            break
    return arcs
