"""The transitional blend mechanism (thesis 4.3): from one still pose to another, balanced, feet held, hands on
straight lines.

First pass: a chain rooted at the primary support foot, that foot eased along a line, every rotation slerped, the
hands on straight lines by arm IK with the swivel angle interpolated. Second pass: the pelvis is moved until the COM
is on the straight line between its two ends, the feet held by leg IK, the head's orientation slerped; then the arms
once more, since moving the pelvis moved the shoulders.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from behaviours.clearing import bring_arms, clear_arms, depths_at, let_be, overrun_between
from behaviours.overlap import ARM_CAPSULES, PAIRS
from behaviours.timing import ease
from engine.body import limits
from engine.body.kinematics import centre_of_mass, joints_into
from engine.body.limb_ik import CARRIED, KEEP, apply_arm, apply_leg, arm_swivel, leg_swivel, side_sign
from engine.body.skeleton import (
    ANKLES,
    BACK,
    ELBOWS,
    HEAD,
    HIPS,
    JOINT_COUNT,
    KNEES,
    NECK,
    PELVIS,
    SHOULDERS,
    TOES,
    WRISTS,
)
from engine.body.two_bones import soft_reach
from engine.maths import quaternion, vector

COM_PASSES = 5  # each closes about nine tenths of what is missing: the legs stay behind when the pelvis moves
COM_GAIN = 1.12
LEG_SOFT_M = 0.010  # a leg straightens over this length, instead of snapping straight
LYING_LEG, STANDING_LEG = 0.2, 0.5  # hip over ankle in shares of the leg: it lies, or it may be standing
LEG_SPARE_M = 0.0005  # and stays this much short of it, but where its own motion has it straighter
# (share of the slerped arm's way, bow): straight; straight, but with the slerped arm's elbow; ever more the slerped
# arm's way, with a negative share the shoulder mixed by components; then bowed out, metres, ahead and aside, round
# the trunk
ARC_WAYS = np.array([
    (0.0, 0.0), (1e-3, 0.0), (-1e-3, 0.0), (0.25, 0.0), (-0.25, 0.0),
    (0.5, 0.0), (-0.5, 0.0), (0.75, 0.0), (1.0, 0.0), (-1.0, 0.0),
    (1e-3, 0.12), (-1e-3, 0.12), (0.5, 0.12), (-0.5, 0.12), (1.0, 0.12),
    (1e-3, 0.24), (-1e-3, 0.24), (0.5, 0.24), (1.0, 0.24),
])  # fmt: skip
BOW_AHEAD, BOW_ASIDE = 0.8, 0.6
ARC_SAMPLES = 16
ARC_STRIDE_M = 0.15  # an elbow that goes farther than this from one sample to the next turns over
ARC_LIMIT_RAD = 0.005  # a line on which the shoulder goes this far beyond its limits, or
ARC_DEPTH_M = 0.05  # the arm lies this deep in the body, is no line to follow
ARC_LEVER_M = 0.3  # this much too deep is as bad as a radian beyond the limits


class FootGoals(NamedTuple):
    """Where the two feet are to be while the rest of the body blends."""

    ankle_m: np.ndarray  # (2, 3) world
    turned: np.ndarray  # (2, 4) ankle orientation, world
    toe: np.ndarray  # (2, 4) toe rotation, in the ankle's frame
    bound: np.ndarray  # (2,) bool: False lets that foot go with the pose
    bears: np.ndarray  # (2,) 0 to 1: how far the body goes down for that foot; one in the air is left behind instead


class BlendEnd(NamedTuple):
    """One still end of a blend, and what the passes read off it."""

    root_m: np.ndarray  # (3,)
    rotations: np.ndarray  # (J, 4)
    positions: np.ndarray  # (J, 3) world
    orientations: np.ndarray  # (J, 4) world
    com_m: tuple[float, float, float]
    depths_m: np.ndarray  # (P,) how deep arms are in the body, see `behaviours.overlap`


@njit(cache=True)
def blend_end(body, capsules, root_m, rotations):
    """A pose with its joints in the world and its COM."""
    positions = np.empty((JOINT_COUNT, 3))
    orientations = np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    depths = np.empty(len(PAIRS))
    depths_at(capsules, positions, orientations, depths)
    com_m = centre_of_mass(body, positions, orientations)
    return BlendEnd(root_m, rotations, positions, orientations, com_m, depths)


@njit(cache=True)
def primary_support(planted, ankles_m, com_m):
    """The planted foot nearest to the projected COM; of two lifted feet, the nearest of both. Side 0 or 1."""
    best, nearest = 0, np.inf
    for side in range(2):
        away = math.hypot(ankles_m[side][0] - com_m[0], ankles_m[side][1] - com_m[1])
        if not planted[side] and (planted[0] or planted[1]):
            continue
        if away < nearest:
            best, nearest = side, away
    return best


@njit(cache=True)
def mix_joint(joint, first, last, weight, by_components):
    """A joint between two rotations: slerped; elbow, wrist and knee component by component.

    Slerp would take an elbow sideways from one forearm twist to another, farther than any elbow goes. A shoulder too
    may be better off so: from one twist to a far one slerp turns it the shorter way round, through twists that no
    shoulder has.
    """
    if by_components or joint in ELBOWS or joint in WRISTS or joint in KNEES:
        return limits.mix(first, last, weight)
    return quaternion.slerp(first, last, weight)


@njit(cache=True)
def slerp_from_support(body, start, end, weight, support, arcs, root_m, rotations, positions, orientations):
    """First pass: every joint slerped, and the pelvis placed so that the support foot goes straight from end to end."""
    for j in range(JOINT_COUNT):
        by_components = (j == SHOULDERS[0] and arcs[0, 0] < 0.0) or (j == SHOULDERS[1] and arcs[1, 0] < 0.0)
        q = mix_joint(j, start.rotations[j], end.rotations[j], weight, by_components)
        rotations[j, 0], rotations[j, 1], rotations[j, 2], rotations[j, 3] = q
    root_m[:] = 0.0
    rotations[PELVIS, 0], rotations[PELVIS, 1], rotations[PELVIS, 2], rotations[PELVIS, 3] = quaternion.IDENTITY
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    ankle = ANKLES[support]
    foot_turned = quaternion.slerp(start.orientations[ankle], end.orientations[ankle], weight)
    foot_m = vector.mix(start.positions[ankle], end.positions[ankle], weight)
    pelvis_turned = quaternion.normalise(quaternion.multiply(foot_turned, quaternion.conjugate(orientations[ankle])))
    pelvis_m = vector.subtract(foot_m, quaternion.rotate(pelvis_turned, positions[ankle]))
    for k in range(3):
        root_m[k] = pelvis_m[k]
    for k in range(4):
        rotations[PELVIS, k] = pelvis_turned[k]
    joints_into(body.offset_m, root_m, rotations, positions, orientations)


@njit(cache=True)
def leg_lengths(positions):
    """(left, right): from hip to ankle, metres."""
    return (
        vector.distance(positions[HIPS[0]], positions[ANKLES[0]]),
        vector.distance(positions[HIPS[1]], positions[ANKLES[1]]),
    )


@njit(cache=True)
def legs_to(body, root_m, rotations, ankle_m):
    """(left, right): how far it is from a pose's hips to two places (2, 3), metres."""
    positions = np.empty((JOINT_COUNT, 3))
    joints_into(body.offset_m, root_m, rotations, positions, np.empty((JOINT_COUNT, 4)))
    return vector.distance(positions[HIPS[0]], ankle_m[0]), vector.distance(positions[HIPS[1]], ankle_m[1])


@njit(cache=True)
def bend_toe(toe, rotations, side):
    """Gives a toe its planned rotation (2, 4), in place; the leg's IK carries it into the world."""
    for k in range(4):
        rotations[TOES[side], k] = toe[side, k]


@njit(cache=True)
def hold_feet(body, goals, own_lengths, knee_swivels, root_m, rotations, positions, orientations):
    """Leg IK onto the goals of both feet; lowers the pelvis first where a goal is out of a leg's reach. In place.

    `own_lengths` (2,): how long the legs would be without any goal, see `drop_beyond_own`. `knee_swivels` (2,)
    radians, as `engine.body.limb_ik.leg_swivel` measures them.
    """
    drop = 0.0
    for side in range(2):
        if goals.bound[side]:
            need = drop_beyond_own(body, positions[HIPS[side]], goals.ankle_m[side], side, own_lengths[side])
            drop = max(drop, goals.bears[side] * need)
    if drop > 0.0:
        root_m[2] -= drop
        for j in range(JOINT_COUNT):
            positions[j, 2] -= drop
    for side in range(2):
        if goals.bound[side]:
            bend_toe(goals.toe, rotations, side)
            apply_leg(
                body,
                rotations,
                positions,
                orientations,
                side,
                goals.ankle_m[side],
                goals.turned[side],
                knee_swivels[side],
                LEG_SOFT_M * (1.0 - goals.bears[side]),
            )


@njit(cache=True)
def drop_beyond_own(body, hip_m, ankle_m, side, own_length_m):
    """How far the hip has to sink to keep the ankle in the leg's reach, metres.

    It begins before the leg is straight and never lets it get quite there, so that the knee does not snap; a leg that
    is as long as its own motion has it asks for nothing, however straight that is. Where the foot stands farther off
    sideways than the leg is long, sinking helps no further: as far as it does. A leg that lies bears nothing, and no
    sinking could help it.
    """
    full = vector.length(body.offset_m[KNEES[side]]) + vector.length(body.offset_m[ANKLES[side]])
    wanted = vector.distance(hip_m, ankle_m)
    reach = soft_reach(wanted, own_length_m, max(full - LEG_SPARE_M, own_length_m), LEG_SOFT_M)
    if reach >= wanted:
        return 0.0
    across = math.hypot(hip_m[0] - ankle_m[0], hip_m[1] - ankle_m[1])
    upright = ease(((hip_m[2] - ankle_m[2]) / full - LYING_LEG) / (STANDING_LEG - LYING_LEG))
    return upright * max(0.0, hip_m[2] - ankle_m[2] - math.sqrt(max(reach * reach - across * across, 0.0)))


@njit(cache=True)
def leg_lengths_between(start, end, weight):
    """(left, right): from hip to ankle on the way, metres."""
    first, last = leg_lengths(start.positions), leg_lengths(end.positions)
    return (first[0] + weight * (last[0] - first[0]), first[1] + weight * (last[1] - first[1]))


@njit(cache=True)
def move_com(body, start, end, weight, goals, root_m, rotations, positions, orientations):
    """Second pass: shifts the pelvis until the COM is on its straight line, the feet held (thesis 4.3). In place."""
    wanted_m = vector.mix(start.com_m, end.com_m, weight)
    swivels, lengths = knee_swivels_between(start, end, weight), leg_lengths_between(start, end, weight)
    for _ in range(COM_PASSES):
        com = centre_of_mass(body, positions, orientations)
        for k in range(3):
            root_m[k] += COM_GAIN * (wanted_m[k] - com[k])
        joints_into(body.offset_m, root_m, rotations, positions, orientations)
        hold_feet(body, goals, lengths, swivels, root_m, rotations, positions, orientations)


@njit(cache=True)
def slerp_head(start, end, weight, rotations, positions, orientations):
    """Turns the head to the slerp of its two orientations in the world, whatever the trunk does below. In place."""
    turned = quaternion.slerp(start.orientations[HEAD], end.orientations[HEAD], weight)
    local = quaternion.normalise(quaternion.multiply(quaternion.conjugate(orientations[NECK]), turned))
    for k in range(4):
        rotations[HEAD, k] = local[k]
        orientations[HEAD, k] = turned[k]


@njit(cache=True)
def mix_angle(first_rad, last_rad, weight):
    """An angle on the shorter way round from the first to the last."""
    way = (last_rad - first_rad + math.pi) % (2.0 * math.pi) - math.pi
    return first_rad + weight * way


@njit(cache=True)
def arms_between(body, start, end, weight, arcs, rotations, positions, orientations):
    """Both arms on their way from end to end (thesis 4.3), in place. Returns where their wrists are to be, (2, 3).

    The hand goes straight, the swivel angle is interpolated. With a share `arcs` (2, 2) that is not 0 the hand goes
    by that much on the way that slerping the arm takes it, and the elbow is left where that has it. The arms come
    here slerped. The second of `arcs` bows the way out by so many metres at its middle.
    """
    targets = np.empty((2, 3))
    for side in range(2):
        wrist, arc = WRISTS[side], abs(arcs[side, 0])
        line = vector.mix(start.positions[wrist], end.positions[wrist], weight)
        first = arm_swivel(start.positions, start.orientations, side, CARRIED)
        last = arm_swivel(end.positions, end.orientations, side, CARRIED)
        swivel = mix_angle(first, last, weight) if arc == 0.0 else KEEP
        line = vector.mix(line, positions[wrist], arc)
        out = quaternion.rotate(orientations[BACK], (BOW_AHEAD, BOW_ASIDE * side_sign(side), 0.0))
        line = vector.along(line, out, 4.0 * weight * (1.0 - weight) * arcs[side, 1])
        targets[side, 0], targets[side, 1], targets[side, 2] = line
        apply_arm(body, rotations, positions, orientations, side, line, swivel, CARRIED)
    return targets


@njit(cache=True)
def knee_swivels_between(start, end, weight):
    """Both knees' swivel angles on the way, the shorter way round: (2,) radians."""
    first = leg_swivel(start.positions, start.orientations, 0), leg_swivel(start.positions, start.orientations, 1)
    last = leg_swivel(end.positions, end.orientations, 0), leg_swivel(end.positions, end.orientations, 1)
    return mix_angle(first[0], last[0], weight), mix_angle(first[1], last[1], weight)


@njit(cache=True)
def blend_trunk_and_legs(body, start, end, weight, support, goals, arcs, root_m, rotations, positions, orientations):
    """Both passes but for the last word on the arms, which are left as slerped. In place."""
    slerp_from_support(body, start, end, weight, support, arcs, root_m, rotations, positions, orientations)
    swivels, lengths = knee_swivels_between(start, end, weight), leg_lengths_between(start, end, weight)
    hold_feet(body, goals, lengths, swivels, root_m, rotations, positions, orientations)
    slerped = rotations.copy()
    arms_between(body, start, end, weight, arcs, rotations, positions, orientations)
    move_com(body, start, end, weight, goals, root_m, rotations, positions, orientations)
    slerp_head(start, end, weight, rotations, positions, orientations)
    for side in range(2):
        for joint in (SHOULDERS[side], ELBOWS[side], WRISTS[side]):
            rotations[joint] = slerped[joint]
    joints_into(body.offset_m, root_m, rotations, positions, orientations)


@njit(cache=True)
def blend_into(body, capsules, start, end, weight, support, goals, arcs, root_m, rotations):
    """The pose a weight (already eased, 0 to 1) of the way from one end to the other. Writes root_m (3,) and
    rotations (J, 4).

    arcs (2, 2): see `arms_between`. Returns how far either hand was led off its way to go round the body, metres.
    """
    positions = np.empty((JOINT_COUNT, 3))
    orientations = np.empty((JOINT_COUNT, 4))
    blend_trunk_and_legs(body, start, end, weight, support, goals, arcs, root_m, rotations, positions, orientations)
    # the shoulders have moved: the arms once more, and where they now are in the way
    targets = arms_between(body, start, end, weight, arcs, rotations, positions, orientations)
    allowed = np.empty(len(start.depths_m))
    let_be(start.depths_m, end.depths_m, weight, allowed)
    led = clear_arms(body, capsules, allowed, targets, rotations, positions, orientations)
    # arms that go round take the COM along: once more
    move_com(body, start, end, weight, goals, root_m, rotations, positions, orientations)
    bring_arms(body, targets, np.zeros(2), rotations, positions, orientations)
    return led


@njit(cache=True)
def arm_trouble(body, capsules, start, end, weight, side, rotations, positions, orientations):
    """What is wrong with an arm on the way: radians beyond its shoulder's limits, and metres too deep in the body."""
    joint = SHOULDERS[side]
    beyond = overrun_between(body, joint, start.rotations[joint], end.rotations[joint], rotations[joint])
    depths, allowed, deepest = np.empty(len(PAIRS)), np.empty(len(PAIRS)), 0.0
    depths_at(capsules, positions, orientations, depths)
    let_be(start.depths_m, end.depths_m, weight, allowed)
    for n in range(len(PAIRS)):
        # the other arm's way is not yet known: hands are kept apart as they go
        if ARM_CAPSULES[PAIRS[n, 0], 0] == side and ARM_CAPSULES[PAIRS[n, 1], 0] < 0:
            deepest = max(deepest, depths[n] - allowed[n])
    return beyond, deepest


@njit(cache=True)
def choose_arcs(body, capsules, start, end, support, goals):
    """How each hand goes, (2, 2), one of ARC_WAYS: the first, a straight line, unless that is no way for an arm.

    A line that leads deep through the body, or where the shoulder cannot follow, is bent towards the way that
    slerping the arm takes, or round the trunk: by the first way that is good enough, else by the one that leaves
    least wrong.
    """
    arcs, least = np.zeros((2, 2)), np.full(2, np.inf)
    found = np.zeros(2, np.bool_)
    root_m, rotations = np.empty(3), np.empty((JOINT_COUNT, 4))
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    for way in range(len(ARC_WAYS)):
        both, worst, elbows_m = np.empty((2, 2)), np.zeros(2), np.empty((2, 3))
        both[:] = ARC_WAYS[way]
        for k in range(ARC_SAMPLES + 1):
            weight = k / ARC_SAMPLES
            blend_trunk_and_legs(
                body, start, end, weight, support, goals, both, root_m, rotations, positions, orientations
            )
            arms_between(body, start, end, weight, both, rotations, positions, orientations)
            for side in range(2):
                beyond, deep = arm_trouble(body, capsules, start, end, weight, side, rotations, positions, orientations)
                wrong = max(0.0, beyond - ARC_LIMIT_RAD) + max(0.0, deep - ARC_DEPTH_M) / ARC_LEVER_M
                elbow = vector.subtract(positions[ELBOWS[side]], positions[PELVIS])
                if k > 0:
                    wrong += max(0.0, vector.distance(elbow, elbows_m[side]) - ARC_STRIDE_M) / ARC_LEVER_M
                for axis in range(3):
                    elbows_m[side, axis] = elbow[axis]
                worst[side] = max(worst[side], wrong)
        for side in range(2):
            if not found[side] and worst[side] < least[side]:
                least[side] = worst[side]
                arcs[side, 0], arcs[side, 1] = ARC_WAYS[way, 0], ARC_WAYS[way, 1]
                found[side] = worst[side] == 0.0
        if found[0] and found[1]:
            break
    return arcs
