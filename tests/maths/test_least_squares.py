"""The bounded least-squares step against SciPy's bounded linear solver and the plain normal equations."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from engine.maths.least_squares import bounded_step, normal_equations


def linear_problem(seed, m=14, n=6):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(m, n)), rng.normal(size=m), rng.uniform(0.2, 0.8, size=n)


def step_for(jacobian, residuals, point, low, high, damping):
    n = len(point)
    matrix, slope, step = np.empty((n, n)), np.empty(n), np.empty(n)
    normal_equations(jacobian, residuals, matrix, slope)
    bounded_step(matrix, slope, point, low, high, damping, step)
    return step


def test_unbounded_undamped_is_the_linear_solution():
    jacobian, residuals, point = linear_problem(1)
    wide = np.full(len(point), 1e9)
    step = step_for(jacobian, residuals, point, -wide, wide, 0.0)
    assert step == pytest.approx(np.linalg.lstsq(jacobian, -residuals, rcond=None)[0], abs=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_repeated_bounded_steps_reach_scipys_bounded_optimum(seed):
    jacobian, residuals, point = linear_problem(seed)
    low, high = np.zeros(len(point)), np.ones(len(point))
    start, x = point.copy(), point.copy()
    for _ in range(60):
        x = x + step_for(jacobian, residuals + jacobian @ (x - start), x, low, high, 0.0)
        assert np.all(x >= -1e-12)
        assert np.all(x <= 1 + 1e-12)
    best = lsq_linear(jacobian, jacobian @ start - residuals, bounds=(low, high), tol=1e-12)
    cost = 0.5 * np.sum((residuals + jacobian @ (x - start)) ** 2)
    assert cost <= best.cost * (1 + 1e-6) + 1e-12


def test_damping_shortens_the_step():
    jacobian, residuals, point = linear_problem(5)
    wide = np.full(len(point), 1e9)
    lengths = [np.linalg.norm(step_for(jacobian, residuals, point, -wide, wide, d)) for d in (0.0, 1.0, 100.0)]
    assert lengths[0] > lengths[1] > lengths[2] > 0.0
