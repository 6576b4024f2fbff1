"""The sweep against closed forms and against brute force over ten thousand moments."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.maths import shapes, vector
from engine.maths.kernel import njit

STILL = ((0.0, 0.0, -1.0), (0.0, 0.0, 1.0)) * 2


def test_straight_at_a_still_capsule_it_meets_at_the_radius():
    share = shapes.swept_sphere_capsule((2.0, 0.0, 0.3), (0.0, 0.0, 0.3), *STILL, 0.5)
    assert share == pytest.approx(0.75, abs=1e-9)


def test_against_the_round_end_it_meets_on_the_end_sphere():
    # a sphere passing 0.3 off the end point's axis, radii 0.5: meets at depth sqrt(0.25 - 0.09) = 0.4 above the end
    share = shapes.swept_sphere_capsule((0.3, 0.0, 3.0), (0.3, 0.0, 1.0), *STILL, 0.5)
    assert 3.0 - 2.0 * share == pytest.approx(1.4, abs=1e-8)


def test_a_fast_ball_does_not_tunnel_through_a_forearm_within_one_tick():
    """60 m/s is half a metre a tick; arm and ball together are 0.14 m."""
    share = shapes.swept_sphere_capsule((0.25, 0.01, 0.0), (-0.25, 0.01, 0.0), *STILL, 0.14)
    assert 0.25 - 0.5 * share == pytest.approx(math.sqrt(0.14**2 - 0.01**2), abs=1e-8)


def test_a_capsule_that_moves_into_a_still_ball_meets_it_too():
    share = shapes.swept_sphere_capsule(
        (1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.0, 0.0, 1.0), (1.0, 0.0, -1.0), (1.0, 0.0, 1.0), 0.2
    )
    assert share == pytest.approx(0.8, abs=1e-9)


@pytest.mark.parametrize(("towards", "met"), [(-0.1, True), (0.1, False)])
def test_an_overlapping_pair_meets_only_if_it_is_approaching(towards, met):
    share = shapes.swept_sphere_capsule((0.2, 0.0, 0.0), (0.2 + towards, 0.0, 0.0), *STILL, 0.5)
    assert (share == 0.0) if met else (share == shapes.NO_HIT)


@given(st.integers(0, 2**32 - 1))
def test_the_first_contact_is_the_first_one(seed):
    rng = np.random.default_rng(seed)
    c0, c1, s0, e0, s1, e1 = rng.uniform(-1, 1, (6, 3))
    radius = rng.uniform(0.05, 0.4)
    share = shapes.swept_sphere_capsule(c0, c1, s0, e0, s1, e1, radius)
    t = np.linspace(0, 1, 10001)[:, None]
    centre, start, end = (a + t * (b - a) for a, b in ((c0, c1), (s0, s1), (e0, e1)))
    axis = end - start
    along = np.clip(((centre - start) * axis).sum(1) / (axis * axis).sum(1), 0, 1)[:, None]
    gaps = np.linalg.norm(centre - start - along * axis, axis=1) - radius
    if gaps[0] <= 1e-6:
        return  # begins inside: covered above
    touching = np.flatnonzero(gaps <= 0)
    if share == shapes.NO_HIT:
        assert gaps.min() > -1e-3
    else:
        k = round(share * 10000)
        assert abs(gaps[k]) < 1e-3
        if len(touching):
            assert touching[0] == pytest.approx(share * 10000, abs=1.001)


@njit(cache=True)
def boxes_apart(start, end, other_start, other_end, distance):
    return shapes.boxes_apart(start, end, other_start, other_end, distance)


@given(st.integers(0, 2**32 - 1))
def test_segments_whose_boxes_are_apart_are_too(seed):
    rng = np.random.default_rng(seed)
    ends = [tuple(end) for end in rng.uniform(-1, 1, (4, 3))]
    s, t = shapes.nearest_between(*ends)
    apart = math.dist(vector.mix(ends[0], ends[1], s), vector.mix(ends[2], ends[3], t))
    assert not boxes_apart(*ends, apart)


def test_boxes_are_apart_along_any_axis_either_way_round():
    a = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    for k in range(3):
        far = tuple(tuple(v + 3.0 * (i == k) for i, v in enumerate(end)) for end in a)
        assert boxes_apart(*a, *far, 1.9)
        assert boxes_apart(*far, *a, 1.9)
        assert not boxes_apart(*a, *far, 2.1)


def test_a_point_on_the_axis_still_has_an_outside():
    n = shapes.outwards((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.5))
    assert math.hypot(*n) == pytest.approx(1.0)
    assert n[2] == 0.0


def test_a_ray_finds_the_near_side_or_nothing():
    a, b = (0.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    assert shapes.ray_capsule((5.0, 0.0, 0.5), (-1.0, 0.0, 0.0), a, b, 0.2, 100.0) == pytest.approx(4.8, abs=1e-6)
    assert shapes.ray_capsule((5.0, 0.0, 0.5), (1.0, 0.0, 0.0), a, b, 0.2, 100.0) == math.inf
    assert shapes.ray_capsule((5.0, 0.0, 0.5), (-1.0, 0.0, 0.0), a, b, 0.2, 4.0) == math.inf


def test_nearest_places_of_two_segments_against_a_fine_grid():
    chance, grid = np.random.default_rng(3), np.linspace(0, 1, 201)
    for _ in range(60):
        a, b, c, d = chance.normal(size=(4, 3))
        s, t = shapes.nearest_between(a, b, c, d)
        found = np.linalg.norm(a + s * (b - a) - c - t * (d - c))
        p, q = a + grid[:, None] * (b - a), c + grid[:, None] * (d - c)
        least = np.linalg.norm(p[:, None] - q[None], axis=2).min()
        assert 0 <= s <= 1
        assert 0 <= t <= 1
        assert least - 0.02 < found <= least + 1e-9
