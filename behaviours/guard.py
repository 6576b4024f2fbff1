"""One guarding arm: shoulder raised, palm where block or wrap wants it, elbow at its swivel, hand facing the
threat.

The arm is built anew in closed form (Tolani, Goswami, Badler 2000), not corrected from the clip's: nothing of the
clip's arm is to be kept, and its elbow then is a hinge and keeps its limits by construction.
"""

from __future__ import annotations

import math

from behaviours.limb_freedom import free_arm
from behaviours.perceived import target_centre
from behaviours.rules import block, recoil, wrap
from engine.body.limb_ik import place_children, side_sign
from engine.body.limits import clamp_rotation
from engine.body.skeleton import BACK, CLAVICLES, ELBOWS, HEAD, SHOULDERS, WRISTS
from engine.body.two_bones import SOFT_REACH_M, soft_reach
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.shapes import distance_to_segment, outwards

SLIDE_M, SLIDES, SLIDE_HALVINGS = 0.02, 8, 6  # how a palm looks for room farther out on its line
SAME_TURN_RAD = 1e-6  # a hand that got the turn it wanted needs no second look


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
    side, recoil_control, reach_control, swivel_control, free, slide_m, build, threat, choices, rules,
    offset_m, start_rotations, low_rad, high_rad, obstacles, rotations, positions, orientations,
):  # fmt: skip
    """Recoil and block of one side, in place. Returns (the palm's centre, world; what is still forbidden, radians).

    free: whether the elbow swings aside where shoulder or trunk forbid its swivel; slide_m: how much farther out on the
    line of approach the palm goes than its reach asks for.
    """
    clavicle, shoulder, wrist = CLAVICLES[side], SHOULDERS[side], WRISTS[side]
    back = clavicle - clavicle + BACK  # a number like any other: a constant would compile a variant of its own
    reset(start_rotations, rotations, clavicle, clavicle)
    recoil.raise_clavicle(rotations, side, recoil_control, rules.recoil)
    clamp(low_rad, high_rad, rotations, clavicle)
    place_children(offset_m, rotations, positions, orientations, back, clavicle)
    place_children(offset_m, rotations, positions, orientations, clavicle, shoulder)
    palm, hand, swivel = guard_goal(
        side, reach_control, swivel_control, build, threat, choices, rules, positions, orientations
    )
    palm = vector.along(palm, threat.tangent, -slide_m * (1.0 - choices.wrap))
    palm = clear_of_trunk(palm, build.hand_radius_m, obstacles, build.obstacle_radius_m, rules.block.soften_m)
    turned, wrong = hand, 0.0
    for _ in range(2):
        # a hand stopped by its limits holds its palm elsewhere: the arm follows once
        at = vector.subtract(palm, quaternion.rotate(turned, build.palm_m[side]))
        bend_arm(side, at, swivel, build.elbow_rad[side], offset_m, rotations, positions, orientations)
        if free:
            wrong = free_arm(
                side, offset_m, low_rad, high_rad, rules.limit_margin_rad, build.arm_radius_m[side],
                obstacles, build.obstacle_radius_m, rotations, positions, orientations,
            )  # fmt: skip
        turn_hand(side, hand, offset_m, low_rad, high_rad, rotations, positions, orientations)
        turned = quaternion.at(orientations, wrist)
        if quaternion.angle_between(turned, hand) < SAME_TURN_RAD:
            break
    return vector.add(vector.at(positions, wrist), quaternion.rotate(turned, build.palm_m[side])), wrong


@inner_kernel
def guard_freely(
    side, recoil_control, reach_control, swivel_control, build, threat, choices, rules,
    offset_m, start_rotations, low_rad, high_rad, obstacles, rotations, positions, orientations,
):  # fmt: skip
    """guard, and where no swivel frees the arm, the palm slides out along the line, towards the threat, until one does.

    To the nearest such place, by halving; where there is none within SLIDES steps, the palm stays at its reach.
    """
    near_m = far_m = slide_m = 0.0
    halvings = SLIDE_HALVINGS
    for step in range(SLIDES + SLIDE_HALVINGS + 1):
        palm, wrong = guard(
            side, recoil_control, reach_control, swivel_control, slide_m >= 0.0, slide_m, build, threat, choices, rules,
            offset_m, start_rotations, low_rad, high_rad, obstacles, rotations, positions, orientations,
        )  # fmt: skip
        if step == 0 and (wrong == 0.0 or choices.wrap >= 0.5):
            break
        if wrong == 0.0:
            far_m = slide_m
            if halvings == 0:
                break
        else:
            near_m = slide_m
        if far_m == 0.0:  # still looking for a free place
            slide_m = near_m + SLIDE_M if step < SLIDES else 0.0
        else:
            halvings -= 1
            slide_m = 0.5 * (near_m + far_m) if halvings > 0 else far_m
    return palm, wrong


@inner_kernel
def guard_goal(side, reach_control, swivel_control, build, threat, choices, rules, positions, orientations):
    """Where one palm is wanted, how the hand is turned (world) and the elbow's swivel: block, wrap, or a mixture."""
    b, w, p = rules.block, rules.wrap, rules.pelvis
    trunk = quaternion.at(orientations, side - side + BACK)
    head_reach = block.reach_m(reach_control, b.reach_far_m, b.reach_near_m, build.arm_m[side], b.arm_share)
    pelvis_reach = block.reach_m(reach_control, p.reach_far_m, p.reach_near_m, build.arm_m[side], b.arm_share)
    palm = block.palm_target(
        side,
        vector.at(positions, SHOULDERS[side]),
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
    hand = block.hand_facing(side, vector.scale(threat.tangent, -1.0), choices.fingers)
    swivel = block.swivel_rad(swivel_control, b.swivel_small_rad, b.swivel_large_rad)
    if choices.wrap > 0.0:
        head, at = quaternion.at(orientations, side - side + HEAD), vector.at(positions, side - side + HEAD)
        centre = vector.add(at, quaternion.rotate(head, build.head_centre_m))
        apart = build.head_radius_m + build.hand_radius_m
        behind = wrap.wrapped_palm(side, centre, head, apart, w)
        normal, fingers = wrap.wrapped_hand(side, head, w)
        palm = wrap.around_head(vector.mix(palm, behind, choices.wrap), centre, apart)
        hand = quaternion.slerp(hand, block.hand_facing(side, normal, fingers), choices.wrap)
        swivel += (w.swivel_rad - swivel) * choices.wrap
    return palm, hand, swivel


@inner_kernel
def clear_of_trunk(palm, hand_radius_m, obstacles, radii_m, soften_m):
    """A palm's target pushed out of trunk and head, as far as the hand is thick. obstacles (C, 6), see limb_freedom."""
    for c in range(len(radii_m)):
        start = (obstacles[c, 0], obstacles[c, 1], obstacles[c, 2])
        stop = (obstacles[c, 3], obstacles[c, 4], obstacles[c, 5])
        apart = distance_to_segment(start, stop, palm)
        if apart < hand_radius_m + radii_m[c] + soften_m:
            out = block.smooth_max(apart, hand_radius_m + radii_m[c], soften_m) - apart
            palm = vector.along(palm, outwards(start, stop, palm), out)
    return palm


@inner_kernel
def bend_arm(side, target, swivel_rad, greatest_rad, offset_m, rotations, positions, orientations):
    """Puts the wrist on a world target with the elbow at a swivel, in place: both bones along -Z of their joints.

    The swivel turns about shoulder - wrist from the clavicle's down, positive away from the body. Reach ends softly.
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
    down = quaternion.rotate(girdle, (0.0, 0.0, -1.0))
    out = vector.unit(vector.reject(down, n), vector.unit(vector.reject((1.0, 0.0, 0.0), n), (0.0, 1.0, 0.0)))
    turn = side_sign(side) * swivel_rad
    out = vector.add(vector.scale(out, math.cos(turn)), vector.scale(vector.cross(n, out), math.sin(turn)))
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
def turn_hand(side, hand, offset_m, low_rad, high_rad, rotations, positions, orientations):
    """Gives the hand a world orientation within the limits: what turns about the forearm is the forearm's to do.

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
    twist = min(high_rad[elbow, 2], max(low_rad[elbow, 2], twist))
    quaternion.put(rotations, elbow, quaternion.multiply(quaternion.at(rotations, elbow), quaternion.about_z(twist)))
    place_children(offset_m, rotations, positions, orientations, shoulder, elbow)
    swing = quaternion.multiply(quaternion.conjugate(quaternion.at(orientations, elbow)), hand)
    quaternion.put(rotations, wrist, swing)
    clamp(low_rad, high_rad, rotations, wrist)
    place_children(offset_m, rotations, positions, orientations, elbow, wrist)


@inner_kernel
def stop_shoulder(side, offset_m, low_rad, high_rad, rotations, positions, orientations):
    """Holds one shoulder within its limits and carries arm and hand along, in place."""
    clavicle, wrist = CLAVICLES[side], WRISTS[side]
    clamp(low_rad, high_rad, rotations, SHOULDERS[side])
    for joint in range(clavicle + 1, wrist + 1):
        place_children(offset_m, rotations, positions, orientations, joint - 1, joint)
