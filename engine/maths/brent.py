"""Brent's line minimisation (Brent 1973; Press et al., *Numerical Recipes in C*, 10.1 and 10.2) that asks and is told.

As in `engine.maths.minimise`, the search never calls the function: whoever drives it evaluates at `trial` and tells the
value, so any kernel can use it. It first brackets a minimum from where it starts, between two bounds, then narrows
the bracket by parabolas through the three best points, or by golden sections where those do not help.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

GOLDEN = 0.5 * (3.0 - math.sqrt(5.0))  # share of the larger part that a golden section cuts off
GROWTH = 1.0 / GOLDEN - 1.0  # each step of the bracketing is this much longer

# phases
UP, DOWN, WALK, NARROW, DONE = range(5)
# slots of `numbers`: bounds; bracket; best, second and third point with their values; steps; the trial
LOW, HIGH, A, B, X, FX, W, FW, V, FV, STEP, STEP_BEFORE, TRIAL, REACH, WAY = range(15)


class Line(NamedTuple):
    """A line search under way."""

    numbers: np.ndarray  # (15,)
    counts: np.ndarray  # (2,) phase, evaluations


@njit(cache=True)
def new_line():
    return Line(np.zeros(15), np.zeros(2, np.int64))


@njit(cache=True)
def begin(line, start, value, step, low, high):
    """Starts at a point in [low, high] whose value is known, with a first step into each direction."""
    n = line.numbers
    n[LOW], n[HIGH] = low, high
    n[X] = n[W] = n[V] = start
    n[FX] = n[FW] = n[FV] = value
    n[REACH] = min(step, high - low)
    line.counts[0], line.counts[1] = UP, 0
    n[TRIAL] = min(start + n[REACH], high)
    if n[TRIAL] - start < 1e-12:
        _try_down(line)


@njit(cache=True)
def finished(line):
    return line.counts[0] == DONE


@njit(cache=True)
def tell(line, value, tolerance):
    """Takes the function's value at the trial point and sets the next one, or ends. tolerance: of the point's
    place.
    """
    line.counts[1] += 1
    phase = line.counts[0]
    if phase == NARROW:
        _narrowed(line, value)
        _next_trial(line, tolerance)
    elif phase == UP:
        _told_up(line, value, tolerance)
    elif phase == DOWN:
        _told_down(line, value, tolerance)
    else:
        _told_walk(line, value, tolerance)


@njit(cache=True)
def best(line):
    """The best point so far, and its value."""
    return line.numbers[X], line.numbers[FX]


@inner_kernel
def _told_up(line, value, tolerance):
    n = line.numbers
    if value < n[FX]:
        n[WAY] = 1.0
        _walk_on(line, value, tolerance)
        return
    n[W], n[FW] = n[TRIAL], value  # the upper end of the bracket
    _try_down(line)


@inner_kernel
def _try_down(line):
    n = line.numbers
    n[TRIAL] = max(n[X] - n[REACH], n[LOW])
    line.counts[0] = DOWN if n[X] - n[TRIAL] >= 1e-12 else DONE
    if line.counts[0] == DONE and n[W] > n[X]:
        # at the lower bound, with the upper end of a bracket: the minimum is between them
        n[V], n[FV] = n[X], n[FX]
        line.counts[0] = NARROW
        n[A], n[B] = n[X], n[W]
        n[STEP_BEFORE] = 0.0
        n[TRIAL] = n[X] + GOLDEN * (n[W] - n[X])
        n[STEP] = n[TRIAL] - n[X]


@inner_kernel
def _told_down(line, value, tolerance):
    n = line.numbers
    if value < n[FX]:
        n[WAY] = -1.0
        _walk_on(line, value, tolerance)
        return
    n[V], n[FV] = n[TRIAL], value
    upper = n[W] if n[W] > n[X] else n[X]
    _bracketed(line, n[V], upper, tolerance)


@inner_kernel
def _walk_on(line, value, tolerance):
    """Downhill: the trial becomes the best point; the next one lies farther that way, unless a bound ends it."""
    n = line.numbers
    n[V], n[FV] = n[X], n[FX]
    n[W], n[FW] = n[X], n[FX]
    n[X], n[FX] = n[TRIAL], value
    n[REACH] = GROWTH * n[REACH]
    line.counts[0] = WALK
    n[TRIAL] = min(max(n[X] + n[WAY] * n[REACH], n[LOW]), n[HIGH])
    if abs(n[TRIAL] - n[X]) < 1e-12:
        _bracketed(line, min(n[V], n[X]), max(n[V], n[X]), tolerance)


@inner_kernel
def _told_walk(line, value, tolerance):
    n = line.numbers
    if value < n[FX]:
        _walk_on(line, value, tolerance)
        return
    n[W], n[FW] = n[TRIAL], value
    _bracketed(line, min(n[V], n[W]), max(n[V], n[W]), tolerance)


@inner_kernel
def _bracketed(line, low, high, tolerance):
    """A minimum lies in [low, high]: from here on Brent's own method."""
    n = line.numbers
    n[A], n[B] = low, high
    if n[FV] < n[FW]:
        n[V], n[W] = n[W], n[V]
        n[FV], n[FW] = n[FW], n[FV]
    n[STEP] = n[STEP_BEFORE] = high - low
    line.counts[0] = NARROW
    _next_trial(line, tolerance)


@inner_kernel
def _next_trial(line, tolerance):
    """The least point of the parabola through the three best points if that is trustworthy, else a golden section."""
    n = line.numbers
    middle = 0.5 * (n[A] + n[B])
    if abs(n[X] - middle) <= 2.0 * tolerance - 0.5 * (n[B] - n[A]):
        line.counts[0] = DONE
        return
    step, trusted = 0.0, False
    if abs(n[STEP_BEFORE]) > tolerance:
        step, trusted = _parabola(n)
    if trusted:
        n[STEP_BEFORE] = n[STEP]
        if n[X] + step - n[A] < 2.0 * tolerance or n[B] - n[X] - step < 2.0 * tolerance:
            step = math.copysign(tolerance, middle - n[X])
    else:
        n[STEP_BEFORE] = n[A] - n[X] if n[X] >= middle else n[B] - n[X]
        step = GOLDEN * n[STEP_BEFORE]
    n[STEP] = step
    n[TRIAL] = n[X] + (step if abs(step) >= tolerance else math.copysign(tolerance, step))


@inner_kernel
def _parabola(n):
    """The step from the best point to the parabola's least one, and whether to trust it."""
    r = (n[X] - n[W]) * (n[FX] - n[FV])
    q = (n[X] - n[V]) * (n[FX] - n[FW])
    p = (n[X] - n[V]) * q - (n[X] - n[W]) * r
    q = 2.0 * (q - r)
    if q > 0.0:
        p = -p
    q = abs(q)
    if abs(p) >= abs(0.5 * q * n[STEP_BEFORE]) or p <= q * (n[A] - n[X]) or p >= q * (n[B] - n[X]):
        return 0.0, False
    return p / q, True


@inner_kernel
def _narrowed(line, value):
    """Moves the ends of the bracket and the three best points."""
    n = line.numbers
    u = n[TRIAL]
    if value < n[FX]:  # on a plateau the search stays where it is
        if u >= n[X]:
            n[A] = n[X]
        else:
            n[B] = n[X]
        n[V], n[FV] = n[W], n[FW]
        n[W], n[FW] = n[X], n[FX]
        n[X], n[FX] = u, value
        return
    if u < n[X]:
        n[A] = u
    else:
        n[B] = u
    if value <= n[FW] or n[W] == n[X]:
        n[V], n[FV] = n[W], n[FW]
        n[W], n[FW] = u, value
    elif value <= n[FV] or n[V] == n[X] or n[V] == n[W]:
        n[V], n[FV] = u, value
