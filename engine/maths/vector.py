"""Three-vectors for kernels: tuples in, tuples out, nothing allocated."""

from __future__ import annotations

import math

from engine.maths.kernel import njit


@njit(cache=True)
def at(rows, row):
    """One row of an array (N, 3) as a tuple. In a kernel `rows[row]` would be a view: counted, a type of its own."""
    return (rows[row, 0], rows[row, 1], rows[row, 2])


@njit(cache=True)
def put(rows, row, a):
    """Writes one row of an array (N, 3)."""
    rows[row, 0] = a[0]
    rows[row, 1] = a[1]
    rows[row, 2] = a[2]


@njit(cache=True)
def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@njit(cache=True)
def subtract(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@njit(cache=True)
def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


@njit(cache=True)
def along(a, direction, distance):
    """The point at a distance from a in a direction."""
    return (a[0] + direction[0] * distance, a[1] + direction[1] * distance, a[2] + direction[2] * distance)


@njit(cache=True)
def mix(a, b, weight):
    """Linear interpolation: weight 0 gives a, 1 gives b."""
    return (a[0] + (b[0] - a[0]) * weight, a[1] + (b[1] - a[1]) * weight, a[2] + (b[2] - a[2]) * weight)


@njit(cache=True)
def inner(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True)
def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@njit(cache=True)
def length(a):
    return math.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


@njit(cache=True)
def distance(a, b):
    return math.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


@njit(cache=True)
def unit(a, otherwise):
    """a at length one; `otherwise` where a is too short to have a direction."""
    n = length(a)
    if n < 1e-9:
        return (otherwise[0] * 1.0, otherwise[1] * 1.0, otherwise[2] * 1.0)
    return (a[0] / n, a[1] / n, a[2] / n)


@njit(cache=True)
def reject(a, direction):
    """The part of a at right angles to a unit direction."""
    return along(a, direction, -inner(a, direction))
