"""Arms and legs put where they are wanted: `engine.body.two_bones` applied to the skeleton, in place.

The pose is given as three consistent arrays, rotations (J, 4) local to parents, positions (J, 3) and orientations (J,
4) in the world; what hangs on the limb is kept up to date. Swivels are radians, positive away from the body on both
sides.
"""

from __future__ import annotations

import math

from engine.body.skeleton import ANKLES, CLAVICLES, ELBOWS, HIPS, KNEES, PELVIS, SHOULDERS, TOES, WRISTS
from engine.body.two_bones import KEEP, SOFT_REACH_M, carried_zero, solve_limb, swivel_of
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

__all__ = [
    "CARRIED", "DOWN", "KEEP", "SOFT_REACH_M", "apply_arm", "apply_leg", "arm_onto", "arm_swivel", "arm_zero",
    "elbow_axis", "knee_axis", "knee_zero", "leg_onto", "leg_swivel", "place_children", "side_sign", "turn_end_to",
    "turn_hand_to",
]  # fmt: skip

# what an arm's swivel is measured from
DOWN, CARRIED = 0, 1


@inner_kernel
def place_children(offset_m, rotations, positions, orientations, joint, child):
    """Forward kinematics of one joint from its parent: writes the child's position and orientation."""
    turned = quaternion.at(orientations, joint)
    bone = quaternion.rotate(turned, vector.at(offset_m, child))
    vector.put(positions, child, vector.add(vector.at(positions, joint), bone))
    quaternion.put(orientations, child, quaternion.multiply(turned, quaternion.at(rotations, child)))


@inner_kernel
def turn_end_to(offset_m, rotations, positions, orientations, parent, joint, world_orientation, child):
    """Gives a wrist or ankle a world orientation: its local rotation, and the toe (child, or -1) that hangs on it."""
    turned = quaternion.normalise(world_orientation)
    local = quaternion.multiply(quaternion.conjugate(quaternion.at(orientations, parent)), turned)
    quaternion.put(orientations, joint, turned)
    quaternion.put(rotations, joint, quaternion.normalise(local))
    if child >= 0:
        place_children(offset_m, rotations, positions, orientations, joint, child)


@njit(cache=True)
def _apply(offset_m, rotations, positions, orientations, parent, upper, middle, end, limb, lower):
    """Writes both turns back: local rotations of upper and middle joint, positions and orientations down to the end."""
    _turn_local(rotations, orientations, parent, upper, limb)
    _turn_local(rotations, orientations, upper, middle, lower)
    turned = quaternion.multiply(quaternion.at(orientations, parent), quaternion.at(rotations, upper))
    quaternion.put(orientations, upper, quaternion.normalise(turned))
    place_children(offset_m, rotations, positions, orientations, upper, middle)
    place_children(offset_m, rotations, positions, orientations, middle, end)


@inner_kernel
def _turn_local(rotations, orientations, parent, joint, world_turn):
    """local = conj(P) T P * local: a world turn T about the joint, seen from its parent. No turn, no change."""
    outer = quaternion.at(orientations, parent)
    seen = quaternion.multiply(quaternion.multiply(quaternion.conjugate(outer), world_turn), outer)
    local = quaternion.multiply(seen, quaternion.at(rotations, joint))
    quaternion.put(rotations, joint, quaternion.normalise(local))


@inner_kernel
def elbow_axis(orientations, side):
    """The elbow's world axis of flexion: -Y of the upper arm."""
    return quaternion.rotate(quaternion.at(orientations, SHOULDERS[side]), (0.0, -1.0, 0.0))


@inner_kernel
def knee_axis(orientations, side):
    """The knee's world axis of flexion: +Y of the thigh."""
    return quaternion.rotate(quaternion.at(orientations, HIPS[side]), (0.0, 1.0, 0.0))


@njit(cache=True)
def arm_zero(orientations, side, reference, n):
    """Where the elbow points at swivel 0 for an arm along unit n; world.

    DOWN (spec A3): -Z of the clavicle. Turns over when the arm swings through hanging or straight up: fit for poses.
    CARRIED: the same in the plane straight ahead (back for a hanging arm, down for one held forward, forward for one
    held up), carried elsewhere; it turns over only behind and above the shoulder, where no arm goes: fit for blends.
    """
    clavicle = quaternion.at(orientations, CLAVICLES[side])
    if reference == DOWN:
        return quaternion.rotate(clavicle, (0.0, 0.0, -1.0))
    h = math.sqrt(0.5)
    return carried_zero(quaternion.rotate(clavicle, (h, 0.0, -h)), quaternion.rotate(clavicle, (-h, 0.0, -h)), n)


@njit(cache=True)
def knee_zero(orientations, n):
    """Where the knee points at swivel 0 for a leg along unit n; world: the pelvis's forward axis, carried there.

    A fixed forward axis would turn over in a kick or a high knee, when the thigh comes to lie along it; the foot's own
    axis does when the heel comes up. Carried from straight down, it is forward for a standing or a spread leg, up for
    one held forward, down for one held back, and turns over only for a leg straight up.
    """
    pelvis = quaternion.at(orientations, PELVIS)
    return carried_zero(quaternion.rotate(pelvis, (0.0, 0.0, -1.0)), quaternion.rotate(pelvis, (1.0, 0.0, 0.0)), n)


@inner_kernel
def side_sign(side):
    """+1 left, -1 right."""
    return 1.0 - 2.0 * side


@njit(cache=True)
def arm_swivel(positions, orientations, side, reference=DOWN):
    """The swivel of an arm as it is now, radians, positive away from the body."""
    root, end = vector.at(positions, SHOULDERS[side]), vector.at(positions, WRISTS[side])
    n = vector.unit(vector.subtract(end, root), (0.0, 0.0, -1.0))
    zero = arm_zero(orientations, side, reference, n)
    mid, axis = vector.at(positions, ELBOWS[side]), elbow_axis(orientations, side)
    return swivel_of(root, mid, end, axis, zero, side_sign(side))


@njit(cache=True)
def leg_swivel(positions, orientations, side):
    """The swivel of a leg as it is now, radians, positive away from the other leg."""
    root, mid, end = (
        vector.at(positions, HIPS[side]),
        vector.at(positions, KNEES[side]),
        vector.at(positions, ANKLES[side]),
    )
    n = vector.unit(vector.subtract(end, root), (0.0, 0.0, -1.0))
    return swivel_of(root, mid, end, knee_axis(orientations, side), knee_zero(orientations, n), side_sign(side))


@njit(cache=True)
def apply_arm(
    body, rotations, positions, orientations, side, target_m, swivel_rad, reference=DOWN, soft_m=SOFT_REACH_M
):
    """Puts a wrist on a world target with the elbow at a swivel (KEEP: where the least swing leaves it).

    rotations (J, 4), positions (J, 3), orientations (J, 4) of one pose, consistent, are updated in place from the
    shoulder down; the hand stays as it is on the forearm. Returns how far the wrist misses, metres. soft_m 0: exact up
    to full length.
    """
    return arm_onto(
        body.offset_m, -body.limit_low_rad[ELBOWS[side], 1], rotations, positions, orientations, side,
        (target_m[0], target_m[1], target_m[2]), swivel_rad, reference, soft_m,
    )  # fmt: skip


@inner_kernel
def arm_onto(offset_m, greatest_rad, rotations, positions, orientations, side, target, swivel_rad, reference, soft_m):
    """apply_arm for hot kernels that cannot hand a whole body on; greatest_rad is the most the elbow flexes."""
    shoulder, elbow, wrist = SHOULDERS[side], ELBOWS[side], WRISTS[side]
    root = vector.at(positions, shoulder)
    n = vector.unit(vector.subtract(target, root), (0.0, 0.0, -1.0))
    limb, lower, miss_m = solve_limb(
        root, vector.at(positions, elbow), vector.at(positions, wrist), elbow_axis(orientations, side), target,
        arm_zero(orientations, side, reference, n), swivel_rad, side_sign(side), greatest_rad, soft_m,
    )  # fmt: skip
    _apply(offset_m, rotations, positions, orientations, CLAVICLES[side], shoulder, elbow, wrist, limb, lower)
    return miss_m


@njit(cache=True)
def apply_leg(
    body, rotations, positions, orientations, side, target_m, foot_orientation, swivel_rad, soft_m=SOFT_REACH_M
):
    """Puts an ankle on a world target, the foot at a world orientation, the knee at a swivel (KEEP: moved least).

    Arrays as in apply_arm, updated in place from the hip down to the toe. Returns how far the ankle misses, metres.
    """
    return leg_onto(
        body.offset_m, body.limit_high_rad[KNEES[side], 1], rotations, positions, orientations, side,
        (target_m[0], target_m[1], target_m[2]), foot_orientation, swivel_rad, soft_m,
    )  # fmt: skip


@inner_kernel
def leg_onto(
    offset_m, greatest_rad, rotations, positions, orientations, side, target, foot_orientation, swivel_rad, soft_m
):
    """apply_leg for hot kernels, see arm_onto: greatest_rad is the most the knee flexes."""
    hip, knee, ankle = HIPS[side], KNEES[side], ANKLES[side]
    root = vector.at(positions, hip)
    foot = (foot_orientation[0], foot_orientation[1], foot_orientation[2], foot_orientation[3])
    n = vector.unit(vector.subtract(target, root), (0.0, 0.0, -1.0))
    limb, lower, miss_m = solve_limb(
        root, vector.at(positions, knee), vector.at(positions, ankle), knee_axis(orientations, side), target,
        knee_zero(orientations, n), swivel_rad, side_sign(side), greatest_rad, soft_m,
    )  # fmt: skip
    _apply(offset_m, rotations, positions, orientations, PELVIS, hip, knee, ankle, limb, lower)
    turn_end_to(offset_m, rotations, positions, orientations, knee, ankle, foot, TOES[side])
    return miss_m


@inner_kernel
def turn_hand_to(body, rotations, positions, orientations, side, world_orientation):
    """Gives a hand a world orientation, in place."""
    turn_end_to(body.offset_m, rotations, positions, orientations, ELBOWS[side], WRISTS[side], world_orientation, -1)
