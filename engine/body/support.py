"""The support polygon: the convex hull of the ground contacts of the planted feet, and how far inside it a point lies.

Plan view: polygons are (m, 2) world X, Y in metres, counter-clockwise, m = 0 (nothing planted) to 12; one foot on its
tiptoes may leave a line (m = 2) or a point (m = 1).
"""

from __future__ import annotations

import math

import numpy as np

from engine.body.skeleton import ANKLES, SOLE_POINTS, TOES
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

CONTACT_M = 0.03  # a sole point this much above its foot's lowest one still bears: flesh gives way, and clips are noisy
_FIRST_TOE_POINT = SOLE_POINTS.index("toe_inner")
_POINTS = len(SOLE_POINTS)


@njit(cache=True)
def sole_points(body, positions, orientations):
    """(2, 6, 3) the sole points of both feet in the world."""
    out = np.empty((2, _POINTS, 3))
    for side in range(2):
        for k in range(_POINTS):
            joint = ANKLES[side] if k < _FIRST_TOE_POINT else TOES[side]
            p = vector.add(positions[joint], quaternion.rotate(orientations[joint], body.sole_m[side, k]))
            out[side, k, 0], out[side, k, 1], out[side, k, 2] = p
    return out


@inner_kernel
def bearing(points):
    """(6,) of one foot's sole points (6, 3): which bear when the foot is planted."""
    lowest = math.inf
    for k in range(len(points)):
        lowest = min(lowest, points[k, 2])
    out = np.empty(len(points), np.bool_)
    for k in range(len(points)):
        out[k] = points[k, 2] <= lowest + CONTACT_M
    return out


@njit(cache=True)
def polygon_of(body, positions, orientations, planted):
    """The support polygon (m, 2) of the feet that are planted (2,): the hull of their bearing sole points."""
    points = sole_points(body, positions, orientations)
    ground = np.empty((2 * _POINTS, 2))
    count = 0
    for side in range(2):
        if planted[side]:
            bears = bearing(points[side])
            for k in range(_POINTS):
                if bears[k]:
                    ground[count, 0], ground[count, 1] = points[side, k, 0], points[side, k, 1]
                    count += 1
    return hull(ground[:count])


@inner_kernel
def _sorted_by_x(points):
    """Rows by X, then Y, equal ones once."""
    rows = np.empty((len(points), 2))
    count = 0
    for p in range(len(points)):
        x, y = points[p, 0], points[p, 1]
        k = count
        while k > 0 and (rows[k - 1, 0] > x or (rows[k - 1, 0] == x and rows[k - 1, 1] > y)):
            k -= 1
        if k > 0 and rows[k - 1, 0] == x and rows[k - 1, 1] == y:
            continue
        for m in range(count, k, -1):
            rows[m, 0], rows[m, 1] = rows[m - 1, 0], rows[m - 1, 1]
        rows[k, 0], rows[k, 1] = x, y
        count += 1
    return rows[:count]


@njit(cache=True)
def _turn(a, b, c):
    """Twice the area of the triangle a b c: positive where the way turns left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


@inner_kernel
def _extend(chain, first, m, point):
    """Adds a point to the chain, dropping those since `first` that are corners no longer. Returns its new length."""
    while m >= first + 2 and _turn(chain[m - 2], chain[m - 1], point) <= 0.0:
        m -= 1
    chain[m, 0], chain[m, 1] = point[0], point[1]
    return m + 1


@njit(cache=True)
def hull(points):
    """The convex hull (m, 2) of points (n, 2), counter-clockwise, no point twice, none on an edge (Andrew 1979)."""
    rows = _sorted_by_x(points)
    n = len(rows)
    if n < 3:
        return rows
    chain = np.empty((2 * n, 2))
    m = 0
    for k in range(n):  # the lower edge, left to right
        m = _extend(chain, 0, m, rows[k])
    first = m - 1
    for k in range(n - 2, -1, -1):  # and the upper one back
        m = _extend(chain, first, m, rows[k])
    return chain[: m - 1]


@inner_kernel
def _on_segment(a, b, p):
    """The point of segment a b that is nearest to p."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    square = dx * dx + dy * dy
    t = 0.0
    if square > 0.0:
        t = min(max(((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / square, 0.0), 1.0)
    return (a[0] + t * dx, a[1] + t * dy)


@inner_kernel
def nearest_on_edge(polygon, point):
    """The point of the polygon's edge that is nearest to a point (2,); ValueError for an empty polygon."""
    if len(polygon) == 0:
        raise ValueError("an empty polygon has no edge")
    best, best_m = (polygon[0, 0], polygon[0, 1]), math.inf
    for k in range(len(polygon)):
        q = _on_segment(polygon[k - 1], polygon[k], point)
        distance = math.hypot(q[0] - point[0], q[1] - point[1])
        if distance < best_m:
            best, best_m = q, distance
    return best


@njit(cache=True)
def inside(polygon, point):
    """Whether a point lies in the polygon or on its edge; never in a point or a line."""
    if len(polygon) < 3:
        return False
    for k in range(len(polygon)):  # noqa: SIM110 - kernels know no generators
        if _turn(polygon[k - 1], polygon[k], point) < 0.0:
            return False
    return True


@njit(cache=True)
def margin_m(polygon, point):
    """Distance to the polygon's edge: positive inside, negative outside; -inf where nothing is planted."""
    if len(polygon) == 0:
        return -math.inf
    edge = nearest_on_edge(polygon, point)
    distance = math.hypot(edge[0] - point[0], edge[1] - point[1])
    return distance if inside(polygon, point) else -distance
