"""Feet on the ground: where an ankle has to be for a flat sole, how near a foot can be put, and stepping there."""

from __future__ import annotations

import math

from engine.body import support
from engine.body.skeleton import ANKLES, HIPS, KNEES
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

LEG_SOFT_M = 0.006  # a leg straightens over this length, instead of snapping straight


@njit(cache=True)
def sole_depth_m(body, side):
    """How far the sole lies below the ankle joint of a flat foot."""
    return -body.sole_m[side, 0, 2]


@njit(cache=True)
def flat_orientation(heading_rad):
    """The world orientation of a foot that stands flat and points along a heading."""
    return quaternion.about_z(heading_rad)


@njit(cache=True)
def foot_heading(orientations, side):
    """Where a foot points, radians about world Z: at right angles to its Y axis, so that pitch does not matter.

    A runner's trailing foot hangs past the vertical, and its X axis points backwards; its Y axis stays where it was.
    """
    across = quaternion.rotate(orientations[ANKLES[side]], (0.0, 1.0, 0.0))
    return math.atan2(-across[0], across[1])


@njit(cache=True)
def leg_length_m(body, side):
    """Hip to ankle of the straight leg."""
    return vector.length(body.offset_m[KNEES[side]]) + vector.length(body.offset_m[ANKLES[side]])


@inner_kernel
def drop_to_reach(body, hip_m, ankle_m, side):
    """How far the hip has to sink to keep the ankle in the leg's reach, metres.

    It begins a little before the leg is straight and never lets it get quite there, so that the knee does not snap.
    Where the foot stands farther off sideways than the leg is long, sinking helps no further: as far as it does.
    """
    full = leg_length_m(body, side)
    over = vector.distance(hip_m, ankle_m) - (full - LEG_SOFT_M)
    if over <= 0.0:
        return 0.0
    reach = full - LEG_SOFT_M * math.exp(-over / LEG_SOFT_M)
    across = math.hypot(hip_m[0] - ankle_m[0], hip_m[1] - ankle_m[1])
    return max(0.0, hip_m[2] - ankle_m[2] - math.sqrt(max(reach * reach - across * across, 0.0)))


@njit(cache=True)
def nearest_footing(body, positions, orientations, side, ground_m, spare_m):
    """Where to put a foot flat: straight below where it is, else the nearest ground that the leg reaches.

    spare_m: how much of the leg's length to leave unused. Returns (ankle target (3,), foot orientation (4,),
    reachable). Not reachable (the hip is too high): the target is straight below the hip, and is out of reach.
    """
    hip, ankle = positions[HIPS[side]], positions[ANKLES[side]]
    height = ground_m + sole_depth_m(body, side)
    orientation = flat_orientation(foot_heading(orientations, side))
    reach, drop = leg_length_m(body, side) - spare_m, hip[2] - height
    if drop > reach:
        return (hip[0], hip[1], height), orientation, False
    farthest = math.sqrt(reach * reach - drop * drop)
    dx, dy = ankle[0] - hip[0], ankle[1] - hip[1]
    away = math.hypot(dx, dy)
    share = min(1.0, farthest / away) if away > 1e-9 else 1.0
    return (hip[0] + share * dx, hip[1] + share * dy, height), orientation, True


@njit(cache=True)
def lowest_sole_m(body, positions, orientations):
    """World height of the lowest sole point of both feet."""
    return support.sole_points(body, positions, orientations)[:, :, 2].min()


@njit(cache=True)
def stepped(start_m, finish_m, share, lift_m):
    """An ankle on its way from one place to another, lifted on an arc: share in [0, 1]; at rest at both ends.

    Along the ground by ease-in ease-out, up by sin^2, so that it leaves and meets the ground without speed.
    """
    ease = share * share * (3.0 - 2.0 * share)
    x, y, z = vector.mix(start_m, finish_m, ease)
    up = math.sin(math.pi * share)
    return (x, y, z + lift_m * up * up)


@njit(cache=True)
def lowest_m(body, positions, orientations):
    """The height of whatever is lowest, soles or joints: what somebody stands, kneels or lies on."""
    return min(lowest_sole_m(body, positions, orientations), positions[:, 2].min())
