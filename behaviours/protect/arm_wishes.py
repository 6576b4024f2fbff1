"""What block, wrap or a mixture of both wants of both arms: where the palms go, how hands are turned, where elbows
point.

Wishes are rows of ten numbers, world: the palm's centre (3), the hand's orientation (4), the elbow's way (3).
"""

from __future__ import annotations

import math

from behaviours.protect.guard import across_arm, guard_goal
from behaviours.protect.task import Choices, Rules
from behaviours.rules.controls import REACH_LEFT, SWIVEL_LEFT
from behaviours.settings import Wrap
from engine.body.limb_ik import place_children, side_sign
from engine.body.limits import from_components, mix
from engine.body.skeleton import CLAVICLES, ELBOWS, SHOULDERS, WRISTS
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel

# a left shoulder's components with the arm across the chest
CROSSED_RAD = (math.radians(-39.0), math.radians(-46.0), math.radians(-46.0))


@inner_kernel
def wish(task, controls, rules, share, posed, wishes):
    """What block (share 0), wrap (1) or a mixture wants of both arms: (2, 10) palm, hand, the elbow's way."""
    c = task.choices
    choices = Choices(c.turn_side, c.turn_rad, c.across, c.fingers, share)
    for side in range(2):
        palm, hand, elbow_way = guard_goal(
            side, controls[REACH_LEFT + side], controls[SWIVEL_LEFT + side], task.build, task.threat, choices,
            rules, posed.positions, posed.orientations,
        )  # fmt: skip
        vector.put(wishes[:, :3], side, palm)
        quaternion.put(wishes[:, 3:7], side, hand)
        vector.put(wishes[:, 7:], side, elbow_way)


@inner_kernel
def beside_head(rules):
    """The rules with hands that wrap beside the head instead of behind it."""
    w = rules.wrap
    beside = Wrap(
        w.behind_low, w.behind_high, w.palm_gap_m, w.beside_aside_rad, w.follow_rad, w.palm_below_m,
        w.beside_fingers_inward_rad, w.beside_elbow_aside_rad, w.beside_aside_rad, w.beside_fingers_inward_rad,
        w.beside_elbow_aside_rad,
    )  # fmt: skip
    return Rules(rules.lean_turn, rules.recoil, rules.block, beside, rules.pelvis, rules.limit_margin_rad)


@inner_kernel
def mix_arms(offset_m, turned, share, posed):
    """Both arms a share of the way from one pose to another: turned (2, 6, 4) shoulder, elbow, wrist, left, right."""
    for side in range(2):
        clavicle = CLAVICLES[side]
        for k in range(3):
            one, other = quaternion.at(turned[0], 3 * side + k), quaternion.at(turned[1], 3 * side + k)
            q = _mix_shoulders(side, one, other, share) if k == 0 else mix(one, other, share)
            joint = clavicle + 1 + k
            quaternion.put(posed.rotations, joint, q)
            place_children(offset_m, posed.rotations, posed.positions, posed.orientations, joint - 1, joint)


@inner_kernel
def _mix_shoulders(side, one, other, share):
    """Between two turns of a shoulder by way of the crossed arm, from which neither is half a turn away.

    Slerp goes the shorter way, and that may be the other one as soon as the two are half a turn apart.
    """
    outward = side_sign(side)
    crossed = from_components(outward * CROSSED_RAD[0], CROSSED_RAD[1], outward * CROSSED_RAD[2])
    a = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(crossed), one))
    b = quaternion.to_rotation_vector(quaternion.multiply(quaternion.conjugate(crossed), other))
    whole = vector.along(b, vector.unit(b, (0.0, 0.0, 1.0)), -2.0 * math.pi)  # the same turn, the other way round
    if vector.distance(a, whole) < vector.distance(a, b):
        b = whole
    return quaternion.multiply(crossed, quaternion.from_rotation_vector(vector.mix(a, b, share)))


@inner_kernel
def wish_as_posed(build, posed, wishes):
    """What would leave both arms where they are."""
    for side in range(2):
        hand = quaternion.at(posed.orientations, WRISTS[side])
        wrist = vector.at(posed.positions, WRISTS[side])
        vector.put(wishes[:, :3], side, vector.add(wrist, quaternion.rotate(hand, build.palm_m[side])))
        quaternion.put(wishes[:, 3:7], side, hand)
        root, elbow = vector.at(posed.positions, SHOULDERS[side]), vector.at(posed.positions, ELBOWS[side])
        n = vector.unit(vector.subtract(wrist, root), (1.0, 0.0, 0.0))
        vector.put(wishes[:, 7:], side, across_arm(n, vector.subtract(elbow, root)))
