"""How an arm goes from one end of a blend to the other (thesis 4.3): the hand on a straight line, the elbow's swivel
interpolated; or, where that is no way for an arm, swung from joint to joint on a way that was chosen beforehand.

A way is a smooth function of how far the blend is, fixed for as long as it lasts (`behaviours.blends.hand_ways` chooses
it): nothing is corrected from frame to frame, so nothing jumps. A swung arm's shoulder and elbow go evenly, component
by component, and beside that by the two inner knots of a cubic curve, always within the limits that their ends allow.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.blends.held_feet import mix_angle
from engine.body import limits
from engine.body.limb_ik import CARRIED, KEEP, apply_arm, arm_swivel, place_children, side_sign
from engine.body.skeleton import CLAVICLES, ELBOWS, SHOULDERS, WRISTS
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

# the hand goes straight, and the elbow's swivel is interpolated, as the thesis has it; or the elbow goes where slerping
# the arm takes it; or the whole arm is swung, and the hand goes where that takes it
INTERPOLATED, SLERPED, SWUNG = range(3)
# radians: a shoulder's swing X, swing Y and twist, and an elbow's flexion; X and twist away from the body on both sides
KNOTS, KNOT_PARTS = 2, 4
BEYOND_RAD = math.radians(0.2)  # what a limit gives at most: twice that, where a blend ends in another one
MOST_SWING_RAD = math.radians(175.0)  # half a turn of swing has no direction


class HandWays(NamedTuple):
    """The ways of both arms in one blend, left first."""

    modes: np.ndarray  # (2,) INTERPOLATED, SLERPED or SWUNG
    bends: np.ndarray  # (2, KNOTS, KNOT_PARTS) of a swung arm, radians


def straight_ways() -> HandWays:
    """The thesis's: both hands on straight lines, both swivels interpolated."""
    return HandWays(np.zeros(2, np.int64), np.zeros((2, KNOTS, KNOT_PARTS)))


def swung_ways() -> HandWays:
    """Both arms turned evenly from joint to joint: for ends that move, and are near each other."""
    return HandWays(np.full(2, SWUNG), np.zeros((2, KNOTS, KNOT_PARTS)))


@inner_kernel
def follow_way(body, start, end, weight, side, ways, rotations, positions, orientations):
    """One arm on its way from end to end, in place, whatever it was. The trunk is where it is to be.

    start, end: `behaviours.blends.blending.BlendEnd`s. Returns how far the joints' limits keep the hand off its line,
    metres.
    """
    shoulder, elbow, wrist, mode = SHOULDERS[side], ELBOWS[side], WRISTS[side], ways.modes[side]
    first, last = start.rotations, end.rotations
    if mode == SWUNG:
        upper, lower = swing_arm(body, first, last, weight, side, ways.bends[side])
    else:
        upper = quaternion.slerp(first[shoulder], last[shoulder], weight)
        # slerp would take an elbow sideways from one forearm twist to another, farther than any elbow goes
        lower = limits.mix(first[elbow], last[elbow], weight)
    quaternion.put(rotations, shoulder, upper)
    quaternion.put(rotations, elbow, lower)
    quaternion.put(rotations, wrist, limits.mix(first[wrist], last[wrist], weight))
    place_arm(body, side, rotations, positions, orientations)
    if mode == SWUNG:
        return 0.0
    # KEEP: from where the arm is slerped. A fixed direction to count a swivel from turns over somewhere
    swivel = swivel_between(start, end, weight, side) if mode == INTERPOLATED else KEEP
    line = vector.mix(vector.at(start.positions, wrist), vector.at(end.positions, wrist), weight)
    apply_arm(body, rotations, positions, orientations, side, line, swivel, CARRIED)
    return keep_within_limits(body, first, last, weight, side, rotations, positions, orientations)


@inner_kernel
def place_arm(body, side, rotations, positions, orientations):
    """Forward kinematics from the clavicle to the wrist."""
    chain = (CLAVICLES[side], SHOULDERS[side], ELBOWS[side], WRISTS[side])
    for k in range(3):
        place_children(body.offset_m, rotations, positions, orientations, chain[k], chain[k + 1])


@inner_kernel
def swivel_between(start, end, weight, side):
    """An elbow's swivel between its two ends, radians, the shorter way round."""
    first = arm_swivel(start.positions, start.orientations, side, CARRIED)
    last = arm_swivel(end.positions, end.orientations, side, CARRIED)
    return mix_angle(first, last, weight)


@inner_kernel
def knot_weights(weight):
    """How much of either knot there is on the way: the two inner Bernstein polynomials of degree 3, nothing at either
    end.
    """
    left = 1.0 - weight
    both = 3.0 * weight * left
    return both * left, both * weight


@inner_kernel
def swing_arm(body, first, last, weight, side, bends):
    """A swung arm's shoulder and elbow between two poses (J, 4); bends (KNOTS, KNOT_PARTS)."""
    shoulder, elbow = SHOULDERS[side], ELBOWS[side]
    return (
        swing_shoulder(
            body.limit_low_rad[shoulder], body.limit_high_rad[shoulder],
            limits.components(first[shoulder]), limits.components(last[shoulder]), weight, side_sign(side), bends,
        ),
        swing_elbow(
            body.limit_low_rad[elbow], body.limit_high_rad[elbow],
            limits.components(first[elbow]), limits.components(last[elbow]), weight, bends,
        ),
    )  # fmt: skip


@inner_kernel
def swing_shoulder(low, high, first, last, weight, sign, bends):
    """A shoulder on its way between two rotations, all given by their components; sign: 1 left, -1 right."""
    early, late = knot_weights(weight)
    x, y, z = vector.mix(first, last, weight)
    x = kept(low[0], high[0], first[0], last[0], weight, x + sign * (early * bends[0, 0] + late * bends[1, 0]))
    y = kept(low[1], high[1], first[1], last[1], weight, y + early * bends[0, 1] + late * bends[1, 1])
    z = kept(low[2], high[2], first[2], last[2], weight, z + sign * (early * bends[0, 2] + late * bends[1, 2]))
    swing = math.sqrt(x * x + y * y)
    if swing > MOST_SWING_RAD:
        x, y = x * MOST_SWING_RAD / swing, y * MOST_SWING_RAD / swing
    return limits.from_components(x, y, z)


@inner_kernel
def swing_elbow(low, high, first, last, weight, bends):
    """Likewise an elbow: only its flexion is bent."""
    early, late = knot_weights(weight)
    x, y, z = vector.mix(first, last, weight)
    y = kept(low[1], high[1], first[1], last[1], weight, y + early * bends[0, 3] + late * bends[1, 3])
    return limits.from_components(x, y, z)


@njit(cache=True)
def kept(low, high, first, last, weight, value):
    """A component drawn back, gently, to its limits as the two ends widen them; radians."""
    beyond = outside(low, high, first, last, weight, value)
    return value - beyond + yielding(beyond)


@njit(cache=True)
def outside(low, high, first, last, weight, value):
    """How far a component is outside its limits, which either end widens in its share; negative below. Radians."""
    below = (1.0 - weight) * max(low - first, 0.0) + weight * max(low - last, 0.0)
    above = (1.0 - weight) * max(first - high, 0.0) + weight * max(last - high, 0.0)
    return max(value - high - max(above, 0.0), 0.0) + min(value - low + max(below, 0.0), 0.0)


@njit(cache=True)
def yielding(excess, most_rad=BEYOND_RAD):
    """What is left of an excess: nothing is taken away at first, in the end all but `most_rad`."""
    return excess * most_rad / (abs(excess) + most_rad)


@inner_kernel
def overstep(body, joint, first, last, weight, q):
    """How far a rotation lies outside a joint's limits as the two ends widen them: three components, radians; and its
    components.
    """
    a, b, c = limits.components(first), limits.components(last), limits.components(q)
    low, high = body.limit_low_rad[joint], body.limit_high_rad[joint]
    return (
        outside(low[0], high[0], a[0], b[0], weight, c[0]),
        outside(low[1], high[1], a[1], b[1], weight, c[1]),
        outside(low[2], high[2], a[2], b[2], weight, c[2]),
    ), c


@inner_kernel
def within_limits(body, joint, first, last, weight, q, most_rad):
    """A rotation, drawn back to its limits gently, which give that much at most; and whether that changed anything."""
    beyond, c = overstep(body, joint, first, last, weight, q)
    if beyond[0] == 0.0 and beyond[1] == 0.0 and beyond[2] == 0.0:
        return (q[0] * 1.0, q[1] * 1.0, q[2] * 1.0, q[3] * 1.0), False
    return limits.from_components(
        c[0] - beyond[0] + yielding(beyond[0], most_rad),
        c[1] - beyond[1] + yielding(beyond[1], most_rad),
        c[2] - beyond[2] + yielding(beyond[2], most_rad),
    ), True


@inner_kernel
def keep_within_limits(body, first, last, weight, side, rotations, positions, orientations):
    """Shoulder and elbow drawn back to their limits, in place. Returns how far that moves the hand, metres."""
    was, moved = vector.at(positions, WRISTS[side]), False
    for joint in (SHOULDERS[side], ELBOWS[side]):
        q, changed = within_limits(body, joint, first[joint], last[joint], weight, rotations[joint], BEYOND_RAD)
        if changed:
            quaternion.put(rotations, joint, q)
            moved = True
    if not moved:
        return 0.0
    place_arm(body, side, rotations, positions, orientations)
    return vector.distance(was, vector.at(positions, WRISTS[side]))
