"""Predicting a flight: where and when it comes nearest, against closed forms; and what is made of it, tick by tick."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from behaviours.components import Flight, Phase, Reaction, Threat
from behaviours.perceive.perceived import aim_of, target_centre
from behaviours.perceive.senses import closest_approach, facing_dot
from behaviours.perceive.threats import KINDS, normalised
from behaviours.settings import Settings
from behaviours.settle.seams import shown
from behaviours.timing import TICK_S, time_to_contact_s
from engine.body.kinematics import joints_of
from engine.maths.ballistics import GRAVITY_MPS2
from tests.behaviours.runs import events, phases, run, simulation_of, track_of

HORIZON_S = 1.6


def parabola(position, velocity, seconds):
    """(T, 3) of a ball without drag."""
    t = np.asarray(seconds)[:, None]
    return np.array(position) + t * np.array(velocity) + 0.5 * t * t * np.array(GRAVITY_MPS2)


def test_dropped_past_a_place_it_is_nearest_at_its_height():
    """Straight down from 2 m over a place 0.3 m aside: there after sqrt(2 h / g), 0.3 m off."""
    after_s, off_m, at, speed = closest_approach((0.3, 0.0, 3.0), (0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 1.0), 1.6, TICK_S)
    falls_s = math.sqrt(2 * 2.0 / -GRAVITY_MPS2[2])
    assert after_s == pytest.approx(falls_s, abs=1e-4)
    assert off_m == pytest.approx(0.3, abs=1e-6)
    assert at == pytest.approx((0.3, 0.0, 1.0), abs=1e-3)
    assert speed[2] == pytest.approx(GRAVITY_MPS2[2] * falls_s, abs=1e-3)


def centi(low, high):
    """Numbers of two digits: strict floating point minds those so small that their square is nothing."""
    return st.integers(round(100 * low), round(100 * high)).map(lambda n: n / 100)


@given(st.tuples(centi(3, 15), centi(-4, 4), centi(0.5, 3)), st.tuples(centi(-30, -6), centi(-6, 6), centi(-1, 5)))
def test_it_is_nearest_where_a_fine_search_along_the_parabola_finds_it(position, velocity):
    place = (0.0, 0.0, 1.6)
    after_s, off_m, at, _ = closest_approach(position, velocity, 0.0, place, HORIZON_S, TICK_S)
    times = np.linspace(0.0, HORIZON_S, 16001)
    away = np.linalg.norm(parabola(position, velocity, times) - place, axis=1)
    nearest = int(away.argmin())
    if 0 < nearest < len(times) - 1:
        assert off_m == pytest.approx(away[nearest], abs=2e-3)
        assert after_s == pytest.approx(times[nearest], abs=2e-3)
        assert at == pytest.approx(parabola(position, velocity, [after_s])[0], abs=1e-6)


def test_a_ball_that_goes_away_is_nearest_now():
    after_s, off_m, at, _ = closest_approach((2.0, 0.0, 1.6), (9.0, 0.0, 0.0), 0.0, (0.0, 0.0, 1.6), 1.6, TICK_S)
    assert (after_s, off_m) == (0.0, pytest.approx(2.0))
    assert at == pytest.approx((2.0, 0.0, 1.6))


def test_with_drag_it_comes_later():
    args = ((15.0, 0.0, 2.0), (-20.0, 0.0, 3.0)), ((0.0, 0.0, 1.6), HORIZON_S, TICK_S)
    vacuum, air = (closest_approach(*args[0], drag, *args[1])[0] for drag in (0.0, KINDS["volleyball"].drag_per_m))
    assert air > vacuum * 1.05


def thrown(place_offset_m=(0.0, 0.0, 0.0), speed_mps=25.0, from_m=(14.0, 0.0, 1.8)):
    """A free ball thrown to pass the head's place by an offset; the ball flies straight and a little down."""
    simulation = simulation_of()
    body = simulation.world.assets.bodies[0]
    joint, offset = aim_of(body, "head")
    head = np.array(target_centre(joint, offset, *joints_of(body, shown(simulation.world, 0)[0])))
    way = head + np.array(place_offset_m) - from_m
    flight_s = float(np.linalg.norm(way)) / speed_mps
    velocity = way / flight_s - 0.5 * flight_s * np.array(GRAVITY_MPS2)
    threat = {"free": True, "position_m": from_m, "velocity_mps": tuple(velocity.tolist()), "released_s": 0.1}
    return [threat], flight_s


def test_a_free_ball_is_noticed_when_eq_4_1_has_it():
    threats, flight_s = thrown(speed_mps=23.0)
    met = run(threats, duration_s=1.5)
    perceived = events(met, "perceived")
    assert len(perceived) == 1
    speed = normalised(float(np.linalg.norm(threats[0]["velocity_mps"])), *KINDS["volleyball"].speed_range_mps)
    due_s = time_to_contact_s(speed, facing_dot(met.world, 0, (1.0, 0.0, 0.0)), Settings().timing)
    assert due_s > flight_s  # it was thrown nearer than that, so it is noticed as it is thrown
    assert perceived[0]["ttc_s"] == pytest.approx(flight_s, abs=2 * TICK_S)
    assert perceived[0]["tick"] == pytest.approx(0.1 / TICK_S, abs=2)


def test_a_free_ball_from_far_is_not_noticed_before_eq_4_1():
    threats, flight_s = thrown(speed_mps=29.7, from_m=(24.0, 0.0, 1.8))
    met = run(threats, duration_s=1.8)
    (perceived,) = events(met, "perceived")
    assert flight_s > 0.7
    facing = facing_dot(met.world, 0, (1.0, 0.0, 0.0))
    least_s = time_to_contact_s(1.0, facing, Settings().timing)
    assert perceived["ttc_s"] <= least_s + 0.5 * TICK_S + 0.01
    assert perceived["ttc_s"] > least_s - 2 * TICK_S
    assert events(met, "contact")


@pytest.mark.parametrize(("aside_m", "startles"), [(0.50, True), (0.75, False)])
def test_a_near_miss_startles_and_never_protects(aside_m, startles):
    threats, _ = thrown((0.0, aside_m, 0.15))
    passed = run(threats, duration_s=1.5)
    assert events(passed, "contact") == []
    assert ("startle" in phases(passed)) == startles
    assert "protect" not in phases(passed)
    assert events(passed, "perceived") == []


def test_what_a_ball_will_do_is_known_from_where_it_is_not_from_where_it_was_thrown():
    """A ball that will miss by far is turned in mid-air straight at the head: only then is it noticed, and met."""
    threats, _ = thrown((0.0, 6.0, 0.0), speed_mps=15.0, from_m=(20.0, 0.0, 1.8))
    simulation = simulation_of(threats, duration_s=2.5)
    world = simulation.world
    for _ in range(70):
        simulation.step()
    assert events(simulation, "perceived") == []
    (row,) = world.rows(Threat, Flight)
    body = world.assets.bodies[0]
    head = np.array(target_centre(*aim_of(body, "head"), *joints_of(body, shown(world, 0)[0])))
    way = head - world[Flight].position_m[row]
    world[Flight].velocity_mps[row] = way / 0.5 - 0.25 * np.array(GRAVITY_MPS2)
    simulation.step()
    simulation.step()
    (perceived,) = events(simulation, "perceived")
    assert perceived["ttc_s"] == pytest.approx(0.5, abs=3 * TICK_S)


def test_a_ball_that_is_turned_away_is_off_and_the_guard_ends():
    threats, _ = thrown(speed_mps=20.0)
    simulation = simulation_of(threats, duration_s=2.5)
    world = simulation.world
    while world[Reaction].phase[0] != Phase.PROTECT:
        simulation.step()
    (row,) = world.rows(Threat, Flight)
    world[Flight].velocity_mps[row] = (0.0, 25.0, 5.0)
    for _ in range(4):
        simulation.step()
    assert world[Threat].strayed[row]
    assert world[Reaction].phase[0] == Phase.HOLD
    for _ in range(100):
        simulation.step()
    assert "respond" not in phases(simulation)
    assert np.isfinite(np.array(track_of(simulation).rotations)).all()
