"""The way back: where it leads, how long it takes, on which foot, and when somebody can no longer take it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from behaviours.components import Blend, Feet, Phase, Posture, Reaction, Sustained
from behaviours.playing import (
    clip_pose,
    clip_time_s,
    pace_after,
    pace_rise,
    planted_in_clip,
    play_from,
    return_clip_s,
)
from behaviours.recover.recovery import move_sustained_over_feet, return_blend_ticks
from behaviours.respond.knocked_down import has_fallen
from behaviours.settle import feet as foot_plan
from behaviours.settle.sources import still_to_play_s
from engine.body.footing import sole_depth_m
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import ANKLES, PELVIS, Pose
from engine.clips.playback import planted_at
from engine.maths import quaternion
from tests.behaviours.runs import AHEAD, simulation_of, track_of

ANKLE_ROWS = list(ANKLES)


def until(phase: Phase, clip="sway", threat=AHEAD, **more):
    """A run that has just entered a phase."""
    simulation = simulation_of([threat], clip=clip, startle=False, duration_s=4.0, **more)
    for _ in range(simulation.ticks):
        simulation.step()
        if simulation.world[Reaction].phase[0] == phase:
            return simulation
    raise AssertionError(f"never came to {phase.name}")


def test_the_return_takes_half_a_second_of_which_a_quarter_is_part_one_s():
    simulation = until(Phase.RECOVER_BLEND)
    world = simulation.world
    blend, since = world[Blend], world[Reaction].since[0]
    assert return_blend_ticks(world) == pytest.approx(60.0)
    # it begins 135 ms into part one, and has 125 ms of it
    assert blend.since[0] - (since - 1) == pytest.approx(31 - 15, abs=1)
    assert blend.ticks[0] == pytest.approx(60.0)


def test_it_leads_to_the_clip_a_sixth_of_a_second_after_perception():
    world = until(Phase.RECOVER_BLEND).world
    assert return_clip_s(world, 0) == pytest.approx(world[Reaction].clip_s[0] + 1 / 6)
    back = clip_pose(world, 0, return_clip_s(world, 0))
    np.testing.assert_allclose(world[Blend].to_rotations[0], back.rotations, atol=1e-12)
    np.testing.assert_allclose(world[Blend].to_root_m[0], back.root_m, atol=1e-12)


def test_who_was_met_in_a_flight_of_the_clip_goes_back_to_its_next_landing(library_clip):
    """`hop` is in the air at 3.45 s + 1/6 s; back into that pose one would have to float up."""
    clip = library_clip("hop")
    simulation = until(Phase.RECOVER_BLEND, clip=clip, start_s=3.35, threat=AHEAD | {"perceived_s": 0.1})
    world = simulation.world
    perceived_s = 3.35 + 13 / 120
    assert not planted_at(clip, perceived_s + 1 / 6).any()
    entered_s = return_clip_s(world, 0)
    assert planted_at(clip, entered_s).any()
    assert not planted_at(clip, entered_s - 1 / 120).any()  # no later than need be
    assert perceived_s + 1 / 6 < entered_s < perceived_s + 1 / 6 + 0.6
    before_m = simulation.observer.tracks[0].root_m[-1][2]
    for _ in range(80):
        simulation.step()
    rises_m = np.array([root[2] for root in simulation.observer.tracks[0].root_m[-80:]]) - before_m
    assert rises_m.max() < 0.2


@pytest.mark.parametrize("azimuth", [30.0, -70.0])
def test_the_foot_that_supports_the_return_pose_stands_where_it_stood(azimuth, library_clip):
    simulation = until(Phase.RECOVER_BLEND, clip=library_clip("walk"), threat=AHEAD | {"azimuth_deg": azimuth})
    world = simulation.world
    side = int(world[Blend].support[0])
    back = clip_pose(world, 0, return_clip_s(world, 0))
    at, turned = joints_of(track_of(simulation).body, back)
    if planted_in_clip(world, 0, return_clip_s(world, 0)).any():
        assert planted_in_clip(world, 0, return_clip_s(world, 0))[side]
    np.testing.assert_allclose(at[ANKLES[side], :2], world[Feet].ankle_m[0, side, :2], atol=1e-9)
    assert quaternion.heading(turned[ANKLES[side]]) == pytest.approx(
        quaternion.heading(world[Feet].turned[0, side]), abs=1e-6
    )


def test_after_a_blow_the_feet_are_set_down_flat_where_they_are():
    simulation = until(Phase.RECOVER_BLEND)
    world, body = simulation.world, track_of(simulation).body
    shown = joints_of(body, Pose(world[Posture].before_root_m[0], world[Posture].before_rotations[0]))[0]
    for side in range(2):
        assert world[Feet].mode[0, side] != foot_plan.FREE
        stands = world[Feet].from_m[0, side]
        assert stands[2] == pytest.approx(sole_depth_m(body, side), abs=0.02)
        assert np.linalg.norm(stands[:2] - shown[ANKLES[side], :2]) < 0.03


def test_the_sustained_pose_goes_with_the_feet():
    world = until(Phase.RECOVER_BLEND).world
    before = world[Sustained].root_m[0].copy()
    body = world.assets.bodies[0]
    at, _ = joints_of(body, Pose(world[Sustained].root_m[0], world[Sustained].rotations[0]))
    for side in range(2):
        world[Feet].ankle_m[0, side] = at[ANKLES[side]] + [0.2, -0.1, 0.05]
    move_sustained_over_feet(world, 0)
    np.testing.assert_allclose(world[Sustained].root_m[0] - before, [0.2, -0.1, 0.0], atol=1e-12)


def test_the_clip_runs_on_from_where_the_return_ends():
    simulation = until(Phase.RECOVER_RETURN)
    while simulation.world[Reaction].phase[0] == Phase.RECOVER_RETURN:
        simulation.step()
    world, tick = simulation.world, simulation.world.tick - 1
    assert clip_time_s(world, 0, tick - 1) == pytest.approx(return_clip_s(world, 0), abs=1e-9)
    assert (world[Feet].mode[0] == foot_plan.FREE).all()


def test_of_a_lead_so_much_is_left_that_its_pace_rises_evenly_from_none_to_the_clip_s_own():
    lead_s, left_s = 0.15, np.linspace(0.5, 0.0, 501)
    to_play_s = np.array([still_to_play_s(float(left), lead_s, pace_rise(lead_s)) for left in left_s])
    assert to_play_s[left_s >= 2.0 * lead_s] == pytest.approx(lead_s, abs=1e-12)
    assert to_play_s[-1] == pytest.approx(0.0, abs=1e-12)
    pace = np.diff(to_play_s) / np.diff(left_s)
    rising = np.diff(pace)[left_s[2:] < 0.298]
    assert rising == pytest.approx(rising.mean(), rel=1e-6)
    assert pace[-1] == pytest.approx(1.0, abs=0.005)


@pytest.mark.parametrize("played_s", [0.0, 0.05, 0.15])
def test_a_clip_that_is_taken_up_again_comes_to_its_own_pace_without_a_jump(played_s):
    world = until(Phase.RECOVER_RETURN).world
    play_from(world, 0, 500, 2.0, pace_after(played_s, 0.15))
    times_s = np.array([clip_time_s(world, 0, tick) for tick in np.linspace(500, 560, 601)])
    pace = np.diff(times_s) * 1200
    assert times_s[0] == pytest.approx(2.0, abs=1e-12)
    assert pace[0] == pytest.approx(math.sqrt(played_s / 0.15), abs=0.01)
    assert pace[-1] == pytest.approx(1.0, abs=1e-9)
    assert np.diff(pace).min() > -1e-9  # never slower again,
    assert np.diff(pace).max() < 1.001 / 0.3 / 1200  # and evenly


def test_a_clip_has_its_own_pace_from_before_a_run_begins():
    world = simulation_of([], clip="sway").world
    times_s = [clip_time_s(world, 0, tick) for tick in (-2.0, -1.0, 0.0, 1.0)]
    assert np.diff(times_s) == pytest.approx(1 / 120, abs=1e-12)


@pytest.mark.parametrize(("clip", "start_s", "own_mps"), [("walk", 0.3, 1.5), ("walk", 0.75, 1.5), ("run", 0.3, 3.4)])
def test_nobody_sets_off_at_full_speed_from_standing_still(clip, start_s, own_mps, library_clip):
    """Back in the clip they come to its speed gently: not, as it was, within two hundredths of a second."""
    simulation = until(Phase.RECOVER_RETURN, clip=library_clip(clip), start_s=start_s)
    while simulation.world[Reaction].phase[0] == Phase.RECOVER_RETURN:
        simulation.step()
    for _ in range(40):
        simulation.step()
    track = track_of(simulation)
    first = int(np.flatnonzero(np.array(track.phase) == Phase.RECOVER_RETURN)[0])
    speeds_mps = np.linalg.norm(np.diff(np.array(track.root_m)[first:, :2], axis=0), axis=1) * 120
    assert speeds_mps[-1] > 0.7 * own_mps
    assert (speeds_mps[6:] - speeds_mps[:-6]).max() < 0.5 * own_mps  # in a twentieth of a second


def shown_moving(world, velocity_mps, tipped_deg=0.0):
    """Sets what is shown now and a tick before so that the whole body moves like that."""
    p = world[Posture]
    p.before_root_m[0] = p.root_m[0] - np.array(velocity_mps) / 120
    p.before_rotations[0] = p.rotations[0]
    if tipped_deg:
        turn = quaternion.from_rotation_vector((0.0, math.radians(tipped_deg), 0.0))
        for rotations in (p.rotations, p.before_rotations):
            rotations[0, PELVIS] = quaternion.multiply(turn, rotations[0, PELVIS])
    return p


@pytest.mark.parametrize("azimuth_deg", [0.0, 30.0])
def test_the_foot_that_bears_the_way_back_does_not_glide_with_the_clip(azimuth_deg, library_clip):
    """This walk's heel is low all through its landing: the foot comes to stand in the last ticks only, and the way back
    must not begin before."""
    threat = {
        "target": "head",
        "perceived_s": 0.5,
        "azimuth_deg": azimuth_deg,
        "elevation_deg": 10.0,
        "speed_mps": 26.0,
    }
    simulation = simulation_of([threat], clip=library_clip("walk"), start_s=0.5, startle=False, duration_s=4.0)
    for _ in range(simulation.ticks):
        simulation.step()
    track = track_of(simulation)
    back = np.equal(track.phase, Phase.RECOVER_RETURN)
    side = int(simulation.world[Blend].support[0])
    ankles_m = joints_of(track.body, track.pose)[0][back, ANKLES[side]]
    assert np.linalg.norm(np.diff(ankles_m[:, :2], axis=0), axis=1).sum() < 0.03


def test_whoever_stands_still_has_not_fallen():
    world = until(Phase.PROTECT).world
    shown_moving(world, (0.0, 0.0, 0.0))
    assert not has_fallen(world, 0)


def test_who_moves_faster_than_the_feet_can_follow_has_fallen():
    """The capture point of an inverted pendulum is the COM plus velocity times sqrt(height / g): so far beyond the feet
    that they reach, or not."""
    world = until(Phase.PROTECT).world
    body = world.assets.bodies[0]
    p = shown_moving(world, (0.0, 0.0, 0.0))
    com = com_of(body, Pose(p.root_m[0], p.rotations[0]))
    toes_m = joints_of(body, Pose(p.root_m[0], p.rotations[0]))[0][ANKLE_ROWS, 0].max() + 0.25
    allowed_m = toes_m - com[0] + world.assets.settings.recovery.capture_beyond_m
    limit_mps = allowed_m / math.sqrt(com[2] / 9.80665)
    shown_moving(world, (0.7 * limit_mps, 0.0, 0.0))
    assert not has_fallen(world, 0)
    shown_moving(world, (1.3 * limit_mps, 0.0, 0.0))
    assert has_fallen(world, 0)


def test_whose_hips_are_down_has_fallen():
    world = until(Phase.PROTECT).world
    world[Posture].root_m[0, 2] *= 0.45
    shown_moving(world, (0.0, 0.0, 0.0))
    assert has_fallen(world, 0)
