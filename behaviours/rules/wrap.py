"""A threat from behind the shoulders (Hermens 2006, 3.4, fig. 3.11): hands behind the head, elbows around its sides.

Wherever exactly it comes from: what cannot be seen is not aimed at.
"""

from __future__ import annotations

import math

from numba import njit

from behaviours.rules.block import smooth_max
from engine.body.skeleton import LEFT
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel


@njit(cache=True)
def wrap_share(torso_x, towards_threat, group):
    """How much the arms wrap instead of block, 0 to 1: by the dot of the chest's facing, after turning, and the threat.

    Between the two settings both are mixed, smoothly, so that a sweep of the threat around the body makes no hand jump.
    """
    facing = vector.inner(torso_x, towards_threat)
    share = (group.behind_high - facing) / max(group.behind_high - group.behind_low, 1e-9)
    share = min(1.0, max(0.0, share))
    return share * share * (3.0 - 2.0 * share)


@inner_kernel
def wrapped_palm(side, head_centre, head, apart_m, group):
    """Where one palm centre goes: behind the head, in the world. `head` is the head's orientation; apart_m
    from the head's middle to the hand's, where they touch."""
    outward = 1.0 if side == LEFT else -1.0
    behind = -(apart_m + group.palm_gap_m)
    return vector.add(head_centre, quaternion.rotate(head, (behind, outward * group.palm_apart_m, -group.palm_below_m)))


@inner_kernel
def wrapped_hand(side, head, group):
    """Palm normal and fingers of one hand (two unit vectors, world): palm on the head, fingers up and inwards."""
    inward = -1.0 if side == LEFT else 1.0
    fingers = (0.0, inward * math.sin(group.fingers_inward_rad), math.cos(group.fingers_inward_rad))
    return quaternion.rotate(head, (1.0, 0.0, 0.0)), quaternion.rotate(head, fingers)


@njit(cache=True)
def around_head(palm, head_centre, least_m):
    """A palm on its way from front to back goes around the head: pushed out to at least this far from its centre."""
    from_centre = vector.subtract(palm, head_centre)
    away = vector.length(from_centre)
    outward = vector.unit(from_centre, (0.0, 0.0, 1.0))
    return vector.along(head_centre, outward, smooth_max(away, least_m, 0.01))
