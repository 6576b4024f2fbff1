"""What a seam has left over, on the feet where they have to be, and on legs that are within their limits (thesis 4.3).

An old motion's pelvis runs on over feet that are held: its hips and ankles would go farther than any go. So some of
what is left of the pelvis's motion is taken away; and what even that leaves, as an old foot's own turn, is met by heels
that rise and knees that swing aside.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.blends.held_feet import LEG_SOFT_M, drop_beyond_own
from behaviours.blends.leg_limits import EARLY_RAD, GIVE_RAD, bounds_over, free_knee, raise_heel
from engine.body.kinematics import joints_into
from engine.body.limb_ik import apply_leg, leg_swivel
from engine.body.limits import components
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, PELVIS
from engine.maths import quaternion
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

HALVINGS = 8  # and one straight line: how much of a pelvis's residual is taken, to a hair


class Footing(NamedTuple):
    """What the legs of a pose with a residual are held to."""

    source_m: np.ndarray  # (3,), (J, 4) the pose without the residual
    source: np.ndarray
    beyond: np.ndarray  # (J, 3) what is left of how far the old motion was beyond its limits drawn in by EARLY_RAD
    ankle_m: np.ndarray  # (2, 3), (2, 4) where the feet are to be, world
    turned: np.ndarray
    bears: np.ndarray  # (2,) 0 to 1
    own_lengths: tuple[float, float]  # the legs' in the source, and what is left of the last seam's


@njit(cache=True)
def stand(body, footing, root_m, rotations):
    """Puts the legs of a pose (3,), (J, 4) with a residual on their feet, hips and ankles within their limits; beyond
    those is let be what the source is, and what is left of how far the old motion was. In place.

    Of the pelvis's residual that share is taken away which is as great as the joints are then crowded: so a pelvis
    that runs into a limit is slowed down, not stopped dead, and has nothing left where it would pass one.
    """
    early = bounds_of(body, footing, EARLY_RAD)
    first_m, first = root_m.copy(), rotations.copy()
    low, high, at_low, at_high = 0.0, 1.0, 0.0, -1.0
    for n in range(HALVINGS + 2):
        taken = low
        if n == HALVINGS + 1:
            taken = low + (high - low) * at_low / max(at_low - at_high, 1e-12)
        elif n > 0:
            taken = 0.5 * (low + high)
        stand_without(body, footing, first_m, first, taken, root_m, rotations)
        more = crowding(footing, early, rotations) - taken
        if n == 0 and more <= 0.0:
            break
        if more > 0.0:
            low, at_low = taken, more
        else:
            high, at_high = taken, more
    give_way(body, footing, root_m, rotations)


@inner_kernel
def bounds_of(body, footing, give_rad):
    """The bounds of both legs."""
    return (
        bounds_over(body, footing.source, footing.beyond, 0, give_rad),
        bounds_over(body, footing.source, footing.beyond, 1, give_rad),
    )


@njit(cache=True)
def stand_without(body, footing, first_m, first, taken, root_m, rotations):
    """Writes the pose (3,), (J, 4) that a first one becomes, on its feet, without a share of its pelvis's residual."""
    for k in range(3):
        root_m[k] = first_m[k] + taken * (footing.source_m[k] - first_m[k])
    for j in range(JOINT_COUNT):
        quaternion.put(rotations, j, quaternion.at(first, j))
    quaternion.put(rotations, PELVIS, quaternion.slerp(first[PELVIS], footing.source[PELVIS], taken))
    stand_on(body, footing, root_m, rotations)


@njit(cache=True)
def stand_on(body, footing, root_m, rotations):
    """Leg IK of both legs onto their ankles' goals, in place. The knees stay where the least swing leaves them.

    The pelvis sinks by what the residual has put out of reach, beyond `own_lengths`. So a residual that is nothing
    changes nothing, and one that has just begun neither.
    """
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    drop = 0.0
    for side in range(2):
        need = drop_beyond_own(body, positions[HIPS[side]], footing.ankle_m[side], side, footing.own_lengths[side])
        drop = max(drop, footing.bears[side] * need)
    root_m[2] -= drop
    for j in range(JOINT_COUNT):
        positions[j, 2] -= drop
    for side in range(2):
        swivel, soft_m = leg_swivel(positions, orientations, side), LEG_SOFT_M * (1.0 - footing.bears[side])
        apply_leg(
            body, rotations, positions, orientations, side, footing.ankle_m[side], footing.turned[side], swivel, soft_m
        )


@inner_kernel
def crowding(footing, early, rotations):
    """How far hips and ankles are into the last EARLY_RAD before their limits: the sum of the squares of their shares
    of it; the less, the less their foot bears.
    """
    total = 0.0
    for side in range(2):
        hip, ankle, b = components(rotations[HIPS[side]]), components(rotations[ANKLES[side]]), early[side]
        for k in range(3):
            x = max(hip[k] - b.hip_high[k], b.hip_low[k] - hip[k], 0.0) / EARLY_RAD
            y = max(ankle[k] - b.ankle_high[k], b.ankle_low[k] - ankle[k], 0.0) / EARLY_RAD
            total += footing.bears[side] * (x * x + y * y)
    return total


@inner_kernel
def give_way(body, footing, root_m, rotations):
    """Raises the heels of feet that bear, and swings their knees aside, as far as they must, in place."""
    bounds = bounds_of(body, footing, GIVE_RAD)
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    for side in range(2):
        raise_heel(body, bounds[side], footing.bears[side], side, rotations, positions, orientations)
        free_knee(body, bounds[side], footing.bears[side], side, rotations, positions, orientations)
