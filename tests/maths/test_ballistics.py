"""Flight against the closed parabola, an independent integrator, the terminal speed and itself run backwards."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from engine.maths import ballistics

G = ballistics.GRAVITY_MPS2
VOLLEYBALL = ballistics.drag_per_m(0.105, 0.27, 0.2)
velocities = st.tuples(*[st.integers(-300, 300).map(lambda v: v / 10)] * 3)


@given(velocities, st.integers(-2000, 2000).map(lambda ms: ms / 1000))
def test_without_drag_it_is_the_parabola_in_one_go_or_in_many(velocity, dt):
    p, v = ballistics.fly((1.0, 2.0, 3.0), velocity, G, 0.0, dt)
    expected = np.array([1.0, 2.0, 3.0]) + np.array(velocity) * dt + 0.5 * np.array(G) * dt * dt
    np.testing.assert_allclose(p, expected, atol=1e-12)
    np.testing.assert_allclose(v, np.array(velocity) + np.array(G) * dt, atol=1e-12)
    q, u = (1.0, 2.0, 3.0), velocity
    for _ in range(7):
        q, u = ballistics.fly(q, u, G, 0.0, dt / 7)
    np.testing.assert_allclose(q, expected, atol=1e-12)


@given(velocities, st.floats(0.05, 1.0))
def test_backwards_and_forwards_again_is_where_it_was(velocity, ttc):
    drag = VOLLEYBALL
    if ttc > 0.8 * ballistics.longest_past_s(math.dist(velocity, (0, 0, 0)) + 10.0 * ttc, drag):
        return
    start = ballistics.fly((0.0, 0.0, 1.5), velocity, G, drag, -ttc)
    back = ballistics.fly(*start, G, drag, ttc)
    np.testing.assert_allclose(back[0], (0.0, 0.0, 1.5), atol=1e-10)
    # ticks as the simulation takes them, the last one shorter, meet the same contact within a tenth of a millimetre
    p, v = start
    whole = int(ttc * 120)
    for _ in range(whole):
        p, v = ballistics.fly(p, v, G, drag, 1 / 120)
    p, v = ballistics.fly(p, v, G, drag, ttc - whole / 120)
    assert math.dist(p, (0.0, 0.0, 1.5)) < 1e-4


def test_with_drag_it_agrees_with_an_independent_integrator():
    v0 = np.array([24.0, -3.0, 6.0])

    def slope(_, s):
        return np.concatenate([s[3:], np.array(G) - VOLLEYBALL * np.linalg.norm(s[3:]) * s[3:]])

    with np.errstate(under="ignore"):  # SciPy asks for the float after zero
        reference = solve_ivp(slope, (0, 1.0), np.concatenate([[0, 0, 2.0], v0]), rtol=1e-11, atol=1e-12).y[:, -1]
    p, v = ballistics.fly((0.0, 0.0, 2.0), v0, G, VOLLEYBALL, 1.0)
    np.testing.assert_allclose(p, reference[:3], atol=1e-4)
    np.testing.assert_allclose(v, reference[3:], atol=1e-4)


def test_a_long_fall_reaches_the_terminal_speed():
    _, v = ballistics.fly((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), G, VOLLEYBALL, 30.0)
    assert -v[2] == pytest.approx(math.sqrt(9.80665 / VOLLEYBALL), rel=1e-5)


def test_a_past_that_cannot_have_been_is_nan_and_says_how_long_it_may_be():
    limit = ballistics.longest_past_s(25.0, 0.05)
    assert limit == pytest.approx(0.8)
    p, _ = ballistics.fly((0.0, 0.0, 0.0), (25.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.05, -0.79)
    assert math.isfinite(p[0])
    p, _ = ballistics.fly((0.0, 0.0, 0.0), (25.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.05, -0.85)
    assert math.isnan(p[0])
    assert ballistics.longest_past_s(25.0, 0.0) == math.inf
