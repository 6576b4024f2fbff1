"""Feet on the way to the sustained pose: who is in flight lands first, who stands stays, a step is soon over."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.components import Blend, Feet, Phase, Reaction
from behaviours.measure.measures import com_line_deviation_max_m, joint_limit_excess, runs
from behaviours.settle import feet as foot_plan
from behaviours.settle.footwork import STEP_SHARE, TOLERATED_RAD, relieve_a_foot, trouble
from behaviours.timing import TICK_S
from engine.body import support
from engine.body.kinematics import joints_of
from engine.body.skeleton import KNEES, Pose
from engine.clips.playback import planted_at
from tests.behaviours.runs import AHEAD, events, phases, run, simulation_of, track_of

ON_GUARD = (Phase.STARTLE, Phase.PROTECT)
UP_M = 0.02
SLOW = AHEAD | {"speed_mps": 23.0, "perceived_s": 0.1}  # nearly a second to get ready in


def lowest_m(track) -> np.ndarray:
    """(T, 2) the lowest point of either sole."""
    positions, orientations = joints_of(track.body, track.pose)
    soles = [support.sole_points(track.body, *joints) for joints in zip(positions, orientations, strict=True)]
    return np.array(soles)[..., 2].min(axis=2)


def longest(flags) -> int:
    return max((last - first + 1 for first, last in runs(flags)), default=0)


@pytest.mark.parametrize(("name", "start_s"), [("run", 0.2), ("run", 0.62), ("hop", 3.45)])
def test_who_is_met_in_flight_lands_as_in_the_clip(name, start_s, library_clip):
    """And is never in the air longer than the clip is, however long the ball takes to come."""
    clip = library_clip(name)
    simulation = run([SLOW], clip=clip, start_s=start_s, startle=True)
    track = track_of(simulation)
    tick = events(simulation, "perceived")[0]["tick"]
    flight = [not planted_at(clip, start_s + (k + 1) / 120).any() for k in range(tick, tick + 120)]
    assert flight[0]
    lands = tick + flight.index(False)
    assert simulation.world[Blend].lands[0] == lands
    assert events(simulation, "perceived")[0]["startle"] == "in the air"
    guarding = np.isin(track.phase, ON_GUARD)
    assert not (lowest_m(track)[lands + 3 :] > UP_M).all(axis=1)[guarding[lands + 3 :]].any()
    assert com_line_deviation_max_m(track.lines) < 0.005


def test_a_startle_leaves_the_feet_that_stand_standing(library_clip):
    """A walker's foot that is held in the startle is still held in the blend that follows: never both feet step."""
    simulation = simulation_of([SLOW], clip=library_clip("walk"), start_s=2.2, startle=True)
    modes = []
    for _ in range(simulation.ticks):
        simulation.step()
        world = simulation.world
        if world[Reaction].phase[0] in ON_GUARD:
            modes.append((int(world[Reaction].phase[0]), *world[Feet].mode[0]))
    assert "startle" in phases(simulation)
    kept = [side for side in (0, 1) if modes[0][1 + side] == foot_plan.HELD]
    assert kept
    assert all(mode[1 + side] == foot_plan.HELD for mode in modes for side in kept)


def test_a_swinging_foot_does_not_go_through_the_floor(library_clip):
    """A runner's startle: the pelvis stays over the foot that stands, and sinks; the other foot stays above it."""
    threat = SLOW | {"azimuth_deg": 16.0, "elevation_deg": 3.0, "size": 1.0}
    track = track_of(run([threat], clip=library_clip("run"), start_s=0.78, startle=True))
    startled = np.isin(track.phase, (Phase.STARTLE,))
    assert startled.any()
    assert lowest_m(track)[startled].min() > -0.02


def test_a_step_is_over_soon_where_the_leg_reaches(library_clip):
    simulation = simulation_of([SLOW], clip=library_clip("walk"), start_s=0.4, startle=False)
    while simulation.world[Reaction].phase[0] != Phase.PROTECT:
        simulation.step()
    f, world = simulation.world[Feet], simulation.world
    stepping = f.mode[0] == foot_plan.STEPPING
    assert stepping.sum() == 1
    left = world[Reaction].contact[0] - world[Reaction].since[0]
    assert f.ticks[0, stepping][0] < 0.75 * STEP_SHARE * left
    assert f.ticks[0, stepping][0] >= 0.4 * 120 - 1e-9
    while world[Reaction].phase[0] == Phase.PROTECT:
        simulation.step()
    track = track_of(simulation)
    assert com_line_deviation_max_m(track.lines) < 0.005
    assert np.degrees(joint_limit_excess(track)["protect"].value) < 0.5 + np.degrees(TOLERATED_RAD)


@pytest.mark.parametrize(
    ("start_s", "where"),
    [(0.3946, {"azimuth_deg": -123.0, "elevation_deg": 8.8, "speed_mps": 28.36, "size": 0.12}),
     (1.0646, {"azimuth_deg": -161.6, "elevation_deg": -0.5, "speed_mps": 25.81, "size": 0.21})],
)  # fmt: skip
def test_no_leg_is_snatched_straight_for_a_step_that_is_soon_over(start_s, where, library_clip):
    """A runner's long step away from where the body is: it takes longer."""
    threat = AHEAD | {"perceived_s": 0.15} | where
    track = track_of(run([threat], clip=library_clip("run"), start_s=start_s, startle=False))
    guarding = np.isin(track.phase, ON_GUARD)
    knees_m = joints_of(track.body, track.pose)[0][guarding][:, list(KNEES)]
    assert np.linalg.norm(np.diff(knees_m, 2, axis=0), axis=2).max() / TICK_S < 4.0


def test_a_foot_is_relieved_only_where_standing_is_trouble():
    simulation = simulation_of([AHEAD], startle=False)
    while simulation.world[Reaction].phase[0] != Phase.PROTECT:
        simulation.step()
    world = simulation.world
    since = int(world[Reaction].since[0])
    assert (world[Feet].mode[0] == foot_plan.HELD).all()
    assert trouble(world, 0, since, 0.0) <= 1.0
    to = Pose(world[Blend].to_root_m[0].copy(), world[Blend].to_rotations[0].copy())
    before = world[Feet].mode[0].copy()
    relieve_a_foot(world, 0, since, to, 40.0)
    np.testing.assert_array_equal(world[Feet].mode[0], before)
    # a pelvis that would have to go on beyond both straight legs: then one of them gives
    world[Blend].to_root_m[0, 0] += 0.25
    world[Blend].to_root_m[0, 2] += 0.05
    assert trouble(world, 0, since, 0.0) > 1.0


def test_the_com_comes_onto_its_line_where_a_few_tries_leave_it_off(library_clip):
    """A runner who steps away from a ball from behind: 8.6 mm off before more was tried."""
    threat = {"target": "torso", "perceived_s": 0.15, "azimuth_deg": 118.36730555154804}
    threat |= {"elevation_deg": -0.806321043718512, "speed_mps": 26.43703468824387, "size": 0.2581414969163064}
    track = track_of(run([threat], clip=library_clip("run"), start_s=0.4321052297185702, startle=True))
    assert com_line_deviation_max_m(track.lines) < 0.005
