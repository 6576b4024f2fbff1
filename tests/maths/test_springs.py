"""Springs against their differential equation, and against themselves in other steps."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.maths import quaternion, springs

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
    q0, w0 = quaternion.from_rotation_vector((0.3, -0.2, 0.5)), (1.0, 0.5, -2.0)
    q, w = springs.decaying_rotation(q0, w0, 0.1, 0.0)
    np.testing.assert_allclose(q, q0, atol=1e-15)
    np.testing.assert_allclose(w, w0, atol=1e-15)
    q, _ = springs.decaying_rotation(q0, w0, 0.1, 2.0)
    assert quaternion.angle_between(q, quaternion.IDENTITY) < 1e-6
    q, _ = springs.decaying_rotation(q0, w0, 0.1, 1e-5)
    moved = np.subtract(quaternion.to_rotation_vector(q), quaternion.to_rotation_vector(q0)) / 1e-5
    np.testing.assert_allclose(moved, w0, atol=1e-2)
    assert springs.decaying(2.0, 0.0, 0.1, 0.0) == (2.0, 0.0)


def test_a_half_sine_delivers_everything_and_symmetrically():
    t = np.linspace(-0.002, 0.012, 1401)
    share = np.array([springs.half_sine(s, 0.01) for s in t])
    assert share[0] == 0.0
    assert share[-1] == 1.0
    assert (np.diff(share) >= 0).all()
    assert springs.half_sine(0.005, 0.01) == pytest.approx(0.5)
    # its slope is the force: pi / 2 over the duration at the peak
    assert np.diff(share).max() / 1e-5 == pytest.approx(0.5 * math.pi / 0.01, rel=1e-3)
