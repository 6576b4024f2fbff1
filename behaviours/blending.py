"""The transitional blend mechanism (thesis 4.3): from one still pose to another, balanced, feet held, hands on straight lines.

First pass: a chain rooted at the primary support foot, that foot eased along a line, every rotation slerped, the hands on
straight lines by arm IK with the swivel angle interpolated. Second pass: the pelvis is moved until the COM is on the
straight line between its two ends, the feet held by leg IK, the head's orientation slerped; then the arms once more,
since moving the pelvis moved the shoulders.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from behaviours.clearing import allowed_swivel, clear_arms, depths_at, let_be, slerped_swivel
from behaviours.overlap import PAIRS
from behaviours.timing import ease
from engine.body import limits
from engine.body.kinematics import centre_of_mass, joints_into
from engine.body.limb_ik import CARRIED, apply_leg, arm_swivel, leg_swivel
from engine.body.skeleton import ANKLES, ELBOWS, HEAD, HIPS, JOINT_COUNT, KNEES, NECK, PELVIS, SHOULDERS, WRISTS
from engine.body.two_bones import soft_reach
from engine.maths import quaternion, vector

COM_PASSES = 5  # each closes about nine tenths of what is missing: the legs stay behind when the pelvis moves
COM_GAIN = 1.12
LEG_SOFT_M = 0.010  # a leg straightens over this length, instead of snapping straight
LYING_LEG, STANDING_LEG = 0.2, 0.5  # hip over ankle in shares of the leg: it lies, or it may be standing
LEG_SPARE_M = 0.0005  # and stays this much short of it, but where its own motion has it straighter


class FootGoals(NamedTuple):
    """Where the two feet are to be while the rest of the body blends."""

    ankle_m: np.ndarray  # (2, 3) world
    turned: np.ndarray  # (2, 4) ankle orientation, world
    bound: np.ndarray  # (2,) bool: False lets that foot go with the pose


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
def mix_joint(joint, first, last, weight):
    """A joint between two rotations: slerped; elbow, wrist and knee component by component.

    Slerp would take an elbow sideways from one forearm twist to another, farther than any elbow goes.
    """
    if joint in ELBOWS or joint in WRISTS or joint in KNEES:
        return limits.mix(first, last, weight)
    return quaternion.slerp(first, last, weight)


@njit(cache=True)
def slerp_from_support(body, start, end, weight, support, root_m, rotations, positions, orientations):
    """First pass: every joint slerped, and the pelvis placed so that the support foot goes straight from end to end."""
    for j in range(JOINT_COUNT):
        q = mix_joint(j, start.rotations[j], end.rotations[j], weight)
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
def hold_feet(body, goals, own_lengths, knee_swivels, root_m, rotations, positions, orientations):
    """Leg IK onto the goals of both feet; lowers the pelvis first where a goal is out of a leg's reach. In place.

    `own_lengths` (2,): how long the legs would be without any goal, see `drop_beyond_own`. `knee_swivels` (2,) radians, as
    `engine.body.limb_ik.leg_swivel` measures them.
    """
    drop = 0.0
    for side in range(2):
        if goals.bound[side]:
            drop = max(drop, drop_beyond_own(body, positions[HIPS[side]], goals.ankle_m[side], side, own_lengths[side]))
    if drop > 0.0:
        root_m[2] -= drop
        for j in range(JOINT_COUNT):
            positions[j, 2] -= drop
    for side in range(2):
        if goals.bound[side]:
            apply_leg(
                body,
                rotations,
                positions,
                orientations,
                side,
                goals.ankle_m[side],
                goals.turned[side],
                knee_swivels[side],
                0.0,
            )


@njit(cache=True)
def drop_beyond_own(body, hip_m, ankle_m, side, own_length_m):
    """How far the hip has to sink to keep the ankle in the leg's reach, metres.

    It begins before the leg is straight and never lets it get quite there, so that the knee does not snap; a leg that is
    as long as its own motion has it asks for nothing, however straight that is. Where the foot stands farther off sideways than the
    leg is long, sinking helps no further: as far as it does. A leg that lies bears nothing, and no sinking could help it.
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
def move_com(body, com_wanted_m, goals, own_lengths, knee_swivels, root_m, rotations, positions, orientations):
    """Second pass: shifts the pelvis until the COM is where it is wanted, the feet held (thesis 4.3). In place."""
    for _ in range(COM_PASSES):
        com = centre_of_mass(body, positions, orientations)
        for k in range(3):
            shift = COM_GAIN * (com_wanted_m[k] - com[k])
            root_m[k] += shift
        joints_into(body.offset_m, root_m, rotations, positions, orientations)
        hold_feet(body, goals, own_lengths, knee_swivels, root_m, rotations, positions, orientations)


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
def hands_between(start, end, weight):
    """Both wrists on the straight lines between their ends, the elbows' swivel angles interpolated (thesis 4.3): (2, 3), (2,)."""
    targets, swivels = np.empty((2, 3)), np.empty(2)
    for side in range(2):
        hand_m = vector.mix(start.positions[WRISTS[side]], end.positions[WRISTS[side]], weight)
        targets[side, 0], targets[side, 1], targets[side, 2] = hand_m
        first = arm_swivel(start.positions, start.orientations, side, CARRIED)
        last = arm_swivel(end.positions, end.orientations, side, CARRIED)
        swivels[side] = mix_angle(first, last, weight)
    return targets, swivels


@njit(cache=True)
def carry_hands(body, start, end, weight, targets_m, swivels, rotations, positions, orientations):
    """Each wrist onto its target, the elbow as its swivel says or as near to it as the shoulder allows. In place."""
    for side in range(2):
        joint = SHOULDERS[side]
        slerped = slerped_swivel(body, positions, orientations, rotations, side, targets_m[side])
        swivels[side] = allowed_swivel(
            body, side, start.rotations[joint], end.rotations[joint], targets_m[side], swivels[side], slerped,
            rotations, positions, orientations,
        )  # fmt: skip


@njit(cache=True)
def knee_swivels_between(start, end, weight):
    """Both knees' swivel angles on the way, the shorter way round: (2,) radians."""
    first = leg_swivel(start.positions, start.orientations, 0), leg_swivel(start.positions, start.orientations, 1)
    last = leg_swivel(end.positions, end.orientations, 0), leg_swivel(end.positions, end.orientations, 1)
    return mix_angle(first[0], last[0], weight), mix_angle(first[1], last[1], weight)


@njit(cache=True)
def blend_into(body, capsules, start, end, weight, support, goals, root_m, rotations):
    """The pose a weight (already eased, 0 to 1) of the way from one end to the other. Writes root_m (3,) and rotations (J, 4).

    Returns how far either hand was led off its straight line to go round the body: (left, right), metres.
    """
    positions = np.empty((JOINT_COUNT, 3))
    orientations = np.empty((JOINT_COUNT, 4))
    slerp_from_support(body, start, end, weight, support, root_m, rotations, positions, orientations)
    swivels = knee_swivels_between(start, end, weight)
    first, last = leg_lengths(start.positions), leg_lengths(end.positions)
    lengths = (first[0] + weight * (last[0] - first[0]), first[1] + weight * (last[1] - first[1]))
    hold_feet(body, goals, lengths, swivels, root_m, rotations, positions, orientations)
    targets, elbows = hands_between(start, end, weight)
    slerped = rotations.copy()
    carry_hands(body, start, end, weight, targets, elbows, rotations, positions, orientations)
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    com_wanted = vector.mix(start.com_m, end.com_m, weight)
    move_com(body, com_wanted, goals, lengths, swivels, root_m, rotations, positions, orientations)
    slerp_head(start, end, weight, rotations, positions, orientations)
    # the shoulders have moved: the arms once more, from what slerping alone had made of them
    for side in range(2):
        for joint in (SHOULDERS[side], ELBOWS[side], WRISTS[side]):
            rotations[joint] = slerped[joint]
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    targets, elbows = hands_between(start, end, weight)
    carry_hands(body, start, end, weight, targets, elbows, rotations, positions, orientations)
    allowed = np.empty(len(start.depths_m))
    let_be(start.depths_m, end.depths_m, weight, allowed)
    return clear_arms(body, capsules, allowed, targets, elbows, rotations, positions, orientations)
