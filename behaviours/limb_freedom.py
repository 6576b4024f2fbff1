"""Which swivel a limb may have: the one wanted, or the nearest at which its joints keep their limits and the arm clears
the trunk.

Turning a limb about the line from its root to its end moves neither hand nor foot. So whatever a limit or the trunk
forbids is first answered by the elbow or the knee, which swings aside no farther than it must; only what is left after
that costs.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import njit

from engine.body.limb_ik import place_children, side_sign
from engine.body.limits import components
from engine.body.skeleton import ANKLES, CLAVICLES, ELBOWS, HIPS, KNEES, PELVIS, SHOULDERS, TOES, WRISTS
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.shapes import nearest_between

STEP_RAD = math.radians(12.0)
ARM_STEPS, LEG_STEPS = 8, 4  # how far to look, to either side
HALVINGS = 12  # of a step: the edge of what is allowed is found to within a few thousandths of a degree
RAD_A_METRE = 5.0  # 2 cm inside the trunk is as bad as 6 degrees beyond a limit
NO_TURN = (1.0, 0.0, 0.0, 0.0)

Triple = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class Limb(NamedTuple):
    """An arm or a leg as it is now. Points and orientations in the world unless said otherwise; limits in radians."""

    root: Triple  # shoulder or hip
    mid: Triple
    end: Triple
    parent: Quaternion  # orientation of clavicle or pelvis
    upper: Quaternion  # local rotation of the root joint
    low: Triple  # its limits
    high: Triple
    foot: Quaternion  # a leg: the foot stays as it is, so the ankle turns as the shank does
    shank: Quaternion
    foot_low: Triple  # the ankle's limits
    foot_high: Triple
    is_leg: bool
    outwards: float  # the sign of a turn that swings elbow or knee away from the body


@njit(cache=True)
def overrun_rad(low, high, margin_rad, q):
    """How far a rotation's components lie outside limits drawn in by a margin: root of the sum of squares."""
    x, y, z = components(q)
    a = max(low[0] + margin_rad - x, x - high[0] + margin_rad, 0.0)
    b = max(low[1] + margin_rad - y, y - high[1] + margin_rad, 0.0)
    c = max(low[2] + margin_rad - z, z - high[2] + margin_rad, 0.0)
    return math.sqrt(a * a + b * b + c * c)


@njit(cache=True)
def depth_m(mid, end, arm_radius_m, obstacles, radii_m):
    """How deep a forearm, from mid to end, lies inside trunk or head, metres.

    obstacles (C, 6): both ends of every capsule, world; radii_m: C of them.
    """
    deepest = 0.0
    for c in range(len(radii_m)):
        start = (obstacles[c, 0], obstacles[c, 1], obstacles[c, 2])
        stop = (obstacles[c, 3], obstacles[c, 4], obstacles[c, 5])
        s, t = nearest_between(start, stop, mid, end)
        apart = vector.distance(vector.mix(start, stop, s), vector.mix(mid, end, t))
        deepest = max(deepest, arm_radius_m + radii_m[c] - apart)
    return deepest


@njit(cache=True)
def trouble(limb, turn_out_rad, margin_rad, arm_radius_m, obstacles, radii_m):
    """What is wrong with a limb after a turn about root - end, outwards, radians; 0 if nothing."""
    turn_rad = limb.outwards * turn_out_rad
    axis = vector.unit(vector.subtract(limb.end, limb.root), (0.0, 0.0, -1.0))
    turn = quaternion.from_axis_angle(axis, turn_rad)
    seen = quaternion.from_axis_angle(quaternion.unrotate(limb.parent, axis), turn_rad)
    beyond = overrun_rad(limb.low, limb.high, margin_rad, quaternion.multiply(seen, limb.upper))
    if limb.is_leg:
        shank = quaternion.multiply(turn, limb.shank)
        local = quaternion.multiply(quaternion.conjugate(shank), limb.foot)
        other = overrun_rad(limb.foot_low, limb.foot_high, margin_rad, local)
    else:
        mid = vector.add(limb.root, quaternion.rotate(turn, vector.subtract(limb.mid, limb.root)))
        other = RAD_A_METRE * depth_m(mid, limb.end, arm_radius_m, obstacles, radii_m)
    return math.sqrt(beyond * beyond + other * other)


@inner_kernel
def freest_turn(limb, margin_rad, arm_radius_m, obstacles, radii_m):
    """(turn, what is still wrong): the least turn about root - end that leaves nothing wrong, or that leaves least."""
    best, least = 0.0, trouble(limb, 0.0, margin_rad, arm_radius_m, obstacles, radii_m)
    steps = LEG_STEPS if limb.is_leg else ARM_STEPS
    for k in range(2, 2 * steps + 2):
        turn = (k // 2) * STEP_RAD * (1.0 - 2.0 * (k % 2))  # outwards and inwards in turn
        wrong = trouble(limb, turn, margin_rad, arm_radius_m, obstacles, radii_m)
        if wrong < least:
            best, least = turn, wrong
        if wrong == 0.0:
            break
    # to the edge of what is allowed, or to the bottom of the valley: both lie within a step of the best
    inner = best - math.copysign(STEP_RAD, best) if least == 0.0 else best - STEP_RAD
    outer = best if least == 0.0 else best + STEP_RAD
    for _ in range(HALVINGS if least == 0.0 else 2 * HALVINGS):
        if least == 0.0:
            middle = 0.5 * (inner + outer)
            if trouble(limb, middle, margin_rad, arm_radius_m, obstacles, radii_m) == 0.0:
                outer = middle
            else:
                inner = middle
        else:
            a, b = inner + (outer - inner) / 3.0, outer - (outer - inner) / 3.0
            wrong_a = trouble(limb, a, margin_rad, arm_radius_m, obstacles, radii_m)
            if wrong_a <= trouble(limb, b, margin_rad, arm_radius_m, obstacles, radii_m):
                outer = b
            else:
                inner = a
    return outer, trouble(limb, outer, margin_rad, arm_radius_m, obstacles, radii_m)


@njit(cache=True)
def free_arm(
    side, offset_m, low_rad, high_rad, margin_rad, arm_radius_m, obstacles, radii_m, rotations, positions, orientations
):
    """Swings an arm's elbow aside as far as it must, in place. Returns what is still wrong, radians."""
    clavicle, shoulder, elbow, wrist = CLAVICLES[side], SHOULDERS[side], ELBOWS[side], WRISTS[side]
    upper, low, high = quaternion.at(rotations, shoulder), vector.at(low_rad, shoulder), vector.at(high_rad, shoulder)
    mid, end = vector.at(positions, elbow), vector.at(positions, wrist)
    beyond_rad = overrun_rad(low, high, margin_rad, upper)
    if beyond_rad == 0.0 and depth_m(mid, end, arm_radius_m, obstacles, radii_m) == 0.0:
        return 0.0
    limb = Limb(
        vector.at(positions, shoulder), mid, end, quaternion.at(orientations, clavicle), upper, low, high,
        NO_TURN, NO_TURN, low, high, False, side_sign(side),
    )  # fmt: skip
    turn, wrong = freest_turn(limb, margin_rad, arm_radius_m, obstacles, radii_m)
    turn_limb(offset_m, limb, turn, clavicle, shoulder, elbow, wrist, rotations, positions, orientations)
    return wrong


@inner_kernel
def free_leg(side, offset_m, low_rad, high_rad, margin_rad, obstacles, radii_m, rotations, positions, orientations):
    """Swings a planted leg's knee aside as far as it must, in place; the foot stays. Returns what is still wrong."""
    pelvis, hip, knee, ankle = PELVIS + 0 * side, HIPS[side], KNEES[side], ANKLES[side]
    upper, low, high = quaternion.at(rotations, hip), vector.at(low_rad, hip), vector.at(high_rad, hip)
    foot_low, foot_high = vector.at(low_rad, ankle), vector.at(high_rad, ankle)
    beyond_rad = overrun_rad(low, high, margin_rad, upper)
    if beyond_rad == 0.0 and overrun_rad(foot_low, foot_high, margin_rad, quaternion.at(rotations, ankle)) == 0.0:
        return 0.0
    foot = quaternion.at(orientations, ankle)
    limb = Limb(
        vector.at(positions, hip), vector.at(positions, knee), vector.at(positions, ankle),
        quaternion.at(orientations, pelvis), upper, low, high, foot, quaternion.at(orientations, knee),
        foot_low, foot_high, True, side_sign(side),
    )  # fmt: skip
    turn, wrong = freest_turn(limb, margin_rad, 0.0, obstacles, radii_m)
    turn_limb(offset_m, limb, turn, pelvis, hip, knee, ankle, rotations, positions, orientations)
    shank = quaternion.at(orientations, knee)
    quaternion.put(rotations, ankle, quaternion.multiply(quaternion.conjugate(shank), foot))
    place_children(offset_m, rotations, positions, orientations, knee, ankle)
    place_children(offset_m, rotations, positions, orientations, ankle, TOES[side])
    return wrong


@inner_kernel
def turn_limb(offset_m, limb, turn_out_rad, parent, upper, middle, end, rotations, positions, orientations):
    """Turns a limb about root - end: the root joint's rotation, and positions and orientations down to the end."""
    turn_rad = limb.outwards * turn_out_rad
    axis = vector.unit(vector.subtract(limb.end, limb.root), (0.0, 0.0, -1.0))
    seen = quaternion.from_axis_angle(quaternion.unrotate(limb.parent, axis), turn_rad)
    quaternion.put(rotations, upper, quaternion.normalise(quaternion.multiply(seen, limb.upper)))
    place_children(offset_m, rotations, positions, orientations, parent, upper)
    place_children(offset_m, rotations, positions, orientations, upper, middle)
    place_children(offset_m, rotations, positions, orientations, middle, end)
