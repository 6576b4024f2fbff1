"""Springs against their differential equation, and against themselves in other steps."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.maths import springs

tenths = st.integers(-50, 50).map(lambda v: v / 10)


@given(tenths, tenths, tenths)
def test_a_spring_does_not_depend_on_the_tick(value, velocity, goal):
    once = springs.critical(value, velocity, goal, 0.2, 0.5)
    many = (value, velocity)
    for _ in range(60):
        many = springs.critical(*many, goal, 0.2, 0.5 / 60)
    np.testing.assert_allclose(many, once, atol=1e-10)
    once = springs.damped(value, velocity, goal, 2.0, 0.3, 0.5)
    many = (value, velocity)
    for _ in range(60):
        many = springs.damped(*many, goal, 2.0, 0.3, 0.5 / 60)
    np.testing.assert_allclose(many, once, atol=1e-10)


def test_they_solve_their_equations():
    """x'' = -y^2 x - 2 y x' (critical) and x'' = -w^2 x - 2 z w x' (damped), by central differences."""
    h, t = 1e-4, 0.13
    y, w, z = 2 * math.log(2) / 0.2, 2 * math.pi * 2.0, 0.3
    for spring, stiffness, damping in (
        (lambda s: springs.critical(1.0, -2.0, 0.0, 0.2, s), y * y, 2 * y),
        (lambda s: springs.damped(1.0, -2.0, 0.0, 2.0, 0.3, s), w * w, 2 * z * w),
    ):
        (a, va), (b, vb), (c, vc) = (spring(t + d) for d in (-h, 0.0, h))
        assert (c - a) / (2 * h) == pytest.approx(vb, abs=1e-5)
        assert (vc - va) / (2 * h) == pytest.approx(-stiffness * b - damping * vb, abs=1e-3)


def test_a_critical_spring_from_rest_never_overshoots_and_a_damped_one_does():
    t = np.linspace(0, 3, 300)
    assert min(springs.critical(1.0, 0.0, 0.0, 0.2, s)[0] for s in t) > 0.0
    overshoot = -min(springs.damped(1.0, 0.0, 0.0, 2.0, 0.3, s)[0] for s in t)
    assert overshoot == pytest.approx(math.exp(-math.pi * 0.3 / math.sqrt(1 - 0.09)), rel=0.01)


def test_offsets_die_away_from_where_and_how_fast_they_were():
    x0, v0 = 0.3, -2.0
    at_once, later, much_later = (springs.decaying(x0, v0, 0.1, t) for t in (0.0, 1e-5, 2.0))
    assert at_once == pytest.approx((x0, v0), abs=1e-15)
    assert (later[0] - x0) / 1e-5 == pytest.approx(v0, abs=1e-2)
    assert much_later[0] == pytest.approx(0.0, abs=1e-6)


def test_a_half_sine_delivers_everything_and_symmetrically():
    t = np.linspace(-0.002, 0.012, 1401)
    share = np.array([springs.half_sine(s, 0.01) for s in t])
    assert share[0] == 0.0
    assert share[-1] == 1.0
    assert (np.diff(share) >= 0).all()
    assert springs.half_sine(0.005, 0.01) == pytest.approx(0.5)
    # its slope is the force: pi / 2 over the duration at the peak
    assert np.diff(share).max() / 1e-5 == pytest.approx(0.5 * math.pi / 0.01, rel=1e-3)
