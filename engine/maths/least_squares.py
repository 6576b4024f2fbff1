"""One step of bounded least squares (Levenberg 1944, Marquardt 1963), for objectives that are a sum of squares.

The second solver beside the thesis's quasi-Newton one: it uses the residuals themselves, not only their sum, so a
handful of steps is enough, and it keeps variables inside their bounds instead of penalising them. No BLAS: the same
bits every run.
"""

from __future__ import annotations

import math

import numpy as np

from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


@njit(cache=True)
def normal_equations(jacobian, residuals, matrix, slope):
    """Writes J'J (n, n) and J'r (n,) from J (m, n) and r (m,)."""
    m, n = jacobian.shape
    for i in range(n):
        slope[i] = 0.0
        for j in range(n):
            matrix[i, j] = 0.0
    for k in range(m):
        for i in range(n):
            slope[i] += jacobian[k, i] * residuals[k]
            for j in range(i + 1):
                matrix[i, j] += jacobian[k, i] * jacobian[k, j]
    for i in range(n):
        for j in range(i):
            matrix[j, i] = matrix[i, j]


@njit(cache=True)
def bounded_step(matrix, slope, point, low, high, damping, step):
    """Writes the damped step (n,) that solves (J'J + damping * diag) step = -J'r, staying within low and high (n,).

    A variable that stands on its bound and is pushed outwards is held there; one whose step would cross its bound
    stops on it, and the others are solved again with that known, until all agree.
    """
    n = len(point)
    held = np.zeros(n, np.bool_)
    for i in range(n):
        step[i] = 0.0
        held[i] = (point[i] <= low[i] and slope[i] > 0.0) or (point[i] >= high[i] and slope[i] < 0.0)
    factor = np.empty((n, n))
    for _ in range(n):
        _solve_free(matrix, slope, held, damping, factor, step)
        crossed = False
        for i in range(n):
            if not held[i] and not low[i] <= point[i] + step[i] <= high[i]:
                step[i] = min(max(point[i] + step[i], low[i]), high[i]) - point[i]
                held[i] = True
                crossed = True
        if not crossed:
            return


@inner_kernel
def _solve_free(matrix, slope, held, damping, factor, step):
    """Cholesky solve for the free variables; held ones keep their step, which moves to the right-hand side."""
    n = len(step)
    for i in range(n):
        for j in range(i + 1):
            if held[i] or held[j]:
                factor[i, j] = 1.0 if i == j else 0.0
                continue
            value = matrix[i, j]
            if i == j:
                value += damping * matrix[i, i] + 1e-12
            for k in range(j):
                value -= factor[i, k] * factor[j, k]
            factor[i, j] = math.sqrt(max(value, 1e-300)) if i == j else value / factor[j, j]
    for i in range(n):  # forwards
        if held[i]:
            continue
        value = -slope[i]
        for j in range(n):
            if held[j]:
                value -= matrix[i, j] * step[j]
        for k in range(i):
            if not held[k]:
                value -= factor[i, k] * step[k]
        step[i] = value / factor[i, i]
    for i in range(n - 1, -1, -1):  # backwards
        if held[i]:
            continue
        value = step[i]
        for k in range(i + 1, n):
            if not held[k]:
                value -= factor[k, i] * step[k]
        step[i] = value / factor[i, i]
