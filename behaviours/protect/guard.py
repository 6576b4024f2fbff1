"""One guarding arm: shoulder raised, palm where block or wrap wants it, elbow at its swivel, hand facing the
threat.

The arm is built anew in closed form (Tolani, Goswami, Badler 2000), not corrected from the clip's: nothing of the
clip's arm is to be kept, and its elbow then is a hinge and keeps its limits by construction. Whether shoulder and wrist
can do that, and what is in the way, is for `behaviours.protect.fit_arms`, which sees the pose that is shown: a search
goes by smooth arms.
"""

from __future__ import annotations

import math

from behaviours.perceive.perceived import target_centre
from behaviours.rules import block, recoil, wrap
from engine.body.limb_ik import place_children, side_sign
from engine.body.limits import clamp_rotation
from engine.body.skeleton import BACK, CLAVICLES, ELBOWS, HEAD, SHOULDERS, WRISTS
from engine.body.two_bones import SOFT_REACH_M, soft_reach
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


@inner_kernel
def reset(start_rotations, rotations, first, last):
    """Joints first to last turned as in the start pose."""
    for j in range(first, last + 1):
        quaternion.put(rotations, j, quaternion.at(start_rotations, j))


@inner_kernel
def clamp(low_rad, high_rad, rotations, j):
    """One joint held within its limits, in place."""
    q = clamp_rotation(vector.at(low_rad, j), vector.at(high_rad, j), quaternion.at(rotations, j))
    quaternion.put(rotations, j, q)


@inner_kernel
def guard(
    side, recoil_control, reach_control, swivel_control, build, threat, choices, rules,
    offset_m, start_rotations, low_rad, high_rad, rotations, positions, orientations,
):  # fmt: skip
    """Recoil and block of one side, in place: the arm as the rules want it. Returns the palm's centre, world."""
    clavicle, shoulder = CLAVICLES[side], SHOULDERS[side]
    back = clavicle - clavicle + BACK  # a number like any other: a constant would compile a variant of its own
    reset(start_rotations, rotations, clavicle, clavicle)
    recoil.raise_clavicle(rotations, side, recoil_control, rules.recoil)
    clamp(low_rad, high_rad, rotations, clavicle)
    place_children(offset_m, rotations, positions, orientations, back, clavicle)
    place_children(offset_m, rotations, positions, orientations, clavicle, shoulder)
    palm, hand, elbow_way = guard_goal(
        side, reach_control, swivel_control, build, threat, choices, rules, positions, orientations
    )
    return put_palm(
        side, palm, hand, elbow_way, 0.0, build.palm_m[side], build.elbow_rad[side], offset_m, rotations, positions,
        orientations,
    )  # fmt: skip


@njit(cache=True)
def put_palm(
    side, palm, hand, elbow_way, swing_rad, palm_m, greatest_rad, offset_m, rotations, positions, orientations
):
    """The arm with its palm's centre on a world target and the hand turned as wanted, in place, limits or not.

    elbow_way, swing_rad: see bend_arm; palm_m: the palm's centre in the wrist's frame. Returns where it comes to be:
    the arm may be too short.
    """
    at = vector.subtract(palm, quaternion.rotate(hand, palm_m))
    bend_arm(side, at, elbow_way, swing_rad, greatest_rad, offset_m, rotations, positions, orientations)
    turn_hand(side, hand, offset_m, rotations, positions, orientations)
    return vector.add(vector.at(positions, WRISTS[side]), quaternion.rotate(hand, palm_m))


@inner_kernel
def guard_goal(side, reach_control, swivel_control, build, threat, choices, rules, positions, orientations):
    """Where one palm is wanted, how the hand is turned, and which way the elbow points: block, wrap, or a mixture.

    World; the elbow's way is a unit vector at right angles to the line from shoulder to wrist.
    """
    b, w = rules.block, rules.wrap
    trunk = quaternion.at(orientations, side - side + BACK)
    palm, hand = _blocking(side, reach_control, build, threat, choices, rules, trunk, positions, orientations)
    if choices.wrap > 0.0:
        head, at = quaternion.at(orientations, side - side + HEAD), vector.at(positions, side - side + HEAD)
        centre = vector.add(at, quaternion.rotate(head, build.head_centre_m))
        apart = build.head_radius_m + build.hand_radius_m
        guarded = wrap.guarded_head(head, vector.scale(threat.tangent, -1.0), w)
        behind = wrap.wrapped_palm(side, centre, guarded, apart, w)
        normal, fingers = wrap.wrapped_hand(side, guarded, w)
        palm = wrap.around_head(vector.mix(palm, behind, choices.wrap), centre, apart)
        hand = quaternion.slerp(hand, block.hand_facing(side, normal, fingers), choices.wrap)
    girdle, root = quaternion.at(orientations, CLAVICLES[side]), vector.at(positions, SHOULDERS[side])
    wrist = vector.subtract(palm, quaternion.rotate(hand, build.palm_m[side]))
    n = vector.unit(vector.subtract(wrist, root), (1.0, 0.0, 0.0))
    swivel = block.swivel_rad(swivel_control, b.swivel_small_rad, b.swivel_large_rad)
    elbow_way = turned_about(n, across_arm(n, quaternion.rotate(girdle, (0.0, 0.0, -1.0))), side_sign(side) * swivel)
    if choices.wrap > 0.0:
        around = across_arm(n, quaternion.rotate(trunk, wrap.elbow_direction(side, w)))
        elbow_way = across_arm(n, vector.mix(elbow_way, around, choices.wrap))
    return palm, hand, elbow_way


@inner_kernel
def _blocking(side, reach_control, build, threat, choices, rules, trunk, positions, orientations):
    """Where block wants one palm, and how the hand is turned: facing the threat, fingers as the arm lets them."""
    b, p = rules.block, rules.pelvis
    shoulder = vector.at(positions, SHOULDERS[side])
    head_reach = block.reach_m(reach_control, b.reach_far_m, b.reach_near_m, build.arm_m[side], b.arm_share)
    pelvis_reach = block.reach_m(reach_control, p.reach_far_m, p.reach_near_m, build.arm_m[side], b.arm_share)
    palm = block.palm_target(
        side,
        shoulder,
        threat.head_weight * head_reach + threat.pelvis_weight * pelvis_reach,
        target_centre(threat.target_joint, threat.target_offset_m, positions, orientations),
        threat.line_point_m,
        threat.tangent,
        choices.across,
        quaternion.rotate(trunk, (1.0, 0.0, 0.0)),
        b.clearance_m + threat.excess_radius_m,
        b.offset_m,
        b.soften_m,
    )
    arm = vector.unit(vector.subtract(palm, shoulder), choices.fingers)
    turn = block.fingers_from_up(arm, choices.fingers, b)
    palm = vector.along(palm, choices.across, side_sign(side) * b.fingers_apart_m * math.sin(turn))
    fingers = block.fingers_turned(side, choices.fingers, choices.across, turn)
    return palm, block.hand_facing(side, vector.scale(threat.tangent, -1.0), fingers)


@njit(cache=True)
def across_arm(n, wanted):
    """The unit vector at right angles to the line from shoulder to wrist, unit n, that is nearest to a wanted one."""
    otherwise = vector.unit(vector.reject((1.0, 0.0, 0.0), n), (0.0, 1.0, 0.0))
    return vector.unit(vector.reject(wanted, n), otherwise)


@njit(cache=True)
def turned_about(n, across, angle_rad):
    """A vector at right angles to unit n, turned about it."""
    cosine, sine = math.cos(angle_rad), math.sin(angle_rad)
    return vector.add(vector.scale(across, cosine), vector.scale(vector.cross(n, across), sine))


@inner_kernel
def bend_arm(side, target, elbow_way, swing_rad, greatest_rad, offset_m, rotations, positions, orientations):
    """Puts the wrist on a world target, in place: both bones along -Z of their joints. Reach ends softly.

    The elbow points as nearly the way wanted as that leaves it, and is swung aside from there, positive away from the
    body.
    """
    clavicle, shoulder, elbow, wrist = CLAVICLES[side], SHOULDERS[side], ELBOWS[side], WRISTS[side]
    girdle, root = quaternion.at(orientations, clavicle), vector.at(positions, shoulder)
    upper_m, lower_m = -offset_m[elbow, 2], -offset_m[wrist, 2]
    towards = vector.subtract(target, root)
    reach_m = soft_reach(vector.length(towards), 0.0, upper_m + lower_m, SOFT_REACH_M)
    n = vector.unit(towards, (1.0, 0.0, 0.0))
    # the cosine law; an elbow bends no further than it can, and the wrist then stays farther out
    squares, product = upper_m * upper_m + lower_m * lower_m, 2.0 * upper_m * lower_m
    flexion = math.acos(min(1.0, max(-1.0, (reach_m * reach_m - squares) / product)))
    if flexion > greatest_rad:
        flexion = greatest_rad
        reach_m = math.sqrt(squares + product * math.cos(flexion))
    out = turned_about(n, across_arm(n, elbow_way), side_sign(side) * swing_rad)
    # along n, and out of it towards the elbow, as far as the upper arm goes
    cosine = (upper_m * upper_m + reach_m * reach_m - lower_m * lower_m) / (2.0 * upper_m * reach_m)
    sine = math.sqrt(max(0.0, 1.0 - cosine * cosine))
    z = vector.add(vector.scale(n, -cosine), vector.scale(out, -sine))
    y = vector.cross(n, out)  # the hinge flexes about -Y
    turned = quaternion.from_columns(vector.cross(y, z), y, z)
    quaternion.put(rotations, shoulder, quaternion.multiply(quaternion.conjugate(girdle), turned))
    quaternion.put(rotations, elbow, quaternion.about_y(-flexion))
    place_children(offset_m, rotations, positions, orientations, clavicle, shoulder)
    place_children(offset_m, rotations, positions, orientations, shoulder, elbow)
    vector.put(positions, wrist, vector.along(root, n, reach_m))


@inner_kernel
def turn_hand(side, hand, offset_m, rotations, positions, orientations):
    """Gives the hand a world orientation: what turns about the forearm is the forearm's to do, the rest the wrist's.

    The elbow must be as bend_arm leaves it, a pure hinge.
    """
    shoulder, elbow, wrist = SHOULDERS[side], ELBOWS[side], WRISTS[side]
    wanted = quaternion.multiply(quaternion.conjugate(quaternion.at(orientations, elbow)), hand)
    # wanted = twist * swing, the forearm turning first
    twist = 2.0 * math.atan2(wanted[3], wanted[0])
    if twist > math.pi:
        twist -= 2.0 * math.pi
    elif twist < -math.pi:
        twist += 2.0 * math.pi
    quaternion.put(rotations, elbow, quaternion.multiply(quaternion.at(rotations, elbow), quaternion.about_z(twist)))
    place_children(offset_m, rotations, positions, orientations, shoulder, elbow)
    swing = quaternion.multiply(quaternion.conjugate(quaternion.at(orientations, elbow)), hand)
    quaternion.put(rotations, wrist, swing)
    place_children(offset_m, rotations, positions, orientations, elbow, wrist)


@inner_kernel
def stop_arm(side, offset_m, low_rad, high_rad, rotations, positions, orientations):
    """Holds one arm's joints within their limits and carries what hangs on them along, in place."""
    clavicle, wrist = CLAVICLES[side], WRISTS[side]
    for joint in range(clavicle + 1, wrist + 1):
        clamp(low_rad, high_rad, rotations, joint)
        place_children(offset_m, rotations, positions, orientations, joint - 1, joint)
