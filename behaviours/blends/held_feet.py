"""Feet that stay where they are bound while the body above moves (thesis 4.3): leg IK, and a pelvis that sinks."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.timing import ease
from engine.body.kinematics import joints_into
from engine.body.limb_ik import apply_leg, knee_zero, leg_swivel, side_sign
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, KNEES, TOES
from engine.body.two_bones import soft_reach
from engine.maths import springs, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

LEG_SOFT_M = 0.010  # a leg straightens over this length, instead of snapping straight; one in the air,
AIR_SOFT_M = 0.006  # whose foot may stay behind, over a few times this, before and after its goal is out of reach
LYING_LEG, STANDING_LEG = 0.2, 0.5  # hip over ankle in shares of the leg: it lies, or it may be standing
UNDECIDED_M = 1e-4  # a knee this near to the line from hip to ankle points nowhere
LEG_SPARE_M = 0.0005  # a leg stays this much short of it, but where its own motion has it straighter
LEAST_ROOM_M = 2e-5  # a leg is slowed down over no less: one as straight as that keeps its velocity at a seam


class FootGoals(NamedTuple):
    """Where the two feet are to be while the rest of the body blends."""

    ankle_m: np.ndarray  # (2, 3) world
    turned: np.ndarray  # (2, 4) ankle orientation, world
    toe: np.ndarray  # (2, 4) toe rotation, in the ankle's frame
    bound: np.ndarray  # (2,) bool: False lets that foot go with the pose
    bears: np.ndarray  # (2,) 0 to 1: how far the body goes down for that foot; one in the air is left behind instead


class Knees(NamedTuple):
    """How the knees go, both sides of a blend's two ends, left first."""

    first_rad: tuple[float, float]  # their swivels at either end, as `engine.body.limb_ik.leg_swivel` measures them
    last_rad: tuple[float, float]
    least: bool  # the thesis's rule: they move the least since the last frame, instead of from end to end
    before_m: np.ndarray  # (2, 3) where they were then, world


@njit(cache=True)
def knees_between(start, end, least, before_m):
    """The knees of a blend from one pose to another; `start` and `end` as `behaviours.blends.blending.BlendEnd`."""
    return Knees(
        (leg_swivel(start.positions, start.orientations, 0), leg_swivel(start.positions, start.orientations, 1)),
        (leg_swivel(end.positions, end.orientations, 0), leg_swivel(end.positions, end.orientations, 1)),
        least,
        before_m,
    )


@inner_kernel
def swivel_at(knees, weight, side, ankle_m, positions, orientations):
    """A knee's swivel on the way, radians: between those of the ends, the shorter way round; or, with the thesis's rule
    (4.3), where the circle on which the knee can be comes nearest to where it was a frame ago.
    """
    if knees.least:
        hip = vector.at(positions, HIPS[side])
        n = vector.unit(vector.subtract((ankle_m[0], ankle_m[1], ankle_m[2]), hip), (0.0, 0.0, -1.0))
        pointing = vector.reject(vector.subtract(vector.at(knees.before_m, side), hip), n)
        if vector.length(pointing) > UNDECIDED_M:
            zero = vector.reject(knee_zero(orientations, n), n)
            around = vector.inner(n, vector.cross(zero, pointing))
            return side_sign(side) * math.atan2(around, vector.inner(zero, pointing))
    return mix_angle(knees.first_rad[side], knees.last_rad[side], weight)


@inner_kernel
def mix_angle(first_rad, last_rad, weight):
    """An angle on the shorter way round from the first to the last."""
    way = (last_rad - first_rad + math.pi) % (2.0 * math.pi) - math.pi
    return first_rad + weight * way


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
def lengths_left(body, source_m, stretch, elapsed_s, half_life_s):
    """(left, right): how long the legs of a source are, with what is left of the last seam's stretch, metres.

    source_m (2,): in the source; stretch (2, 2): by how much the old motion's were longer at the seam, metres, then how
    fast that grew, m/s. See `braked`: a residual's speed carries on, but does not carry a leg straight.
    """
    return (
        _length_left(body, 0, source_m[0], stretch[0, 0], stretch[1, 0], elapsed_s, half_life_s),
        _length_left(body, 1, source_m[1], stretch[0, 1], stretch[1, 1], elapsed_s, half_life_s),
    )


@inner_kernel
def _length_left(body, side, source_m, stretch_m, stretch_mps, elapsed_s, half_life_s):
    length_m = source_m + springs.decaying(stretch_m, stretch_mps, half_life_s, elapsed_s)[0]
    old_m = source_m + springs.decaying(max(stretch_m, 0.0), 0.0, half_life_s, elapsed_s)[0]
    return braked(length_m, old_m, leg_full_m(body, side))


@njit(cache=True)
def kept_bent(body, lengths_m):
    """(left, right): legs' lengths as they are, but none straighter than LEG_SPARE_M short of straight, metres."""
    return (
        min(lengths_m[0], leg_full_m(body, 0) - LEG_SPARE_M),
        min(lengths_m[1], leg_full_m(body, 1) - LEG_SPARE_M),
    )


@inner_kernel
def leg_full_m(body, side):
    """From hip to ankle of a straight leg, metres."""
    return vector.length(vector.at(body.offset_m, KNEES[side])) + vector.length(vector.at(body.offset_m, ANKLES[side]))


@njit(cache=True)
def braked(length_m, own_m, full_m):
    """A leg's length, slowed down smoothly before it is straight, or from `own_m` on, if that is straighter already.

    The knee of a straight leg, once let go, leaves at a speed without bounds: its bend grows as the root of what the
    leg is short of its full length. From LEG_SOFT_M before, the length nears LEG_SPARE_M short of it, or half of what
    is left, exponentially: with slope 1 at first, so that a seam there keeps its velocity.
    """
    begins_m = max(own_m, full_m - LEG_SPARE_M - LEG_SOFT_M)
    left_m = full_m - begins_m
    room_m = max(left_m - LEG_SPARE_M, 0.5 * left_m, LEAST_ROOM_M)
    if length_m <= begins_m:
        return length_m
    return begins_m + room_m * (1.0 - math.exp((begins_m - length_m) / room_m))


@inner_kernel
def bend_toe(toe, rotations, side):
    """Gives a toe its planned rotation (2, 4), in place; the leg's IK carries it into the world."""
    for k in range(4):
        rotations[TOES[side], k] = toe[side, k]


@njit(cache=True)
def hold_feet(body, goals, own_lengths, knees, weight, root_m, rotations, positions, orientations):
    """Leg IK onto the goals of both feet; lowers the pelvis first where a goal is out of a leg's reach. In place.

    `own_lengths` (2,): how long the legs would be without any goal, see `drop_beyond_own`. `knees` at a weight of
    their way. Returns by how much the pelvis would be lowered for either foot; it is by the greater, metres.
    """
    left_m = drop_for(body, goals, 0, own_lengths[0], positions)
    right_m = drop_for(body, goals, 1, own_lengths[1], positions)
    drop = max(left_m, right_m)
    if drop > 0.0:
        root_m[2] -= drop
        for j in range(JOINT_COUNT):
            positions[j, 2] -= drop
    for side in range(2):
        if goals.bound[side]:
            bend_toe(goals.toe, rotations, side)
            swivel = swivel_at(knees, weight, side, goals.ankle_m[side], positions, orientations)
            target = reachable(body, vector.at(positions, HIPS[side]), goals.ankle_m[side], side, goals.bears[side])
            apply_leg(body, rotations, positions, orientations, side, target, goals.turned[side], swivel, 0.0)
    return left_m, right_m


@inner_kernel
def drop_for(body, goals, side, own_length_m, positions):
    """How far the hips have to sink for one foot, metres; the less, the less it bears."""
    if not goals.bound[side]:
        return 0.0
    need_m = drop_beyond_own(body, positions[HIPS[side]], goals.ankle_m[side], side, own_length_m)
    return goals.bears[side] * need_m


@njit(cache=True)
def reachable(body, hip_m, ankle_m, side, bears):
    """Where an ankle goes that is wanted at a place: there if its foot bears; else the nearer to the leg's full length,
    the more it falls short, so that a knee neither snaps straight nor out of being straight.
    """
    wanted = vector.subtract(vector.at(ankle_m.reshape(1, 3), 0), hip_m)
    far, soft = vector.length(wanted), AIR_SOFT_M * (1.0 - bears)
    full = vector.length(vector.at(body.offset_m, KNEES[side])) + vector.length(vector.at(body.offset_m, ANKLES[side]))
    if soft <= 1e-9 or far < 0.5 * full:
        return vector.add(hip_m, wanted)
    spare = (full - far) / soft
    short = soft * (math.log1p(math.exp(-abs(spare))) + max(spare, 0.0))
    return vector.along(hip_m, wanted, (full - short) / far)


@inner_kernel
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
