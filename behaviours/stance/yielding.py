"""A shape that gives way to a reach it fights (section 8 asks for it: the paper tunes weights by hand).

Where the objective's minimum leaves a target out of reach, or an arm beyond its limits, the unknowns move on, as
little as the reach needs. Two things are weighed in least squares: how far each unknown goes from the minimum, in the
measure of its wish, and what the wrists lack, which counts so much more that half a millimetre of it is left where a
shape has to give way altogether. So what is wanted firmly (high weight, near wall) moves little, as with weights
grown until the reach is met. The abdomen may help even where its shape does not let it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.stance import penalty
from behaviours.stance.assembly import Figure, Plan
from behaviours.stance.balance import BalanceSearch
from behaviours.stance.wrists import finish, lacks_at
from engine.body.skeleton import Body
from engine.maths import minimise
from engine.maths.copying import copy_into
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

LACK_WEIGHT = 1e4  # what a metre of lack counts against a wish moved to its far point
MOST_STEPS = 6  # of Gauss-Newton
SETTLED = 1e-3  # a step of which no unknown moves more than this share of its wish's far point is the last
DIFFERENCE = 0.01  # step of the differences, as such a share
SHORTEST_SHARE, LONGEST_SHARE, MOST_SHORTER = 0.05, 0.7, 3
# of the last search: step of its differences, as such a share; least relative gain of an iteration; most iterations
BOTTOM_OFFSET, BOTTOM_TOLERANCE, BOTTOM_ITERATIONS = 1e-3, 1e-6, 40


class Yielding(NamedTuple):
    """What is weighed, and where the figure is worked out."""

    body: Body
    plan: Plan
    bounds: np.ndarray  # (6, 2)
    minimum: np.ndarray  # (6,) of the objective
    stiffness: np.ndarray  # (6,) weight over squared far point of each wish
    search: BalanceSearch
    figure: Figure
    wrists: np.ndarray  # (3, 2)


@njit(cache=True)
def give_way(body, plan, wishes, unknowns, bounds, search, figure, wrists):
    """Moves the unknowns (6,), in place. Finishes the figure; returns (steps, evaluations, balance error in
    metres).
    """
    stiffness = wishes.weight / wishes.wanted[:, penalty.HIGH + 2] ** 2
    task = Yielding(body, plan, bounds, unknowns.copy(), stiffness, search, figure, wrists)
    steps, evaluations = _newton(task, unknowns)
    evaluations += _to_the_bottom(task, unknowns)
    return steps, evaluations, finish(body, plan, unknowns, search, figure, wrists)


@inner_kernel
def _newton(task, unknowns):
    """Gauss-Newton steps, each shortened until it gains. Returns (steps, evaluations)."""
    before, step = unknowns.copy(), np.empty(len(unknowns))
    lacks, new_lacks, slopes = np.empty(2), np.empty(2), np.zeros((2, len(unknowns)))
    value, new_value, evaluations = _weigh(task, unknowns, lacks, True), 0.0, 1
    for steps in range(1, MOST_STEPS + 1):
        evaluations += _slopes_at(task, unknowns, lacks, slopes)
        copy_into(before, unknowns)
        least_squares_step(task.minimum, unknowns, task.stiffness, lacks, slopes, task.bounds, step)
        slope, share = _slope_along(task, unknowns, lacks, slopes, step), 1.0
        for _ in range(MOST_SHORTER + 1):
            for k in range(len(unknowns)):
                unknowns[k] = before[k] + share * step[k]
            new_value, evaluations = _weigh(task, unknowns, new_lacks, True), evaluations + 1
            if new_value < value:
                break
            # the least point of the parabola through what is known along the step
            least = -0.5 * slope * share * share / max(new_value - value - slope * share, 1e-30)
            share = min(max(least, SHORTEST_SHARE * share), LONGEST_SHARE * share)
        if new_value >= value:
            copy_into(unknowns, before)
            return steps, evaluations
        value = new_value
        copy_into(lacks, new_lacks)
        if np.max(np.abs(share * step) * np.sqrt(task.stiffness)) < SETTLED:
            return steps, evaluations
    return MOST_STEPS, evaluations


@inner_kernel
def _to_the_bottom(task, unknowns):
    """Goes on to the very minimum, in place, by quasi-Newton: where two reaches fight each other, Gauss-Newton does not
    get there, and where it stops would depend on rounding. Returns the evaluations.
    """
    far, lacks = 1.0 / np.sqrt(task.stiffness), np.empty(2)
    search = minimise.new_search(unknowns / far)
    while not minimise.finished(search):
        _take(search.trial, far, task.bounds, unknowns)
        value = _weigh(task, unknowns, lacks, True)
        minimise.tell(search, value, BOTTOM_OFFSET, BOTTOM_TOLERANCE, BOTTOM_ITERATIONS, 0)
    _take(search.point, far, task.bounds, unknowns)
    return search.counts[minimise.EVALUATIONS]


@inner_kernel
def _take(point, scale, bounds, unknowns):
    """Writes the unknowns that a point of the search (n,) stands for, within their bounds (n, 2)."""
    for k in range(len(unknowns)):
        unknowns[k] = min(max(point[k] * scale[k], bounds[k, 0]), bounds[k, 1])


@inner_kernel
def _weigh(task, unknowns, lacks, anew):
    """What is minimised; writes what the wrists lack. anew: from a figure finished and balanced with these unknowns."""
    if anew:
        finish(task.body, task.plan, unknowns, task.search, task.figure, task.wrists)
    lacks_at(task.body, task.plan, unknowns, task.search, task.figure, task.wrists, lacks)
    total = LACK_WEIGHT * (max(lacks[0], 0.0) ** 2 + max(lacks[1], 0.0) ** 2)
    for u in range(len(unknowns)):
        total += task.stiffness[u] * (unknowns[u] - task.minimum[u]) ** 2
    return total


@inner_kernel
def _slopes_at(task, unknowns, lacks, slopes):
    """Writes (2, 6) how what is lacking (2,) changes with each unknown. Returns the evaluations."""
    there = np.empty(2)
    for u in range(len(unknowns)):
        start, step = unknowns[u], DIFFERENCE / np.sqrt(task.stiffness[u])
        if start + step > task.bounds[u, 1]:
            step = -step
        unknowns[u] = start + step
        lacks_at(task.body, task.plan, unknowns, task.search, task.figure, task.wrists, there)
        unknowns[u] = start
        for side in range(2):
            slopes[side, u] = (there[side] - lacks[side]) / step if task.plan.reaching[side] else 0.0
    return len(unknowns)


@inner_kernel
def _slope_along(task, unknowns, lacks, slopes, step):
    """How fast what is minimised falls at the start of a step (negative)."""
    slope = 0.0
    for u in range(len(step)):
        slope += 2.0 * task.stiffness[u] * (unknowns[u] - task.minimum[u]) * step[u]
        for side in range(2):
            slope += 2.0 * LACK_WEIGHT * max(lacks[side], 0.0) * slopes[side, u] * step[u]
    return slope


@njit(cache=True)
def least_squares_step(minimum, unknowns, stiffness, lacks, slopes, bounds, step):
    """Writes the step (6,) of least squares.

    A wrist that lacks nothing, nor will after the step, has no say in it. An unknown that would pass a bound stops
    there, and the others make up for it.
    """
    free, counts = np.ones(len(step), np.bool_), lacks > 0.0
    left = lacks.copy()
    for _ in range(len(step) + 2):
        _free_step(minimum, unknowns, stiffness, left, slopes, free, counts, step)
        u = _first_to_stop(unknowns, bounds, free, step)
        if u >= 0:
            step[u] = min(max(unknowns[u] + step[u], bounds[u, 0]), bounds[u, 1]) - unknowns[u]
            free[u] = False
            left += slopes[:, u] * step[u]
            continue
        changed = False
        for side in range(2):
            if not counts[side] and left[side] + _sum_over(free, slopes[side], step) > 0.0:
                counts[side], changed = True, True
        if not changed:
            return


@inner_kernel
def _first_to_stop(unknowns, bounds, free, step):
    """The free unknown that a step would take past its bound earliest on the way; -1 when none."""
    first, earliest = -1, 1.0
    for u in range(len(step)):
        if free[u] and step[u] != 0.0:
            room = bounds[u, 1] - unknowns[u] if step[u] > 0.0 else unknowns[u] - bounds[u, 0]
            if room < earliest * abs(step[u]):
                first, earliest = u, max(room, 0.0) / abs(step[u])
    return first


@inner_kernel
def _sum_over(free, slopes, step):
    total = 0.0
    for u in range(len(step)):
        if free[u]:
            total += slopes[u] * step[u]
    return total


@inner_kernel
def _free_step(minimum, unknowns, stiffness, left, slopes, free, counts, step):
    """The step of the unknowns that are free: with two conditions on diagonal stiffness, two equations (Woodbury)."""
    a, b, d = 1.0 / LACK_WEIGHT, 0.0, 1.0 / LACK_WEIGHT
    towards = (left[0], left[1])
    for u in range(len(step)):
        if free[u]:
            ease, home = 1.0 / stiffness[u], minimum[u] - unknowns[u]
            first, second = slopes[0, u] * counts[0], slopes[1, u] * counts[1]
            a += first * first * ease
            b += first * second * ease
            d += second * second * ease
            towards = (towards[0] + first * home, towards[1] + second * home)
    towards = (towards[0] * counts[0], towards[1] * counts[1])
    determinant = a * d - b * b
    pull = ((d * towards[0] - b * towards[1]) / determinant, (a * towards[1] - b * towards[0]) / determinant)
    for u in range(len(step)):
        if free[u]:
            ease, home = 1.0 / stiffness[u], minimum[u] - unknowns[u]
            step[u] = home - ease * (slopes[0, u] * counts[0] * pull[0] + slopes[1, u] * counts[1] * pull[1])
