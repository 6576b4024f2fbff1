"""Where the elbow of a reaching arm goes: near the wanted swivel, away from the shoulder's limits, never beyond them.

An arm whose wrist is held has one freedom left, the swivel (5.3). It is chosen by least cost: how far it is from the
wanted one, and how far the shoulder is inside a margin before its limits. So the elbow makes room before it has to, and
moves smoothly where taking the nearest allowed swivel would jump: limits are often met at a graze.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.stance.arms import reach
from engine.body import limb_ik, limits
from engine.body.skeleton import ELBOWS, PARENT, SHOULDERS, WRISTS
from engine.maths import brent, quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

MARGIN_RAD = math.radians(20.0)
CROWDED = 5.0  # what a squared radian inside the margin costs against a squared radian of swivel
SWIVEL_TOLERANCE_RAD = 1e-4
MOST_SWIVEL_RAD = math.radians(130.0)  # away from where the search starts
SWIVEL_STEP = math.radians(6.0)  # first step of the search, and how far around its end the least strain is looked for
SECTIONS, GOLDEN = 18, 0.5 * (math.sqrt(5.0) - 1.0)
ROUNDING_RAD = 1e-6  # a straight elbow's angle is known no better


@njit(cache=True)
def reach_within_limits(body, rotations, positions, orientations, side, target_m, wanted_rad, start_rad):
    """`reach` at the swivel of least cost. Returns the miss, the swivel taken, and the strain.

    The search starts at a swivel and goes downhill. Where it ends beyond a limit, the swivel near it that strains least
    is taken; the arm is held at its limits and the wrist goes no farther than that. The strain is what the limits are
    short of, radians, else 0: then the torso has to help.
    """
    swivel = _least_cost(body, rotations, positions, orientations, side, target_m, wanted_rad, start_rad)
    if strain_rad(body, rotations, side) > ROUNDING_RAD:
        swivel = _easiest_near(body, rotations, positions, orientations, side, target_m, swivel)
    miss_m, strain = reach_strained(body, rotations, positions, orientations, side, target_m, swivel)
    return miss_m, swivel, strain


@inner_kernel
def reach_strained(body, rotations, positions, orientations, side, target_m, swivel_rad):
    """`reach` at a swivel, the arm held at its limits. Returns the miss and the strain."""
    reach(body, rotations, positions, orientations, side, target_m, swivel_rad)
    strain = strain_rad(body, rotations, side)
    miss_m = _hold_at_limits(body, rotations, positions, orientations, side, target_m)
    return miss_m, strain if strain > ROUNDING_RAD else 0.0


@inner_kernel
def _least_cost(body, rotations, positions, orientations, side, target_m, wanted_rad, start_rad):
    """The swivel at the bottom of the valley that the search starts in; leaves the arm there. Brent's method."""
    reach(body, rotations, positions, orientations, side, target_m, start_rad)
    crowded = crowding(body, rotations, side)
    if crowded == 0.0 and start_rad == wanted_rad:
        return start_rad
    line = brent.new_line()
    low, high = start_rad - MOST_SWIVEL_RAD, start_rad + MOST_SWIVEL_RAD
    brent.begin(line, start_rad, crowded + (start_rad - wanted_rad) ** 2, SWIVEL_STEP, low, high)
    while not brent.finished(line):
        swivel = line.numbers[brent.TRIAL]
        reach(body, rotations, positions, orientations, side, target_m, swivel)
        brent.tell(line, crowding(body, rotations, side) + (swivel - wanted_rad) ** 2, SWIVEL_TOLERANCE_RAD)
    swivel, _ = brent.best(line)
    reach(body, rotations, positions, orientations, side, target_m, swivel)
    return swivel


@njit(cache=True)
def crowding(body, rotations, side):
    """What the shoulder's nearness to its limits costs: 0 outside the margin, and smooth."""
    joint, total = SHOULDERS[side], 0.0
    angle = limits.components(quaternion.at(rotations, joint))
    for axis in range(3):
        low, high = body.limit_low_rad[joint, axis] + MARGIN_RAD, body.limit_high_rad[joint, axis] - MARGIN_RAD
        inside = max(low - angle[axis], angle[axis] - high, 0.0)
        total += inside * inside
    return CROWDED * total


@inner_kernel
def _easiest_near(body, rotations, positions, orientations, side, target_m, swivel_rad):
    """The swivel of the least strain within a step of one. Golden sections."""
    low, high = swivel_rad - SWIVEL_STEP, swivel_rad + SWIVEL_STEP
    strains = np.empty(2)
    for _ in range(SECTIONS):
        tries = (high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        for k in range(2):
            reach(body, rotations, positions, orientations, side, target_m, tries[k])
            strains[k] = strain_rad(body, rotations, side)
        if strains[0] <= strains[1]:
            high = tries[1]
        else:
            low = tries[0]
    return 0.5 * (low + high)


@inner_kernel
def _hold_at_limits(body, rotations, positions, orientations, side, target_m):
    """Draws shoulder and elbow back to their limits, in place; returns how far the wrist then is from the target."""
    for joint in (SHOULDERS[side], ELBOWS[side]):
        held = limits.clamp_rotation(body.limit_low_rad[joint], body.limit_high_rad[joint], rotations[joint])
        quaternion.put(rotations, joint, held)
        limb_ik.place_children(body.offset_m, rotations, positions, orientations, PARENT[joint], joint)
    limb_ik.place_children(body.offset_m, rotations, positions, orientations, ELBOWS[side], WRISTS[side])
    return vector.distance(positions[WRISTS[side]], target_m)


@inner_kernel
def strain_rad(body, rotations, side):
    """How far shoulder and elbow are beyond their limits: the root of the sum of the squares of what each angle is
    over.
    """
    total = 0.0
    for joint in (SHOULDERS[side], ELBOWS[side]):
        angle = limits.components(rotations[joint])
        for axis in range(3):
            low, high = body.limit_low_rad[joint, axis], body.limit_high_rad[joint, axis]
            over = max(low - angle[axis], angle[axis] - high, 0.0)
            total += over * over
    return math.sqrt(total)
