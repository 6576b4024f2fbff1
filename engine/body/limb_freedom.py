"""Which swivel a planted leg may have: the one wanted, or the nearest at which hip and ankle keep their limits.

Turning a leg about the line from hip to ankle moves neither. So whatever a limit forbids is first answered by the knee,
which swings aside no farther than it must; only what is left after that costs.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from engine.body.limb_ik import place_children, side_sign
from engine.body.limits import components
from engine.body.skeleton import ANKLES, HIPS, KNEES, PELVIS, TOES
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

STEP_RAD = math.radians(12.0)
STEPS = 4  # how far to look, to either side
HALVINGS = 12  # of a step: the edge of what is allowed is found to within a few thousandths of a degree

Triple = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


class Leg(NamedTuple):
    """A leg as it is now. Points and orientations in the world unless said otherwise; limits in radians."""

    root: Triple  # hip
    end: Triple  # ankle
    parent: Quaternion  # orientation of the pelvis
    upper: Quaternion  # local rotation of the hip
    low: Triple  # its limits
    high: Triple
    foot: Quaternion  # it stays as it is, so the ankle turns as the shank does
    shank: Quaternion
    foot_low: Triple  # the ankle's limits
    foot_high: Triple
    outwards: float  # the sign of a turn that swings the knee away from the other


@njit(cache=True)
def overrun_rad(low, high, margin_rad, q):
    """How far a rotation's components lie outside limits drawn in by a margin: root of the sum of squares."""
    x, y, z = components(q)
    a = max(low[0] + margin_rad - x, x - high[0] + margin_rad, 0.0)
    b = max(low[1] + margin_rad - y, y - high[1] + margin_rad, 0.0)
    c = max(low[2] + margin_rad - z, z - high[2] + margin_rad, 0.0)
    return math.sqrt(a * a + b * b + c * c)


@inner_kernel
def trouble(leg, turn_out_rad, margin_rad):
    """What is wrong with a leg after a turn about hip - ankle, outwards, radians; 0 if nothing."""
    turn_rad = leg.outwards * turn_out_rad
    axis = vector.unit(vector.subtract(leg.end, leg.root), (0.0, 0.0, -1.0))
    turn = quaternion.from_axis_angle(axis, turn_rad)
    seen = quaternion.from_axis_angle(quaternion.unrotate(leg.parent, axis), turn_rad)
    hip = overrun_rad(leg.low, leg.high, margin_rad, quaternion.multiply(seen, leg.upper))
    shank = quaternion.multiply(turn, leg.shank)
    local = quaternion.multiply(quaternion.conjugate(shank), leg.foot)
    ankle = overrun_rad(leg.foot_low, leg.foot_high, margin_rad, local)
    return math.sqrt(hip * hip + ankle * ankle)


@inner_kernel
def freest_turn(leg, margin_rad):
    """(turn, what is still wrong): the least turn about hip - ankle that leaves nothing wrong, or that leaves least."""
    best, least = 0.0, trouble(leg, 0.0, margin_rad)
    for k in range(2, 2 * STEPS + 2):
        turn = (k // 2) * STEP_RAD * (1.0 - 2.0 * (k % 2))  # outwards and inwards in turn
        wrong = trouble(leg, turn, margin_rad)
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
            if trouble(leg, middle, margin_rad) == 0.0:
                outer = middle
            else:
                inner = middle
        else:
            a, b = inner + (outer - inner) / 3.0, outer - (outer - inner) / 3.0
            if trouble(leg, a, margin_rad) <= trouble(leg, b, margin_rad):
                outer = b
            else:
                inner = a
    return outer, trouble(leg, outer, margin_rad)


@inner_kernel
def free_leg(side, offset_m, low_rad, high_rad, margin_rad, rotations, positions, orientations):
    """Swings a planted leg's knee aside as far as it must, in place; the foot stays. Returns what is still wrong."""
    pelvis, hip, knee, ankle = PELVIS + 0 * side, HIPS[side], KNEES[side], ANKLES[side]
    upper, low, high = quaternion.at(rotations, hip), vector.at(low_rad, hip), vector.at(high_rad, hip)
    foot_low, foot_high = vector.at(low_rad, ankle), vector.at(high_rad, ankle)
    beyond_rad = overrun_rad(low, high, margin_rad, upper)
    if beyond_rad == 0.0 and overrun_rad(foot_low, foot_high, margin_rad, quaternion.at(rotations, ankle)) == 0.0:
        return 0.0
    foot = quaternion.at(orientations, ankle)
    leg = Leg(
        vector.at(positions, hip), vector.at(positions, ankle), quaternion.at(orientations, pelvis), upper, low, high,
        foot, quaternion.at(orientations, knee), foot_low, foot_high, side_sign(side),
    )  # fmt: skip
    turn, wrong = freest_turn(leg, margin_rad)
    turn_leg(offset_m, leg, turn, pelvis, hip, knee, ankle, rotations, positions, orientations)
    shank = quaternion.at(orientations, knee)
    quaternion.put(rotations, ankle, quaternion.multiply(quaternion.conjugate(shank), foot))
    place_children(offset_m, rotations, positions, orientations, knee, ankle)
    place_children(offset_m, rotations, positions, orientations, ankle, TOES[side])
    return wrong


@inner_kernel
def turn_leg(offset_m, leg, turn_out_rad, parent, upper, middle, end, rotations, positions, orientations):
    """Turns a leg about hip - ankle: the hip's rotation, and positions and orientations down to the ankle."""
    turn_rad = leg.outwards * turn_out_rad
    axis = vector.unit(vector.subtract(leg.end, leg.root), (0.0, 0.0, -1.0))
    seen = quaternion.from_axis_angle(quaternion.unrotate(leg.parent, axis), turn_rad)
    quaternion.put(rotations, upper, quaternion.normalise(quaternion.multiply(seen, leg.upper)))
    place_children(offset_m, rotations, positions, orientations, parent, upper)
    place_children(offset_m, rotations, positions, orientations, upper, middle)
    place_children(offset_m, rotations, positions, orientations, middle, end)
