"""The line search that asks and is told, against SciPy's Brent."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from engine.maths import brent


def search(function, start, step=0.3, low=-4.0, high=4.0, tolerance=1e-6):
    line = brent.new_line()
    brent.begin(line, start, function(start), step, low, high)
    while not brent.finished(line):
        trial = line.numbers[brent.TRIAL]
        assert low <= trial <= high
        brent.tell(line, function(trial), tolerance)
    return (*brent.best(line), line.counts[1])


places = st.floats(-6.0, 6.0).map(lambda x: round(x, 6))
starts = st.floats(-4.0, 4.0).map(lambda x: round(x, 6))

SMOOTH = {
    "bowl": lambda x: (x - 0.7) ** 2,
    "quartic": lambda x: (x + 1.2) ** 4 + 0.3 * (x + 1.2) ** 2,
    "cosh": lambda x: float(np.cosh(x - 2.1)),
    "kink": lambda x: abs(x - 0.4) + 0.1 * x * x,
    "lopsided": lambda x: float(np.exp(-2 * x) + 0.5 * x),
}


@pytest.mark.parametrize("name", SMOOTH)
@pytest.mark.parametrize("start", [-3.0, 0.0, 3.5])
def test_finds_what_scipy_finds_with_hardly_more_evaluations(name, start):
    function = SMOOTH[name]
    x, value, evaluations = search(function, start)
    reference = minimize_scalar(function, bounds=(-4, 4), method="bounded", options={"xatol": 1e-6})
    assert x == pytest.approx(reference.x, abs=2e-3 if name == "quartic" else 2e-5)
    assert value <= reference.fun + 1e-6
    assert evaluations <= 1.5 * reference.nfev + 6


@given(places, starts)
def test_a_bowl_from_anywhere_ends_in_its_bottom_or_at_the_bound(bottom, start):
    x, _, evaluations = search(lambda x: (x - bottom) ** 2, start)
    assert x == pytest.approx(min(max(bottom, -4.0), 4.0), abs=2e-5)
    assert evaluations < 60


@given(st.lists(st.floats(-1, 1).map(lambda x: round(x, 6)), min_size=3, max_size=3), starts)
def test_never_worse_than_the_start(waves, start):
    def ripple(x):
        return float(sum(w * np.cos((k + 1) * x) for k, w in enumerate(waves)) + 0.05 * x * x)

    x, value, _ = search(ripple, start)
    assert value <= ripple(start)
    assert value == pytest.approx(ripple(x))


def test_a_flat_line_ends_where_it_began():
    x, value, evaluations = search(lambda x: 2.0, 0.5, tolerance=0.01)
    assert (x, value) == (0.5, 2.0)
    assert evaluations < 30


def test_no_room_at_all():
    line = brent.new_line()
    brent.begin(line, 1.0, 5.0, 0.3, 1.0, 1.0)
    assert brent.finished(line)
    assert brent.best(line) == (1.0, 5.0)
