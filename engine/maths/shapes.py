"""Capsules and spheres: nearest points, and the first moment at which a moving sphere meets a moving capsule.

A capsule is all points within a radius of a segment. World metres; points are anything indexable, three long.
"""

from __future__ import annotations

import math

from engine.maths import vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

NO_HIT = -1.0
_TOUCH_M = 1e-9


@njit(cache=True)
def nearest_on_segment(start, end, point):
    """Where along the segment, 0 to 1, lies the place that is nearest to a point."""
    axis = vector.subtract(end, start)
    square = vector.inner(axis, axis)
    if square < 1e-18:
        return 0.0
    return min(max(vector.inner(vector.subtract(point, start), axis) / square, 0.0), 1.0)


@njit(cache=True)
def distance_to_segment(start, end, point):
    """Distance of a point from a segment."""
    return vector.distance(point, vector.mix(start, end, nearest_on_segment(start, end, point)))


@njit(cache=True)
def nearest_between(start, end, other_start, other_end):
    """Where along two segments, 0 to 1 each, they come nearest to each other (Ericson 2005, section 5.1.9)."""
    u, v = vector.subtract(end, start), vector.subtract(other_end, other_start)
    w = vector.subtract(start, other_start)
    a, b, c = vector.inner(u, u), vector.inner(u, v), vector.inner(v, v)
    d, e = vector.inner(u, w), vector.inner(v, w)
    slant = a * c - b * b
    s = min(max((b * e - c * d) / slant, 0.0), 1.0) if slant > 1e-12 * a * c else 0.0
    t = min(max((b * s + e) / c, 0.0), 1.0) if c > 1e-18 else 0.0
    s = min(max((b * t - d) / a, 0.0), 1.0) if a > 1e-18 else 0.0
    return s, t


@inner_kernel
def boxes_apart(start, end, other_start, other_end, distance):
    """Whether the boxes around two segments, along the axes, are farther apart than this: then so are the segments.

    Costs a fraction of their nearest points; most pairs of a body are settled by it.
    """
    for k in range(3):
        low, high = min(start[k], end[k]), max(start[k], end[k])
        if low - max(other_start[k], other_end[k]) > distance or min(other_start[k], other_end[k]) - high > distance:
            return True
    return False


@njit(cache=True)
def outwards(start, end, point):
    """The unit direction from a segment to a point; straight across the segment where the point lies on it."""
    q = vector.mix(start, end, nearest_on_segment(start, end, point))
    axis = vector.unit(vector.subtract(end, start), (0.0, 0.0, 1.0))
    aside = (1.0, 0.0, 0.0) if abs(axis[0]) < 0.9 else (0.0, 1.0, 0.0)
    return vector.unit(vector.subtract(point, q), vector.unit(vector.reject(aside, axis), aside))


@njit(cache=True)
def swept_sphere_capsule(centre0, centre1, start0, end0, start1, end1, radius_sum):
    """When, as a share of the tick, a sphere first meets a capsule; NO_HIT (-1) if it does not. All move evenly.

    centre0 -> centre1: the sphere's centre; start0, end0 -> start1, end1: the capsule's segment; radius_sum: both
    radii. A pair that overlaps at the beginning meets at 0 if it is approaching, and not at all if it is parting.
    Conservative advancement (Mirtich 1996, section 2.3): over a share s the distance cannot shrink by more than s times
    the greatest relative travel of any point of the segment, so steps of gap / travel never pass the first contact.
    """
    a, b = vector.subtract(centre0, start0), vector.subtract(centre1, start1)
    c, d = vector.subtract(centre0, end0), vector.subtract(centre1, end1)
    travel = max(vector.distance(a, b), vector.distance(c, d))
    gap = distance_to_segment(start0, end0, centre0) - radius_sum
    if gap <= _TOUCH_M:
        later = 1e-4
        soon = distance_to_segment(
            vector.mix(start0, start1, later), vector.mix(end0, end1, later), vector.mix(centre0, centre1, later)
        )
        return 0.0 if soon - radius_sum < gap else NO_HIT
    share = 0.0
    for _ in range(200):
        if gap > (1.0 - share) * travel:
            return NO_HIT
        share += gap / travel
        gap = (
            distance_to_segment(
                vector.mix(start0, start1, share), vector.mix(end0, end1, share), vector.mix(centre0, centre1, share)
            )
            - radius_sum
        )
        if gap <= _TOUCH_M:
            return min(share, 1.0)
    return share  # a glancing pass, nearer than a micrometre: steps have become too small to tell


@njit(cache=True)
def ray_capsule(origin, direction, start, end, radius, farthest_m):
    """Distance along a ray (unit direction) to a capsule, inf beyond `farthest_m`: what is under a cursor."""
    far = vector.along(origin, direction, farthest_m)
    share = swept_sphere_capsule(origin, far, start, end, start, end, radius)
    return math.inf if share < 0.0 else share * farthest_m
