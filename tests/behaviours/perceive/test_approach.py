"""The flight of a scripted threat, back from its contact: against the closed parabola, and itself run forwards."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from behaviours.perceive.approach import coming_from, lowest_m, plan_approach
from engine.maths.ballistics import GRAVITY_MPS2, drag_per_m, fly

AIM = (0.3, -0.2, 1.6)
G = -GRAVITY_MPS2[2]


def plan(azimuth_deg=0.0, elevation_deg=12.0, speed_mps=26.0, ttc_s=0.6, heading_deg=0.0, **more):
    angles = (math.radians(a) for a in (heading_deg, azimuth_deg, elevation_deg))
    return plan_approach(AIM, *angles, speed_mps, ttc_s, **more)


@given(st.integers(-180, 180), st.integers(0, 60), st.integers(10, 40), st.integers(3, 100), st.booleans())
def test_flown_forwards_tick_by_tick_it_meets_the_aim_within_a_millimetre(azimuth, elevation, speed, hundredths, drags):
    drag = drag_per_m(0.105, 0.27, 0.2) if drags else 0.0
    way = plan(azimuth, elevation, float(speed), hundredths / 100.0, drag=drag)
    p, v = way.start_m, way.start_mps
    ticks = int(way.ttc_s * 120)
    for _ in range(ticks):
        p, v = fly(p, v, GRAVITY_MPS2, drag, 1 / 120)
    p, v = fly(p, v, GRAVITY_MPS2, drag, way.ttc_s - ticks / 120)
    assert math.dist(p, AIM) < 1e-3
    assert math.dist(v, way.contact_mps) < 1e-2


def test_azimuth_elevation_and_speed_are_those_at_contact_in_the_character_s_heading():
    way = plan(azimuth_deg=30.0, elevation_deg=10.0, speed_mps=25.0, heading_deg=50.0)
    come_from = -np.array(way.contact_mps)
    assert np.linalg.norm(come_from) == pytest.approx(25.0)
    assert math.degrees(math.atan2(come_from[1], come_from[0])) == pytest.approx(80.0)
    assert math.degrees(math.asin(come_from[2] / 25.0)) == pytest.approx(10.0)


def test_plus_ninety_is_its_left():
    left = coming_from(math.radians(90.0), math.radians(90.0), 0.0)
    np.testing.assert_allclose(left, (-1.0, 0.0, 0.0), atol=1e-12)  # it faces +Y: its left is -X


def test_without_drag_it_starts_on_the_parabola():
    way = plan(elevation_deg=15.0, speed_mps=24.0, ttc_s=0.5)
    v = np.array(way.contact_mps)
    np.testing.assert_allclose(way.start_m, AIM - v * 0.5 + 0.5 * np.array([0, 0, -G]) * 0.25, atol=1e-9)
    np.testing.assert_allclose(way.start_mps, v + np.array([0, 0, G]) * 0.5, atol=1e-9)
    assert way.raised_deg == 0.0
    assert way.shortened_s == 0.0


def test_a_path_from_under_ground_is_raised_by_no_more_than_it_takes():
    """The specification's example: 22.8 m/s, level, a second to go leads 3.3 m down, and 8.8 degrees clear it."""
    aim = (0.0, 0.0, 1.6)
    level = fly(aim, (-22.8, 0.0, 0.0), GRAVITY_MPS2, 0.0, -1.0)[0]
    assert level[2] == pytest.approx(1.6 - 0.5 * G, abs=1e-9)
    assert level[2] == pytest.approx(-3.3, abs=0.05)
    way = plan_approach(aim, 0.0, 0.0, 0.0, 22.8, 1.0, radius_m=0.105)
    assert way.raised_deg == pytest.approx(8.8, abs=0.3)  # of a target a little lower
    assert way.ttc_s == 1.0
    assert lowest_m(aim, way.contact_mps, 1.0, 0.0) == pytest.approx(0.105, abs=1e-6)
    # the closed form: the start is the lowest point, as the ball still rises there
    assert math.degrees(math.asin((0.5 * G + 0.105 - 1.6) / 22.8)) == pytest.approx(way.raised_deg, abs=1e-6)


@given(st.integers(-80, 80), st.integers(3, 40), st.integers(2, 120), st.sampled_from([0.0, 0.016, 0.2]))
def test_a_flight_is_lowest_at_one_of_its_ends(elevation_deg, speed_mps, ticks, drag):
    """Against every moment of it; 0.2 / m is a beach ball, which falls at its terminal velocity within metres."""
    up = math.radians(elevation_deg)
    velocity = (-speed_mps * math.cos(up), 0.0, -speed_mps * math.sin(up))
    ttc_s = min(ticks / 120.0, 0.5 / (drag * speed_mps) if drag else math.inf)
    along = [fly(AIM, velocity, GRAVITY_MPS2, drag, -ttc_s * k / 200)[0][2] for k in range(201)]
    assert lowest_m(AIM, velocity, ttc_s, drag) == pytest.approx(min(along), abs=1e-9)


def test_or_the_time_is_shortened_to_the_last_whole_tick_that_clears():
    way = plan_approach((0.0, 0.0, 1.6), 0.0, 0.0, 0.0, 22.8, 1.0, radius_m=0.105, low_path="shorten")
    longest_s = math.sqrt(2.0 * (1.6 - 0.105) / G)
    assert way.ttc_s == pytest.approx(math.floor(longest_s * 120) / 120, abs=1e-9)
    assert way.shortened_s == pytest.approx(1.0 - way.ttc_s, abs=1e-9)
    assert way.raised_deg == 0.0
    assert way.start_m[2] >= 0.105


def test_with_drag_the_past_goes_no_farther_back_than_there_is_one():
    way = plan(speed_mps=200.0, ttc_s=5.0, elevation_deg=60.0, drag=0.05)
    assert way.ttc_s == pytest.approx(0.5 / (0.05 * 200.0))
    assert np.isfinite(way.start_m).all()
