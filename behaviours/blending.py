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

from engine.body import limits
from engine.body.footing import drop_to_reach
from engine.body.kinematics import centre_of_mass, joints_into
from engine.body.limb_ik import CARRIED, apply_arm, apply_leg, arm_swivel, leg_swivel
from engine.body.skeleton import ANKLES, ELBOWS, HEAD, HIPS, JOINT_COUNT, NECK, PELVIS, WRISTS
from engine.maths import quaternion, vector

COM_PASSES = 5  # each closes about nine tenths of what is missing: the legs stay behind when the pelvis moves
COM_GAIN = 1.12


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


@njit(cache=True)
def blend_end(body, root_m, rotations):
    """A pose with its joints in the world and its COM."""
    positions = np.empty((JOINT_COUNT, 3))
    orientations = np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    return BlendEnd(root_m, rotations, positions, orientations, centre_of_mass(body, positions, orientations))


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
def slerp_from_support(body, start, end, weight, support, root_m, rotations, positions, orientations):
    """First pass: every joint slerped, and the pelvis placed so that the support foot goes straight from end to end.

    Elbows and wrists go component by component: slerp would take an elbow sideways from one forearm twist to another.
    """
    for j in range(JOINT_COUNT):
        if j == ELBOWS[0] or j == ELBOWS[1] or j == WRISTS[0] or j == WRISTS[1]:
            q = limits.mix(start.rotations[j], end.rotations[j], weight)
        else:
            q = quaternion.slerp(start.rotations[j], end.rotations[j], weight)
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
def hold_feet(body, goals, knee_swivels, root_m, rotations, positions, orientations):
    """Leg IK onto the goals of both feet; lowers the pelvis first where a goal is out of a leg's reach. In place.

    `knee_swivels` (2,) radians, as `engine.body.limb_ik.leg_swivel` measures them.
    """
    drop = 0.0
    for side in range(2):
        if goals.bound[side]:
            drop = max(drop, drop_to_reach(body, positions[HIPS[side]], goals.ankle_m[side], side))
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
def move_com(body, com_wanted_m, goals, knee_swivels, root_m, rotations, positions, orientations):
    """Second pass: shifts the pelvis until the COM is where it is wanted, the feet held (thesis 4.3). In place."""
    for _ in range(COM_PASSES):
        com = centre_of_mass(body, positions, orientations)
        for k in range(3):
            shift = COM_GAIN * (com_wanted_m[k] - com[k])
            root_m[k] += shift
        joints_into(body.offset_m, root_m, rotations, positions, orientations)
        hold_feet(body, goals, knee_swivels, root_m, rotations, positions, orientations)


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
def carry_hands(body, start, end, weight, rotations, positions, orientations):
    """Each hand on the straight line between its two ends, the elbow's swivel angle interpolated (thesis 4.3). In place."""
    for side in range(2):
        wrist = WRISTS[side]
        hand_m = vector.mix(start.positions[wrist], end.positions[wrist], weight)
        first = arm_swivel(start.positions, start.orientations, side, CARRIED)
        last = arm_swivel(end.positions, end.orientations, side, CARRIED)
        swivel = mix_angle(first, last, weight)
        apply_arm(body, rotations, positions, orientations, side, hand_m, swivel, CARRIED)


@njit(cache=True)
def knee_swivels_between(start, end, weight):
    """Both knees' swivel angles on the way, the shorter way round: (2,) radians."""
    first = leg_swivel(start.positions, start.orientations, 0), leg_swivel(start.positions, start.orientations, 1)
    last = leg_swivel(end.positions, end.orientations, 0), leg_swivel(end.positions, end.orientations, 1)
    return mix_angle(first[0], last[0], weight), mix_angle(first[1], last[1], weight)


@njit(cache=True)
def blend_into(body, start, end, weight, support, goals, root_m, rotations):
    """The pose a weight (already eased, 0 to 1) of the way from one end to the other. Writes root_m (3,) and rotations (J, 4)."""
    positions = np.empty((JOINT_COUNT, 3))
    orientations = np.empty((JOINT_COUNT, 4))
    slerp_from_support(body, start, end, weight, support, root_m, rotations, positions, orientations)
    swivels = knee_swivels_between(start, end, weight)
    hold_feet(body, goals, swivels, root_m, rotations, positions, orientations)
    carry_hands(body, start, end, weight, rotations, positions, orientations)
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    move_com(body, vector.mix(start.com_m, end.com_m, weight), goals, swivels, root_m, rotations, positions, orientations)
    slerp_head(start, end, weight, rotations, positions, orientations)
    carry_hands(body, start, end, weight, rotations, positions, orientations)
