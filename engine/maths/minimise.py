"""Quasi-Newton minimisation (BFGS; Hermens 2006, 3.3 after Press et al., *Numerical Recipes*, 10.7) that asks and is
told.

The search never calls the function it minimises. It holds a point to try; whoever drives it evaluates there and tells
the value; the search moves on. So any kernel can use it with a loop of three lines, compiled and cached with its own
objective:

    search = new_search(start)
    while not finished(search):
        tell(search, my_objective(search.trial), offset, tolerance, iterations, restarts)

Derivatives are central differences with a fixed offset (the thesis's midpoint rule); the line search backtracks by
quadratic, then cubic fits (Dennis and Schnabel 1983, A6.3.1). No BLAS: the same bits, run after run.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from engine.maths.copying import copy_into
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

# how a search ended, by its `counts[STOP]`
STOPS = ("running", "converged", "iterations", "line_search", "flat")
RUNNING, CONVERGED, OUT_OF_ITERATIONS, LINE_SEARCH, FLAT = range(len(STOPS))

# what the value to be told belongs to
AT_START, AHEAD, BEHIND, ON_LINE = range(4)

# slots of `counts` and of `numbers`
PHASE, AXIS, ITERATIONS, EVALUATIONS, RESTARTS, STOP, FRESH, MOVED = range(8)
VALUE, VALUE_AHEAD, SLOPE, STEP, LAST_STEP, LAST_VALUE, DECREASE, ROUND_VALUE = range(8)

ENOUGH = 1e-4  # share of the promised decrease that a step must deliver
LONGEST_STEP = 0.5  # no single step moves farther than this, in the units of the variables
LEAST_CURVATURE = 1e-6  # of a sum of squares along any axis, so that it can be inverted
SHORTEST_STEP = 1e-7  # a step that would move every variable less than this ends the line search


class Search(NamedTuple):
    """A search under way over n variables."""

    trial: np.ndarray  # (n,) where the function is wanted next
    point: np.ndarray  # (n,) the best point so far
    gradient: np.ndarray  # (n,) at `point`
    last_gradient: np.ndarray  # (n,) at the point before
    direction: np.ndarray  # (n,) the line being searched
    moved: np.ndarray  # (n,) the last accepted step
    curvature: np.ndarray  # (n, n) estimate of the inverse Hessian
    numbers: np.ndarray  # (8,) see the slots
    counts: np.ndarray  # (8,) see the slots


@njit(cache=True)
def new_search(start):
    """A search from `start` (n,), which is copied."""
    n = len(start)
    search = Search(
        start.copy(),
        start.copy(),
        np.zeros(n),
        np.zeros(n),
        np.zeros(n),
        np.zeros(n),
        np.zeros((n, n)),
        np.zeros(8),
        np.zeros(8, np.int64),
    )
    _forget_curvature(search)
    return search


@inner_kernel
def begin_with(search, slopes):
    """Gives a fresh search the curvature of a sum of squares, from the slopes (n, m) of its weighted residuals.

    Inverts 2 J J' + a little of the unit matrix, by Gauss and Jordan: it is positive, so no pivots have to be sought.
    To be called before the last derivative of the first gradient is told.
    """
    n = len(search.point)
    left, right = np.zeros((n, n)), search.curvature
    right[:] = 0.0
    for i in range(n):
        right[i, i] = 1.0
        left[i, i] = LEAST_CURVATURE
        for j in range(n):
            for k in range(slopes.shape[1]):
                left[i, j] += 2.0 * slopes[i, k] * slopes[j, k]
    for i in range(n):
        scale = 1.0 / left[i, i]
        for j in range(n):
            left[i, j] *= scale
            right[i, j] *= scale
        for row in range(n):
            if row != i:
                share = left[row, i]
                for j in range(n):
                    left[row, j] -= share * left[i, j]
                    right[row, j] -= share * right[i, j]
    search.counts[FRESH] = 0


@njit(cache=True)
def finished(search):
    return search.counts[STOP] != RUNNING


@njit(cache=True)
def tell(search, value, offset, tolerance, iterations, restarts):
    """Takes the function's value at `search.trial` and sets the next trial point, or ends the search.

    offset: of the differences; tolerance: relative decrease of one iteration that ends the search; iterations: at most;
    restarts: how often the search may begin again from where it ended with fresh curvature, while that still gains.
    """
    counts, numbers = search.counts, search.numbers
    counts[EVALUATIONS] += 1
    if counts[PHASE] == AT_START:
        numbers[VALUE] = value
        numbers[ROUND_VALUE] = value
        _begin_gradient(search, offset)
    elif counts[PHASE] == AHEAD:
        numbers[VALUE_AHEAD] = value
        axis = counts[AXIS]
        search.trial[axis] = search.point[axis] - offset
        counts[PHASE] = BEHIND
    elif counts[PHASE] == BEHIND:
        axis = counts[AXIS]
        search.gradient[axis] = (numbers[VALUE_AHEAD] - value) / (2.0 * offset)
        search.trial[axis] = search.point[axis]
        if axis + 1 < len(search.point):
            counts[AXIS] = axis + 1
            search.trial[axis + 1] = search.point[axis + 1] + offset
            counts[PHASE] = AHEAD
        else:
            _begin_line(search)
    else:
        _judge_step(search, value, offset, tolerance, iterations, restarts)


@inner_kernel
def _begin_gradient(search, offset):
    copy_into(search.trial, search.point)
    search.trial[0] += offset
    search.counts[AXIS] = 0
    search.counts[PHASE] = AHEAD


@inner_kernel
def _begin_line(search):
    """Chooses the direction, -H g, and its first step: the full one."""
    if search.counts[MOVED] == 1:
        _update_curvature(search)
    n = len(search.point)
    steepness = slope = longest = 0.0
    for i in range(n):
        towards = 0.0
        for j in range(n):
            towards -= search.curvature[i, j] * search.gradient[j]
        search.direction[i] = towards
        slope += towards * search.gradient[i]
        steepness += search.gradient[i] ** 2
        longest += towards * towards
    if steepness < 1e-24:
        search.counts[STOP] = FLAT
        return
    if slope >= 0.0:  # rounding has spoilt the curvature: straight downhill instead
        _forget_curvature(search)
        for i in range(n):
            search.direction[i] = -search.gradient[i]
        slope, longest = -steepness, steepness
    shrink = min(1.0, LONGEST_STEP / math.sqrt(longest))
    for i in range(n):
        search.direction[i] *= shrink
        search.trial[i] = search.point[i] + search.direction[i]
    search.numbers[SLOPE] = slope * shrink
    search.numbers[STEP] = 1.0
    search.counts[PHASE] = ON_LINE


@inner_kernel
def _judge_step(search, value, offset, tolerance, iterations, restarts):
    """Accepts the step if it gains enough, else tries a shorter one."""
    counts, numbers = search.counts, search.numbers
    if value <= numbers[VALUE] + ENOUGH * numbers[STEP] * numbers[SLOPE]:
        _accept_step(search, value, offset, tolerance, iterations, restarts)
        return
    shorter = _shorter_step(numbers, value)
    numbers[LAST_STEP], numbers[LAST_VALUE] = numbers[STEP], value
    numbers[STEP] = shorter
    farthest = 0.0
    for i in range(len(search.point)):
        farthest = max(farthest, abs(shorter * search.direction[i]))
    if farthest < SHORTEST_STEP:
        counts[STOP] = LINE_SEARCH
        _end_round(search, offset, tolerance, restarts)
    else:
        for i in range(len(search.point)):
            search.trial[i] = search.point[i] + shorter * search.direction[i]


@inner_kernel
def _shorter_step(numbers, value):
    """The least point of the parabola, after the first failure of the cubic, through what is known of the line."""
    start, slope, step = numbers[VALUE], numbers[SLOPE], numbers[STEP]
    excess = value - start - step * slope
    if step == 1.0:
        best = -slope / (2.0 * excess)
    else:
        last = numbers[LAST_STEP]
        last_excess = numbers[LAST_VALUE] - start - last * slope
        a = (excess / step**2 - last_excess / last**2) / (step - last)
        b = (last_excess * step / last**2 - excess * last / step**2) / (step - last)
        if abs(a) < 1e-300:
            best = -slope / (2.0 * b)
        else:
            inside = b * b - 3.0 * a * slope
            best = 0.5 * step if inside < 0.0 else (-b + math.sqrt(inside)) / (3.0 * a)
    if not best <= 0.5 * step:  # also catches a value that is no number
        best = 0.5 * step
    return max(best, 0.1 * step)


@inner_kernel
def _accept_step(search, value, offset, tolerance, iterations, restarts):
    counts, numbers = search.counts, search.numbers
    for i in range(len(search.point)):
        search.moved[i] = numbers[STEP] * search.direction[i]
    copy_into(search.point, search.trial)
    copy_into(search.last_gradient, search.gradient)
    decrease = numbers[VALUE] - value
    numbers[VALUE] = value
    counts[ITERATIONS] += 1
    if counts[ITERATIONS] >= iterations:
        counts[STOP] = OUT_OF_ITERATIONS
    elif decrease <= tolerance * (abs(value) + 1e-30):
        counts[STOP] = CONVERGED
        _end_round(search, offset, tolerance, restarts)
    else:
        counts[MOVED] = 1
        _begin_gradient(search, offset)


@inner_kernel
def _end_round(search, offset, tolerance, restarts):
    """Leaves the search stopped, or begins another round with fresh curvature if the last one gained."""
    counts, numbers = search.counts, search.numbers
    gained = numbers[ROUND_VALUE] - numbers[VALUE]
    if counts[RESTARTS] < restarts and gained > tolerance * (abs(numbers[VALUE]) + 1e-30):
        counts[STOP] = RUNNING
        counts[RESTARTS] += 1
        numbers[ROUND_VALUE] = numbers[VALUE]
        _forget_curvature(search)
        _begin_gradient(search, offset)


@inner_kernel
def _forget_curvature(search):
    search.curvature[:] = 0.0
    for i in range(len(search.point)):
        search.curvature[i, i] = 1.0
    search.counts[FRESH] = 1
    search.counts[MOVED] = 0


@inner_kernel
def _update_curvature(search):
    """The BFGS update of the inverse Hessian from the last step s and the change of gradient y.

    After a fresh start the identity is first scaled to the function, by s.y / y.y (Nocedal and Wright, eq. 6.20).
    """
    n = len(search.point)
    s, curvature, counts = search.moved, search.curvature, search.counts
    y = search.last_gradient  # becomes the change
    sy = yy = ss = 0.0
    for i in range(n):
        y[i] = search.gradient[i] - y[i]
        sy += s[i] * y[i]
        yy += y[i] * y[i]
        ss += s[i] * s[i]
    counts[MOVED] = 0
    if sy <= 1e-10 * math.sqrt(ss * yy):  # no positive curvature along this step: nothing to learn
        return
    if counts[FRESH] == 1:
        for i in range(n):
            curvature[i, i] = sy / yy
        counts[FRESH] = 0
    hy = search.trial  # free until the next trial point is set
    yhy = 0.0
    for i in range(n):
        hy[i] = 0.0
        for j in range(n):
            hy[i] += curvature[i, j] * y[j]
        yhy += y[i] * hy[i]
    for i in range(n):
        for j in range(n):
            curvature[i, j] += (1.0 + yhy / sy) * s[i] * s[j] / sy - (hy[i] * s[j] + s[i] * hy[j]) / sy
