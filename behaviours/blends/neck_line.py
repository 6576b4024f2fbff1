"""The neck on a straight line while the pelvis moves below it (thesis 4.3), so that the head does not wobble.

The trunk is a limb of two bones, waist to back and back to neck; the back, a joint that turns about three axes, is for
this a hinge, as the thesis has it. A nearly straight spine would have to fold far for a few millimetres of length, and
first this way, then that: there it is only turned, and the line is met in direction.
"""

from __future__ import annotations

import math

from engine.body.kinematics import joints_into
from engine.body.skeleton import BACK, NECK, PELVIS, WAIST
from engine.body.two_bones import soft_reach
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel

SOFT_M = 0.010  # the trunk straightens over this length
STRAIGHT_RAD = 0.35  # a spine bent less than this folds less than it would have to
MOST_RAD = 0.12  # no spine folds or opens farther than this for the line's sake


@inner_kernel
def hold_neck(body, neck_m, root_m, rotations, positions, orientations):
    """Puts the neck on a point of the world as far as the trunk reaches, by its hinge and a turn at the waist. A whole
    pose, in place.
    """
    hinge = quaternion.rotate(quaternion.at(orientations, WAIST), (0.0, 1.0, 0.0))
    lower = vector.subtract(vector.at(positions, BACK), vector.at(positions, WAIST))
    upper = vector.subtract(vector.at(positions, NECK), vector.at(positions, BACK))
    wanted = vector.subtract(neck_m, vector.at(positions, WAIST))
    bend = quaternion.from_axis_angle(hinge, fold_rad(lower, upper, hinge, vector.length(wanted)))
    turn_joint(rotations, orientations, WAIST, BACK, bend)
    chain = vector.add(lower, quaternion.rotate(bend, upper))
    straight = vector.unit(chain, (0.0, 0.0, 1.0))
    turn_joint(rotations, orientations, PELVIS, WAIST, quaternion.between(straight, vector.unit(wanted, straight)))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)


@inner_kernel
def turn_joint(rotations, orientations, parent, joint, world_turn):
    """Turns a joint about a world axis: its local rotation, as its parent stands. In place."""
    outer = quaternion.at(orientations, parent)
    seen = quaternion.multiply(quaternion.multiply(quaternion.conjugate(outer), world_turn), outer)
    quaternion.put(rotations, joint, quaternion.normalise(quaternion.multiply(seen, quaternion.at(rotations, joint))))


@inner_kernel
def fold_rad(lower, upper, hinge, wanted_m):
    """By how much to turn `upper` about the hinge so that the two bones together become so long (cosine law)."""
    lower_along, upper_along = vector.inner(lower, hinge), vector.inner(upper, hinge)
    across = vector.length(vector.reject(lower, hinge)) * vector.length(vector.reject(upper, hinge))
    if across < 1e-9:
        return 0.0
    fixed = vector.inner(lower, lower) + vector.inner(upper, upper) + 2.0 * lower_along * upper_along
    present_m = vector.length(vector.add(lower, upper))
    reach_m = soft_reach(wanted_m, present_m, math.sqrt(fixed + 2.0 * across), SOFT_M)
    present = math.atan2(
        vector.inner(hinge, vector.cross(lower, upper)), vector.inner(lower, upper) - lower_along * upper_along
    )
    angle = math.acos(min(max((reach_m * reach_m - fixed) / (2.0 * across), -1.0), 1.0))
    t = min(abs(present) / STRAIGHT_RAD, 1.0)
    fold = t * t * (3.0 - 2.0 * t) * (angle - abs(present))
    return math.copysign(1.0, present) * MOST_RAD * math.tanh(fold / MOST_RAD)
