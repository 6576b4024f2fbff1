"""The second pass of a blend (thesis 4.3): the COM on the straight line between its two ends, and all that hangs on
it.

The pelvis is moved until the COM is where it is to be; at every try the feet are held by leg IK, the neck by the
waist-neck chain, the head by its orientation, and the arms are put on their ways last, since all of that moves
shoulders (specification A7).
"""

from __future__ import annotations

import math

from behaviours.blends.arm_ways import BEYOND_RAD, follow_way, within_limits
from behaviours.blends.held_feet import hold_feet, leg_lengths
from behaviours.blends.leg_limits import bounds_between, keep_leg
from behaviours.blends.neck_line import hold_neck
from behaviours.timing import ease
from engine.body.kinematics import centre_of_mass, joints_into
from engine.body.limb_ik import place_children, turn_end_to
from engine.body.skeleton import ANKLES, BACK, HEAD, HIPS, KNEES, NECK, PELVIS, TOES, WAIST
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel

TRIES, LAST_TRIES = 5, 2
# how far the pelvis moves for a COM that is off by one: feet, neck and hands stay behind, so that it brings the COM
# from two fifths of that to nearly all of it; of either, each try leaves less than a half
GAIN = 1.5
LAST_GAIN = 0.7
# and a few more where it is still off by more than this, whole ones from twice that: nothing sets in all at once. None
# where knees hang on the last frame: there a try more would show
MORE_TRIES, NEAR_M = 4, 0.002
# how far the COM is moved along its line for a leg that is too short by one, and how steep a leg counts as plumb
ALONG_GAIN, PLUMB = 0.4, 0.3
# how far above its line the COM may go for an ankle that a low pelvis bends up too far, and by how much for a radian
MOST_LIFT_M, LIFT_GAIN_M = 0.0035, 0.1
LEGS_SHARE = 0.5  # of the pelvis's way that the legs go, feet held


@inner_kernel
def balance(body, start, end, weight, goals, ways, knees, root_m, rotations, positions, orientations):
    """Moves the pelvis until the COM is on its line, everything else held where it belongs. In place.

    start, end: BlendEnds; the pose is the first pass's. Where a foot stands, or comes to stand, out of reach, the COM
    is farther on along its line than the rest, or not so far, whichever brings the foot into reach: at either end all
    are. Returns how far limits keep either hand off its way, metres.

    A straight knee moves ten times as far as the hip that bends it: were it let into the search, that would run away
    from it. So the legs count at first as going half of the pelvis's way; as they do go only in the end. And where the
    blend begins and ends they count as going straight from end to end, since a knee there may leave being straight all
    at once.
    """
    waist, back = quaternion.at(rotations, WAIST), quaternion.at(rotations, BACK)
    led, sunk_m, bent_rad = hold_ends(
        body, start, end, weight, goals, ways, knees, root_m, rotations, positions, orientations
    )
    far_m, ahead_m, lift_m = max(vector.distance(start.com_m, end.com_m), 1e-9), 0.0, 0.0
    line = vector.scale(vector.subtract(end.com_m, start.com_m), 1.0 / far_m)
    legs, mass, legs_mass = legs_moment(body, positions, orientations)
    first = legs_moment(body, start.positions, start.orientations)[0]
    last = legs_moment(body, end.positions, end.orientations)[0]
    inside = 1.0 - (1.0 - min(max(4.0 * weight * (1.0 - weight), 0.0), 1.0)) ** 4
    legs = vector.mix(vector.mix(first, last, weight), legs, inside)
    first_m = (root_m[0], root_m[1], root_m[2])
    for n in range(TRIES + LAST_TRIES + (0 if knees.least else MORE_TRIES)):
        com_m = centre_of_mass(body, positions, orientations)
        for side in range(2):
            ahead_m += ALONG_GAIN * sunk_m[side] * towards_foot(line, goals, side, positions)
        ahead_m = max(min(ahead_m, max(1.0 - weight, 0.0) * far_m), -weight * far_m)
        lift_m += LIFT_GAIN_M * bent_rad
        wanted_m = vector.mix(start.com_m, end.com_m, weight + ahead_m / far_m)
        wanted_m = (wanted_m[0], wanted_m[1], wanted_m[2] + MOST_LIFT_M * math.tanh(lift_m / MOST_LIFT_M))
        off_m = vector.subtract(wanted_m, com_m)
        if n < TRIES:
            now, share = legs_moment(body, positions, orientations)[0], LEGS_SHARE * legs_mass
            for k in range(3):
                modelled = legs[k] + share * (root_m[k] - first_m[k])
                root_m[k] += GAIN * (off_m[k] - (modelled - now[k]) / mass)
        else:
            gain = LAST_GAIN * inside
            if n >= TRIES + LAST_TRIES:
                gain *= ease(vector.length(off_m) / NEAR_M - 1.0)
            if gain == 0.0:
                break
            for k in range(3):
                root_m[k] += gain * off_m[k]
        quaternion.put(rotations, WAIST, waist)
        quaternion.put(rotations, BACK, back)
        led, sunk_m, bent_rad = hold_ends(
            body, start, end, weight, goals, ways, knees, root_m, rotations, positions, orientations
        )
    return led


@inner_kernel
def towards_foot(line, goals, side, positions):
    """How far along a line (a unit vector) a hip has to go for its leg to be shorter by one, near to plumb less."""
    leg = vector.subtract(vector.at(goals.ankle_m, side), vector.at(positions, HIPS[side]))
    steep = vector.inner(line, leg) / max(vector.length(leg), 1e-9)
    return steep / (steep * steep + PLUMB * PLUMB)


@inner_kernel
def legs_moment(body, positions, orientations):
    """Both legs' masses times their places (kg m, world), all the mass there is, and theirs."""
    moment, total, legs = (0.0, 0.0, 0.0), 0.0, 0.0
    for part in range(len(body.part_mass_kg)):
        joint, mass = body.part_joint[part], body.part_mass_kg[part]
        total += mass
        if joint >= HIPS[0]:
            centre = quaternion.rotate(quaternion.at(orientations, joint), vector.at(body.part_com_m, part))
            moment = vector.along(moment, vector.add(vector.at(positions, joint), centre), mass)
            legs += mass
    return moment, total, legs


@inner_kernel
def hold_ends(body, start, end, weight, goals, ways, knees, root_m, rotations, positions, orientations):
    """Feet, neck, head and hands where they belong at this weight, whatever the pelvis. In place.

    Returns how far limits keep either hand off its way, by how much the pelvis would sink for either foot, metres, and
    how far an ankle is bent up beyond its limit, radians.
    """
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    first, last = leg_lengths(start.positions), leg_lengths(end.positions)
    lengths = (first[0] + weight * (last[0] - first[0]), first[1] + weight * (last[1] - first[1]))
    sunk_m = hold_feet(body, goals, lengths, knees, weight, root_m, rotations, positions, orientations)
    bent_rad = 0.0
    for side in range(2):
        if goals.bound[side]:
            bounds = bounds_between(body, start.rotations, end.rotations, weight, side)
            left_rad = keep_leg(body, bounds, goals.bears[side], side, rotations, positions, orientations)
            bent_rad = max(bent_rad, goals.bears[side] * left_rad)
        else:
            slerp_foot(body, start, end, weight, side, rotations, positions, orientations)
        if goals.bears[side] < 1.0:
            ease_hip(body, start, end, weight, side, goals.bears[side], rotations, positions, orientations)
            ease_ankle(body, start, end, weight, side, goals.bears[side], rotations, positions, orientations)
    neck_m = vector.mix(vector.at(start.positions, NECK), vector.at(end.positions, NECK), weight)
    hold_neck(body, neck_m, root_m, rotations, positions, orientations)
    ease_waist(body, start, end, weight, root_m, rotations, positions, orientations)
    slerp_head(body, start, end, weight, rotations, orientations)
    left_m = follow_way(body, start, end, weight, 0, ways, rotations, positions, orientations)
    right_m = follow_way(body, start, end, weight, 1, ways, rotations, positions, orientations)
    return (left_m, right_m), sunk_m, bent_rad


@inner_kernel
def ease_waist(body, start, end, weight, root_m, rotations, positions, orientations):
    """Draws a waist that the neck's line bends too far back to where it goes; the neck stays behind. In place."""
    q, changed = within_limits(
        body, WAIST, start.rotations[WAIST], end.rotations[WAIST], weight, rotations[WAIST], BEYOND_RAD
    )
    if changed:
        quaternion.put(rotations, WAIST, q)
        joints_into(body.offset_m, root_m, rotations, positions, orientations)


@inner_kernel
def slerp_foot(body, start, end, weight, side, rotations, positions, orientations):
    """Turns a foot that nothing holds to the slerp of its two orientations in the world. In place."""
    ankle = ANKLES[side]
    turned = quaternion.slerp(start.orientations[ankle], end.orientations[ankle], weight)
    turn_end_to(body.offset_m, rotations, positions, orientations, KNEES[side], ankle, turned, TOES[side])


@inner_kernel
def ease_hip(body, start, end, weight, side, bears, rotations, positions, orientations):
    """Draws the hip of a leg in the air back to where it goes, the sole as it was; the less, the more its foot bears.
    The foot stays behind its plan. In place.
    """
    hip, knee, ankle = HIPS[side], KNEES[side], ANKLES[side]
    q, changed = within_limits(body, hip, start.rotations[hip], end.rotations[hip], weight, rotations[hip], BEYOND_RAD)
    if changed:
        turned = quaternion.at(orientations, ankle)
        quaternion.put(rotations, hip, quaternion.slerp(q, quaternion.at(rotations, hip), bears))
        place_children(body.offset_m, rotations, positions, orientations, PELVIS, hip)
        place_children(body.offset_m, rotations, positions, orientations, hip, knee)
        place_children(body.offset_m, rotations, positions, orientations, knee, ankle)
        turn_end_to(body.offset_m, rotations, positions, orientations, knee, ankle, turned, TOES[side])


@inner_kernel
def ease_ankle(body, start, end, weight, side, bears, rotations, positions, orientations):
    """Turns a foot in the air back to where its ankle goes; the less, the more it bears. In place."""
    ankle = ANKLES[side]
    q, changed = within_limits(
        body, ankle, start.rotations[ankle], end.rotations[ankle], weight, rotations[ankle], BEYOND_RAD
    )
    if changed:
        eased = quaternion.slerp(q, quaternion.at(rotations, ankle), bears)
        turned = quaternion.multiply(quaternion.at(orientations, KNEES[side]), eased)
        turn_end_to(body.offset_m, rotations, positions, orientations, KNEES[side], ankle, turned, TOES[side])


@inner_kernel
def slerp_head(body, start, end, weight, rotations, orientations):
    """Turns the head to the slerp of its two orientations in the world, whatever the trunk does below, as far as it
    goes. In place.
    """
    turned = quaternion.slerp(start.orientations[HEAD], end.orientations[HEAD], weight)
    below = quaternion.at(orientations, NECK)
    local = quaternion.normalise(quaternion.multiply(quaternion.conjugate(below), turned))
    local = within_limits(body, HEAD, start.rotations[HEAD], end.rotations[HEAD], weight, local, BEYOND_RAD)[0]
    quaternion.put(rotations, HEAD, local)
    quaternion.put(orientations, HEAD, quaternion.multiply(below, local))
