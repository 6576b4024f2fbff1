"""Threats taking off: what a scenario says of them is what they do."""

from __future__ import annotations

import math

import numpy as np
import pytest

from behaviours.components import Flight, Posture, Script, Threat
from behaviours.launching import velocity_towards
from behaviours.timing import TICK_S, time_to_contact_s
from engine.body.kinematics import joints_of
from engine.body.skeleton import HEAD, PELVIS
from engine.maths.ballistics import GRAVITY_MPS2, fly
from tests.behaviours.runs import AHEAD, events, run, simulation_of, track_of


def launched(threat, ticks=40, **more):
    """A simulation with the threat in the air, its row, and its state as it was launched."""
    simulation = simulation_of([threat], startle=False, **more)
    for _ in range(ticks):
        simulation.step()
        rows = simulation.world.rows(Flight)
        if len(rows):
            return simulation, int(rows[0])
    raise AssertionError("nothing was launched")


def test_a_scripted_threat_takes_off_when_it_is_perceived():
    simulation, row = launched(AHEAD)
    assert simulation.world.tick - 1 == round(AHEAD["perceived_s"] / TICK_S)
    threat = simulation.world[Threat]
    assert threat.scripted[row]
    assert threat.noticed[row]
    assert len(simulation.world.rows(Script)) == 0
    (event,) = events(simulation, "launched")
    assert event["target"] == "head"
    assert event["elevation_raised_deg"] == 0.0


def test_it_is_perceived_one_time_to_contact_before(library_clip):
    for azimuth in (0.0, 90.0, 180.0):
        simulation, row = launched(AHEAD | {"azimuth_deg": azimuth})
        settings = simulation.world.assets.settings.timing
        (event,) = events(simulation, "launched")
        speed_norm = (26.0 - 22.8) / (29.7 - 22.8)
        # the cosine to where it comes from, ten degrees up
        wanted = time_to_contact_s(speed_norm, math.cos(math.radians(azimuth)) * math.cos(math.radians(10.0)), settings)
        assert event["ttc_s"] == pytest.approx(wanted, abs=TICK_S)
        assert simulation.world[Threat].contact[row] - (simulation.world.tick - 1) == round(event["ttc_s"] / TICK_S)


def test_where_it_will_be_at_contact_is_its_line_and_its_tangent():
    simulation, row = launched(AHEAD)
    f, t = simulation.world[Flight], simulation.world[Threat]
    left_s = (t.contact[row] - (simulation.world.tick - 1)) * TICK_S
    at, mps = fly(f.position_m[row], f.velocity_mps[row], GRAVITY_MPS2, 0.0, left_s)
    np.testing.assert_allclose(at, t.line_m[row], atol=1e-3)
    np.testing.assert_allclose(np.array(mps) / math.dist(mps, (0, 0, 0)), t.tangent[row], atol=1e-4)
    assert math.dist(mps, (0, 0, 0)) == pytest.approx(26.0, abs=1e-3)
    come_from = -np.array(mps)
    assert math.degrees(math.asin(come_from[2] / 26.0)) == pytest.approx(10.0, abs=0.1)


@pytest.mark.parametrize(("target", "joint"), [("head", HEAD), ("pelvis", PELVIS), ("left_wrist", None)])
def test_it_aims_at_what_the_scenario_names(target, joint):
    """The aim is the target in the rules pose: near where the target is, and below the head for the pelvis."""
    simulation, row = launched(AHEAD | {"target": target})
    height = simulation.world[Threat].line_m[row, 2]
    if joint == HEAD:
        assert 1.3 < height < 1.9
    elif joint == PELVIS:
        assert 0.8 < height < 1.15
    else:
        assert 0.6 < height < 1.3


@pytest.mark.parametrize("clip", ["walk", "run"])
@pytest.mark.parametrize("azimuth_deg", [30.0, -100.0, 180.0])
def test_who_sees_nothing_coming_walks_into_it(clip, azimuth_deg, library_clip):
    """It is aimed at where the head will be, not at where it is, nor at where a head that leans away would be."""
    threat = AHEAD | {"azimuth_deg": azimuth_deg, "speed_mps": 23.0}
    simulation = run([threat], clip=library_clip(clip), protects=False, duration_s=2.0)
    (launched_at,) = events(simulation, "launched")
    touched = events(simulation, "contact")[0]
    assert touched["part"] in ("head", "neck")
    assert abs(touched["late_s"]) < TICK_S
    heads_m = joints_of(track_of(simulation).body, track_of(simulation).pose)[0][:, HEAD]
    assert np.linalg.norm(heads_m[touched["tick"]] - heads_m[launched_at["tick"]]) > 0.5  # walked on meanwhile


def test_nor_does_a_path_that_is_shortened_miss_them(library_clip):
    """A level ball that would lead under ground is perceived later instead: the head is elsewhere by then."""
    low = AHEAD | {"elevation_deg": -3.0, "speed_mps": 22.8}
    settings = {"threats": {"low_path": "shorten"}}
    simulation = run([low], clip=library_clip("walk"), protects=False, duration_s=2.0, settings=settings)
    assert events(simulation, "launched")[0]["ttc_shortened_s"] > 0.1
    assert events(simulation, "contact")[0]["part"] in ("head", "neck")


def test_a_point_is_thrown_at_as_it_is():
    point = [0.4, 0.3, 1.2]
    ball = {"free": True, "position_m": [8.0, 0.0, 1.6], "speed_mps": 15.0, "target": point}
    simulation, row = launched(ball)
    f = simulation.world[Flight]
    nearest = min(
        math.dist(fly(f.position_m[row], f.velocity_mps[row], GRAVITY_MPS2, 0.0, k / 1200)[0], point)
        for k in range(1200)
    )
    assert nearest < 0.02


def test_velocity_towards_hits_the_place_after_the_way_at_that_speed():
    start, place = (7.0, -2.0, 1.9), (0.1, 0.2, 1.5)
    velocity = velocity_towards(start, place, 14.0)
    flight_s = math.dist(start, place) / 14.0
    np.testing.assert_allclose(fly(start, velocity, GRAVITY_MPS2, 0.0, flight_s)[0], place, atol=1e-9)


def test_a_free_threat_is_released_when_it_is_said_and_as_it_is_said():
    ball = {"free": True, "position_m": [8.0, 1.0, 1.6], "velocity_mps": [-15.0, 0.0, 2.0], "released_s": 0.25}
    simulation, row = launched(ball)
    assert simulation.world.tick - 1 == 30
    np.testing.assert_allclose(simulation.world[Flight].velocity_mps[row], [-15.0, 0.0, 2.0], atol=0.1)
    assert not simulation.world[Threat].scripted[row]


def test_a_low_flat_path_is_raised_and_said_so():
    slow = {"target": "head", "perceived_s": 0.1, "azimuth_deg": 0.0, "elevation_deg": 0.0, "speed_mps": 22.8}
    simulation, _ = launched(slow)
    assert events(simulation, "launched")[0]["elevation_raised_deg"] > 5.0
    simulation, _ = launched(slow, settings={"threats": {"low_path": "shorten"}})
    (event,) = events(simulation, "launched")
    assert event["elevation_raised_deg"] == 0.0
    assert event["ttc_shortened_s"] > 0.2


def test_somebody_who_stands_turned_and_elsewhere_gets_the_same_ball():
    """Direction and aim are the character's own: turn and shift everything, and the flight is turned and shifted."""
    here, row = launched(AHEAD)
    there, other = launched(AHEAD, position_m=[3.0, -2.0], heading_deg=90.0)
    (f, p), (g, q) = ((s.world[Flight], s.world[Posture]) for s in (here, there))
    ours = f.position_m[row] - p.root_m[0]
    theirs = g.position_m[other] - q.root_m[0]
    np.testing.assert_allclose([-ours[1], ours[0], ours[2]], theirs, atol=1e-6)
    assert track_of(there).tick == track_of(here).tick
