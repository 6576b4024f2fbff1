"""The quasi-Newton search against functions whose least value is known, and against SciPy's BFGS."""

import numpy as np
import pytest
from scipy.optimize import minimize

from engine.maths import minimise


def run(function, start, offset=1e-4, tolerance=1e-10, iterations=400, restarts=2):
    search = minimise.new_search(np.asarray(start, float))
    while not minimise.finished(search):
        minimise.tell(search, function(search.trial), offset, tolerance, iterations, restarts)
    return search


def rosenbrock(x):
    return float(np.sum(100.0 * (x[1:] - x[:-1] ** 2) ** 2 + (1.0 - x[:-1]) ** 2))


def test_bowl_with_unequal_axes_reaches_its_bottom():
    scale = np.array([25.0, 1.0, 0.01, 4.0])
    bottom = np.array([0.3, -0.2, 0.5, 0.0])
    search = run(lambda x: float(np.sum(scale * (x - bottom) ** 2)), np.zeros(4))
    assert search.point == pytest.approx(bottom, abs=1e-4)


def test_rosenbrocks_valley_like_scipy():
    start = np.array([-1.2, 1.0, 0.8])
    search = run(rosenbrock, start)
    reference = minimize(rosenbrock, start, method="BFGS")
    assert search.point == pytest.approx(reference.x, abs=1e-3)
    assert search.numbers[minimise.VALUE] < 1e-6


def test_counts_what_it_did():
    calls = []
    search = run(lambda x: calls.append(x.copy()) or float(np.sum((x - 1.0) ** 2)), np.zeros(3))
    assert search.counts[minimise.EVALUATIONS] == len(calls)
    assert search.counts[minimise.STOP] in (minimise.CONVERGED, minimise.FLAT)
    # the midpoint rule: each axis is tried ahead and behind of the start by the offset
    assert calls[1] == pytest.approx([1e-4, 0, 0])
    assert calls[2] == pytest.approx([-1e-4, 0, 0])


def test_start_at_the_bottom_stays():
    search = run(lambda x: float(np.sum(x**2)), np.zeros(3))
    assert search.counts[minimise.STOP] == minimise.FLAT
    assert search.point == pytest.approx(0.0)


def test_a_kink_ends_the_line_search_and_says_so():
    """On a kink the midpoint rule sees a slope that leads uphill."""
    search = run(lambda x: float(max(x[0], -0.1 * x[0]) + x[1] ** 2), np.zeros(2), offset=0.01, tolerance=1e-4)
    assert minimise.STOPS[search.counts[minimise.STOP]] == "line_search"


def test_iteration_limit():
    search = run(rosenbrock, np.array([-1.2, 1.0]), iterations=3)
    assert search.counts[minimise.STOP] == minimise.OUT_OF_ITERATIONS
    assert search.counts[minimise.ITERATIONS] == 3


def test_never_worse_than_the_start():
    rng = np.random.default_rng(3)
    for _ in range(20):
        centre, start = rng.normal(size=(2, 5))

        def ripple(x, centre=centre):
            return float(np.sum((x - centre) ** 2) + 0.3 * np.sum(np.cos(7 * x)))

        search = run(ripple, start, offset=0.01, tolerance=1e-4)
        assert ripple(search.point) <= ripple(start)
        assert search.numbers[minimise.VALUE] == pytest.approx(ripple(search.point))
