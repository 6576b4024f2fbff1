"""Legs whose feet are where they have to be, kept within their joints' limits: the knee swings aside, then the heel
rises.

Neither moves the hip, nor the ball of the foot: the one turns the leg about the line from hip to ankle, the other rolls
the foot on its toes. Of both there is as much as makes least of the sum of squares of what is beyond the limits and of
the turn itself. Limits begin to push a little before they are reached, so that this is a smooth function of the pose:
nothing is decided from frame to frame, and nothing jumps.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from behaviours.timing import ease
from engine.body.limb_freedom import Leg, place_children, turn_leg
from engine.body.limb_ik import apply_leg, leg_swivel, side_sign
from engine.body.limits import components
from engine.body.skeleton import ANKLES, HIPS, KNEES, PELVIS, TOES
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

GIVE_RAD = math.radians(0.2)  # a limit pushes from this much before it on, and gives this much;
EARLY_RAD = math.radians(8.0)  # a pelvis that runs on is held back from this much before a limit on: no dead stop
HEEL_GIVE_RAD = math.radians(0.1)  # the heel rises for what is this much farther, the body
LEFT_GIVE_RAD = math.radians(0.15)  # for what is this much
# of a turn's square, beside the square of what is beyond a limit. An ankle is bent up most with the knee straight
# ahead: were a knee's turn cheaper, it would leave there to one side at once, and to the other a moment later
KNEE_COST, HEEL_COST = 0.01, 0.01
# a knee from which on a heel that rises is all of a help for the ankle, and up to which it is none: the foot goes up,
# the knee bends, and the shank goes down again
BENT_RAD, STRAIGHT_RAD = math.radians(40.0), math.radians(20.0)
ROUNDS = 4  # Gauss-Newton steps, none longer than this:
MOST_RAD = math.radians(4.0)
NUDGE_RAD = 1e-5

Triple = tuple[float, float, float]


class LegBounds(NamedTuple):
    """Where the limits of a leg's hip and ankle begin to push: swing X, swing Y, twist Z, radians."""

    hip_low: Triple
    hip_high: Triple
    ankle_low: Triple
    ankle_high: Triple


@njit(cache=True)
def bounds_between(body, first, last, weight, side, give_rad=GIVE_RAD):
    """The bounds of a leg a weight of the way between two poses (J, 4), each of which widens them in its share by as
    much as it is beyond them itself.
    """
    share = min(max(weight, 0.0), 1.0)
    hip = _widened(body, HIPS[side], first, 1.0 - share, last, share, give_rad)
    ankle = _widened(body, ANKLES[side], first, 1.0 - share, last, share, give_rad)
    return LegBounds(hip[0], hip[1], ankle[0], ankle[1])


@njit(cache=True)
def bounds_over(body, pose, beyond, side, give_rad=GIVE_RAD):
    """The bounds of a leg that may be as far beyond its limits as a pose (J, 4), and as `beyond` (J, 3), which counts
    from limits drawn in by EARLY_RAD; radians, negative below.
    """
    own = bounds_between(body, pose, pose, 0.0, side, give_rad)
    hip, ankle = vector.at(beyond, HIPS[side]), vector.at(beyond, ANKLES[side])
    hip_low, hip_high = vector.at(body.limit_low_rad, HIPS[side]), vector.at(body.limit_high_rad, HIPS[side])
    foot_low, foot_high = vector.at(body.limit_low_rad, ANKLES[side]), vector.at(body.limit_high_rad, ANKLES[side])
    return LegBounds(
        _lower(own.hip_low, hip_low, hip, give_rad), _higher(own.hip_high, hip_high, hip, give_rad),
        _lower(own.ankle_low, foot_low, ankle, give_rad), _higher(own.ankle_high, foot_high, ankle, give_rad),
    )  # fmt: skip


@inner_kernel
def _lower(own, low, beyond, give_rad):
    return (
        min(own[0], low[0] + min(give_rad, EARLY_RAD + beyond[0])),
        min(own[1], low[1] + min(give_rad, EARLY_RAD + beyond[1])),
        min(own[2], low[2] + min(give_rad, EARLY_RAD + beyond[2])),
    )


@inner_kernel
def _higher(own, high, beyond, give_rad):
    return (
        max(own[0], high[0] - min(give_rad, EARLY_RAD - beyond[0])),
        max(own[1], high[1] - min(give_rad, EARLY_RAD - beyond[1])),
        max(own[2], high[2] - min(give_rad, EARLY_RAD - beyond[2])),
    )


@inner_kernel
def _widened(body, joint, first, first_share, last, last_share, give_rad):
    a, b = components(first[joint]), components(last[joint])
    low, high = vector.at(body.limit_low_rad, joint), vector.at(body.limit_high_rad, joint)
    return (
        (
            low[0] + give_rad - _over(low[0] + give_rad, a[0], b[0], -1.0, first_share, last_share),
            low[1] + give_rad - _over(low[1] + give_rad, a[1], b[1], -1.0, first_share, last_share),
            low[2] + give_rad - _over(low[2] + give_rad, a[2], b[2], -1.0, first_share, last_share),
        ),
        (
            high[0] - give_rad + _over(high[0] - give_rad, a[0], b[0], 1.0, first_share, last_share),
            high[1] - give_rad + _over(high[1] - give_rad, a[1], b[1], 1.0, first_share, last_share),
            high[2] - give_rad + _over(high[2] - give_rad, a[2], b[2], 1.0, first_share, last_share),
        ),
    )


@inner_kernel
def _over(bound, first, last, sign, first_share, last_share):
    """How far two components are beyond a bound, in their shares; sign: 1 for a high bound, -1 for a low one."""
    return first_share * max(sign * (first - bound), 0.0) + last_share * max(sign * (last - bound), 0.0)


@njit(cache=True)
def pushed(low, high, value, give_rad=GIVE_RAD):
    """How far a component is beyond its bounds, radians, negative below, and how much of a change of it counts.

    Smoothly from nothing, in the end as far as it is beyond the limit, which is give_rad beyond the bound.
    """
    beyond = max(value - high, 0.0) + min(value - low, 0.0)
    share = min(abs(beyond) / (2.0 * give_rad), 1.0)
    return share * (beyond if share < 1.0 else 2.0 * beyond - math.copysign(2.0 * give_rad, beyond)) * 0.5, share


@njit(cache=True)
def keep_leg(body, bounds, bears, side, rotations, positions, orientations):
    """A leg within its bounds as far as its knee and heel can do that, in place; the ball of the foot stays. The less,
    the less its foot bears (0 to 1): one in the air may turn, and stay behind. Returns how far its ankle is bent up
    beyond its limit even so, radians.
    """
    free_knee(body, bounds, bears, side, rotations, positions, orientations)
    raise_heel(body, bounds, bears, side, rotations, positions, orientations)
    free_knee(body, bounds, bears, side, rotations, positions, orientations)
    bound = bounds.ankle_low[1] - LEFT_GIVE_RAD
    return -pushed(bound, math.inf, components(quaternion.at(rotations, ANKLES[side]))[1])[0]


@njit(cache=True)
def free_knee(body, bounds, bears, side, rotations, positions, orientations):
    """Swings the knee aside for the sake of hip and ankle, in place; hip, ankle and foot stay where they are."""
    if bears == 0.0:
        return
    hip, knee, ankle = HIPS[side], KNEES[side], ANKLES[side]
    leg = Leg(
        vector.at(positions, hip), vector.at(positions, ankle), quaternion.at(orientations, PELVIS),
        quaternion.at(rotations, hip), bounds.hip_low, bounds.hip_high, quaternion.at(orientations, ankle),
        quaternion.at(orientations, knee), bounds.ankle_low, bounds.ankle_high, side_sign(side),
    )  # fmt: skip
    turn = least_turn(leg, bears)
    if turn == 0.0:
        return
    turn_leg(body.offset_m, leg, turn, PELVIS, hip, knee, ankle, rotations, positions, orientations)
    local = quaternion.multiply(quaternion.conjugate(quaternion.at(orientations, knee)), leg.foot)
    quaternion.put(rotations, ankle, quaternion.normalise(local))
    place_children(body.offset_m, rotations, positions, orientations, knee, ankle)
    place_children(body.offset_m, rotations, positions, orientations, ankle, TOES[side])


@inner_kernel
def least_turn(leg, bears):
    """The turn about hip - ankle, outwards, radians."""
    turn = 0.0
    for _ in range(ROUNDS):
        hip, ankle = turned_components(leg, turn)
        next_hip, next_ankle = turned_components(leg, turn + NUDGE_RAD)
        slope, curve = KNEE_COST * turn, KNEE_COST
        for k in range(3):
            push, share = pushed(leg.low[k], leg.high[k], hip[k])
            rate = (next_hip[k] - hip[k]) / NUDGE_RAD
            slope, curve = slope + bears * push * rate, curve + bears * share * rate * rate
            push, share = pushed(leg.foot_low[k], leg.foot_high[k], ankle[k])
            rate = (next_ankle[k] - ankle[k]) / NUDGE_RAD
            slope, curve = slope + bears * push * rate, curve + bears * share * rate * rate
        if slope == 0.0:
            break
        turn -= MOST_RAD * math.tanh(slope / curve / MOST_RAD)
    return turn


@inner_kernel
def turned_components(leg, turn_out_rad):
    """The components of a leg's hip and ankle after a turn about hip - ankle, radians."""
    turn_rad = leg.outwards * turn_out_rad
    axis = vector.unit(vector.subtract(leg.end, leg.root), (0.0, 0.0, -1.0))
    shank = quaternion.multiply(quaternion.from_axis_angle(axis, turn_rad), leg.shank)
    seen = quaternion.from_axis_angle(quaternion.unrotate(leg.parent, axis), turn_rad)
    return (
        components(quaternion.multiply(seen, leg.upper)),
        components(quaternion.multiply(quaternion.conjugate(shank), leg.foot)),
    )


@njit(cache=True)
def raise_heel(body, bounds, bears, side, rotations, positions, orientations):
    """Rolls the foot on its toes for an ankle that is bent up, or a hip that is stretched back, farther than it goes,
    in place; the toes stay where they are, the knee keeps its swivel.
    """
    low, high = bounds.ankle_low[1] - HEEL_GIVE_RAD, bounds.hip_high[1] + HEEL_GIVE_RAD
    ankle, hip = flexions(rotations, side)
    if bears == 0.0 or (ankle >= low and hip <= high):
        return
    bent = ease((components(quaternion.at(rotations, KNEES[side]))[1] - STRAIGHT_RAD) / (BENT_RAD - STRAIGHT_RAD))
    foot = (
        vector.at(positions, ANKLES[side]), quaternion.at(orientations, ANKLES[side]),
        quaternion.at(rotations, TOES[side]), leg_swivel(positions, orientations, side),
    )  # fmt: skip
    risen = 0.0
    for _ in range(ROUNDS):
        roll_foot(body, foot, risen + NUDGE_RAD, side, rotations, positions, orientations)
        next_ankle, next_hip = flexions(rotations, side)
        roll_foot(body, foot, risen, side, rotations, positions, orientations)
        ankle, hip = flexions(rotations, side)
        slope, curve = HEEL_COST * risen, HEEL_COST
        for now, later, bound, share in ((ankle, next_ankle, low, bears * bent), (-hip, -next_hip, -high, bears)):
            push, counts = pushed(bound, math.inf, now)
            rate = (later - now) / NUDGE_RAD
            slope, curve = slope + share * rate * push, curve + share * counts * rate * rate
        risen = max(risen - MOST_RAD * math.tanh(slope / curve / MOST_RAD), 0.0)
    roll_foot(body, foot, risen, side, rotations, positions, orientations)


@inner_kernel
def flexions(rotations, side):
    """The bend of an ankle and of a hip, radians, both positive backwards."""
    return components(quaternion.at(rotations, ANKLES[side]))[1], components(quaternion.at(rotations, HIPS[side]))[1]


@inner_kernel
def roll_foot(body, foot, risen_rad, side, rotations, positions, orientations):
    """Puts a foot, given by its ankle's place and orientation, its toe's rotation and the knee's swivel, with its heel
    risen by an angle about the ball. In place, from the hip down.
    """
    ankle_m, turned, toe, swivel = foot
    ball = vector.at(body.offset_m, TOES[side])
    rolled = quaternion.multiply(turned, quaternion.about_y(risen_rad))
    ball_m = vector.add(ankle_m, quaternion.rotate(turned, ball))
    target = vector.subtract(ball_m, quaternion.rotate(rolled, ball))
    quaternion.put(rotations, TOES[side], quaternion.multiply(quaternion.about_y(-risen_rad), toe))
    apply_leg(body, rotations, positions, orientations, side, target, rolled, swivel, 0.0)
