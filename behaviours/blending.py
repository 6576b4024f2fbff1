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

from behaviours.clearing import bring_arms, clear_arms, depths_at, let_be
from behaviours.held_feet import hold_feet, leg_lengths
from behaviours.overlap import PAIRS
from engine.body import limits
from engine.body.kinematics import centre_of_mass, joints_into
from engine.body.limb_ik import CARRIED, KEEP, apply_arm, arm_swivel, leg_swivel, side_sign
from engine.body.skeleton import (
    ANKLES,
    BACK,
    ELBOWS,
    HEAD,
    JOINT_COUNT,
    KNEES,
    NECK,
    PELVIS,
    SHOULDERS,
    WRISTS,
)
from engine.maths import quaternion, vector

COM_PASSES = 5  # each closes about nine tenths of what is missing: the legs stay behind when the pelvis moves
COM_GAIN = 1.12
BOW_AHEAD, BOW_ASIDE = 0.8, 0.6


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
