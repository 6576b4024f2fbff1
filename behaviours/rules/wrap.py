"""A threat from behind the shoulders (Hermens 2006, 3.4, fig. 3.11): hands behind the head, elbows around its sides.

Wherever exactly it comes from: what cannot be seen is not aimed at.
"""

from __future__ import annotations

import math

from behaviours.rules.block import smooth_max
from engine.body.skeleton import LEFT
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


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
def guarded_head(head, towards_threat, group):
    """The head's orientation, turned so that its back follows the threat a little: where the hands are put around it.

    Between a threat that comes straight at the back of the head and one from aside the hands go round with it.
    """
    back = quaternion.rotate(head, (-1.0, 0.0, 0.0))
    axis = vector.cross(back, towards_threat)
    sine = vector.length(axis)
    axis = vector.unit(axis, (0.0, 0.0, 1.0))
    return quaternion.multiply(quaternion.from_axis_angle(axis, group.follow_rad * sine), head)


@inner_kernel
def wrapped_palm(side, head_centre, guarded, apart_m, group):
    """Where one palm centre goes, in the world: on the back of the head, to its own side.

    guarded: see guarded_head; apart_m: from the head's axis to the hand's, where they touch.
    """
    outward = 1.0 if side == LEFT else -1.0
    away = apart_m + group.palm_gap_m
    x, y = -away * math.cos(group.palm_aside_rad), outward * away * math.sin(group.palm_aside_rad)
    return vector.add(head_centre, quaternion.rotate(guarded, (x, y, -group.palm_below_m)))


@inner_kernel
def wrapped_hand(side, guarded, group):
    """Palm normal and fingers of one hand (two unit vectors, world): palm on the head, fingers up and inwards."""
    outward = 1.0 if side == LEFT else -1.0
    cosine, sine = math.cos(group.palm_aside_rad), outward * math.sin(group.palm_aside_rad)
    inwards, up = math.sin(group.fingers_inward_rad), math.cos(group.fingers_inward_rad)
    fingers = (-inwards * outward * sine, -inwards * outward * cosine, up)
    return quaternion.rotate(guarded, (cosine, -sine, 0.0)), quaternion.rotate(guarded, fingers)


@inner_kernel
def elbow_direction(side, group):
    """Where one elbow points, in the chest's frame: ahead, around the side of the head."""
    outward = 1.0 if side == LEFT else -1.0
    return (math.cos(group.elbow_aside_rad), outward * math.sin(group.elbow_aside_rad), 0.0)


@njit(cache=True)
def around_head(palm, head_centre, least_m):
    """A palm on its way from front to back goes around the head: pushed out to at least this far from its centre."""
    from_centre = vector.subtract(palm, head_centre)
    away = vector.length(from_centre)
    outward = vector.unit(from_centre, (0.0, 0.0, 1.0))
    return vector.along(head_centre, outward, smooth_max(away, least_m, 0.01))
