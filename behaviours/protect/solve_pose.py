"""The two solvers of the sustained pose: the thesis's quasi-Newton search, and bounded least squares beside it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.protect.total_error import BEGIN, RESIDUALS, SQUARES, TERMS, VARIABLES, residuals_into, total_error
from behaviours.rules.controls import CONTROL_COUNT
from engine.maths import minimise
from engine.maths.copying import copy_into
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.maths.least_squares import bounded_step, normal_equations

REFINE = 0.1  # each restart looks closer: the thesis's offset is as wide as the leg's soft end
LEAST_SQUARES_OFFSET = 1e-4  # its derivatives are of residuals, not of their squares: a fine difference is safe
LEAST_DAMPING, MOST_DAMPING = 1e-9, 1e6


class Solution(NamedTuple):
    """Where a solver ended, and how."""

    variables: np.ndarray  # (10,)
    value: float
    value_initial: float
    iterations: int
    evaluations: int
    restarts: int
    stop: int  # index into minimise.STOPS


@inner_kernel
def _weigh(reference, residuals):
    for term in range(len(TERMS)):
        for i in range(BEGIN[term], BEGIN[term + 1]):
            residuals[i] *= reference.weights[term]


@njit(cache=True)
def solve_bfgs(task, reference, form, start, posed, offset, tolerance, iterations, restarts):
    """BFGS on the total error from `start` (10,), see engine.maths.minimise; `form` as in total_error.

    The `squares` form begins with the curvature of its own residuals, whose differences the first gradient brings along
    (Nocedal and Wright 2006, 10.3): from the unit matrix it takes twice the iterations to much the same pose.
    """
    controls, residuals = np.empty(CONTROL_COUNT), np.empty(RESIDUALS)
    ahead, slopes = np.empty(RESIDUALS), np.empty((VARIABLES, RESIDUALS))
    search = minimise.new_search(start)
    posed.made_from[:] = np.nan
    initial = np.nan
    counts = search.counts
    while not minimise.finished(search):
        residuals_into(task, reference, search.trial, controls, posed, residuals)
        value = total_error(residuals, reference, form)
        if counts[minimise.EVALUATIONS] == 0:
            initial = value
        finer = offset * REFINE ** counts[minimise.RESTARTS]
        if form == SQUARES and counts[minimise.FRESH] == 1:
            if counts[minimise.PHASE] == minimise.AHEAD:
                copy_into(ahead, residuals)
            elif counts[minimise.PHASE] == minimise.BEHIND:
                axis = counts[minimise.AXIS]
                for i in range(RESIDUALS):
                    slopes[axis, i] = (ahead[i] - residuals[i]) / (2.0 * finer)
                _weigh(reference, slopes[axis])
                if axis == VARIABLES - 1:
                    minimise.begin_with(search, slopes)
        minimise.tell(search, value, finer, tolerance, iterations, restarts)
    return Solution(
        search.point,
        search.numbers[minimise.VALUE],
        initial,
        counts[minimise.ITERATIONS],
        counts[minimise.EVALUATIONS],
        counts[minimise.RESTARTS],
        counts[minimise.STOP],
    )


@inner_kernel
def _jacobian_into(task, reference, point, low, high, trial, controls, posed, ahead, behind, jacobian):
    """Central differences of the weighted residuals; one-sided against a bound. Two evaluations a variable."""
    copy_into(trial, point)
    for j in range(VARIABLES):
        up, down = min(point[j] + LEAST_SQUARES_OFFSET, high[j]), max(point[j] - LEAST_SQUARES_OFFSET, low[j])
        for forward in (True, False):  # one call, since residuals_into is compiled into every place that calls it
            trial[j] = up if forward else down
            residuals_into(task, reference, trial, controls, posed, ahead if forward else behind)
        trial[j] = point[j]
        for i in range(RESIDUALS):
            jacobian[i, j] = (ahead[i] - behind[i]) / (up - down)
        for term in range(len(TERMS)):
            for i in range(BEGIN[term], BEGIN[term + 1]):
                jacobian[i, j] *= reference.weights[term]


@njit(cache=True)
def solve_least_squares(task, reference, start, posed, tolerance, iterations):
    """Levenberg-Marquardt with controls kept in [0, 1], on the `squares` form, from `start` (10,)."""
    low, high = np.full(VARIABLES, -np.inf), np.full(VARIABLES, np.inf)
    low[3:], high[3:] = 0.0, 1.0
    controls, point, trial = np.empty(CONTROL_COUNT), np.empty(VARIABLES), np.minimum(np.maximum(start, low), high)
    residuals, trial_residuals = np.empty(RESIDUALS), np.empty(RESIDUALS)
    ahead, behind, step = np.empty(RESIDUALS), np.empty(RESIDUALS), np.empty(VARIABLES)
    jacobian, matrix, slope = np.empty((RESIDUALS, VARIABLES)), np.empty((VARIABLES, VARIABLES)), np.empty(VARIABLES)
    posed.made_from[:] = np.nan
    value = initial = np.inf
    evaluations, done, damping, stop = 0, 0, 1e-3, minimise.OUT_OF_ITERATIONS
    while True:
        residuals_into(task, reference, trial, controls, posed, trial_residuals)
        evaluations += 1
        _weigh(reference, trial_residuals)
        trial_value = _sum_of_squares(trial_residuals)
        if evaluations == 1 or trial_value < value:
            decrease = value - trial_value
            copy_into(point, trial)
            copy_into(residuals, trial_residuals)
            value = trial_value
            if evaluations == 1:
                initial = value
            else:
                damping = max(0.1 * damping, LEAST_DAMPING)
                if decrease <= tolerance * value:
                    stop = minimise.CONVERGED
                    break
            if done == iterations:
                break
            _jacobian_into(task, reference, point, low, high, trial, controls, posed, ahead, behind, jacobian)
            evaluations += 2 * VARIABLES
            done += 1
            normal_equations(jacobian, residuals, matrix, slope)
        elif damping >= MOST_DAMPING:
            stop = minimise.LINE_SEARCH
            break
        else:
            damping *= 10.0
        bounded_step(matrix, slope, point, low, high, damping, step)
        for i in range(VARIABLES):
            trial[i] = point[i] + step[i]
    return Solution(point, value, initial, done, evaluations, 0, stop)


@inner_kernel
def _sum_of_squares(residuals):
    total = 0.0
    for i in range(len(residuals)):
        total += residuals[i] * residuals[i]
    return total
