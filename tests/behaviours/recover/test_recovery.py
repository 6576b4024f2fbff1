"""The way back: where it leads, how long it takes, on which foot, and when somebody can no longer take it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from behaviours.components import Blend, Feet, Phase, Playback, Posture, Reaction, Sustained
from behaviours.playing import clip_pose, planted_in_clip
from behaviours.recover.recovery import move_sustained_over_feet, return_blend_ticks, return_clip_s
from behaviours.respond.knocked_down import has_fallen
from behaviours.settle import feet as foot_plan
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
    at_s = world[Playback].offset_s[0] + (tick - 1) / 120
    assert at_s == pytest.approx(return_clip_s(world, 0), abs=1e-9)
    assert (world[Feet].mode[0] == foot_plan.FREE).all()


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
