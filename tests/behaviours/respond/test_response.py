"""The blow: how long the physics has it, what a ball may not do, who falls, how, and that the fallen lie still."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from behaviours.components import Phase
from behaviours.respond.falling import falling_rotations, side_rad
from behaviours.timing import TICK_S
from engine.body import limits
from engine.body.kinematics import joints_of
from engine.body.overlap import overlaps_m
from engine.body.skeleton import HEAD, PELVIS, WRISTS, Pose
from engine.clips.mirror import mirror_pose
from engine.maths import quaternion
from tests.behaviours.blows import SPIKE, TAP, heavy, thrown
from tests.behaviours.runs import events, mirrored_back
from tests.physics.standing import BODY, standing

FELLS = heavy(40.0, speed_mps=9.0)
EVERY_WAY = [0.0, 90.0, 180.0]


def responds_s(blow) -> float:
    """How long the physics has the body at the first contact."""
    first = next(row for row in blow.simulation.report()["phases"] if row["name"] == "respond")
    return first["to_s"] - first["from_s"]


def falls(blow) -> bool:
    return len(blow.ticks_of(Phase.DOWN)) > 0


def dealt_Ns(blow) -> float:
    return sum(event["impulse_Ns"] for event in events(blow.simulation, "contact"))


def test_a_light_blow_is_over_in_the_time_of_the_thesis_and_a_heavy_one_is_not():
    assert 0.05 <= responds_s(thrown(TAP)) <= 0.1
    assert 0.05 <= responds_s(thrown(SPIKE, 180.0)) <= 0.1
    assert responds_s(thrown(heavy(10.0, "pelvis", 8.0))) > 0.14


def test_the_heavier_the_more_is_dealt_and_whoever_falls_to_a_light_ball_falls_to_a_heavier():
    blows = [thrown(heavy(mass_kg)) for mass_kg in (0.5, 3.0, 10.0, 25.0, 40.0)]
    impulses = [dealt_Ns(blow) for blow in blows]
    assert impulses == sorted(impulses)
    fell = [falls(blow) for blow in blows]
    assert fell == sorted(fell)
    assert not fell[1]
    assert fell[3]


@pytest.mark.parametrize("azimuth_deg", EVERY_WAY)
def test_a_volleyball_knocks_nobody_down(azimuth_deg):
    assert not falls(thrown(SPIKE, azimuth_deg))
    assert not falls(thrown({**SPIKE, "target": "torso"}, azimuth_deg, protects=False))


@pytest.mark.parametrize("azimuth_deg", EVERY_WAY)
@pytest.mark.parametrize("threat", [SPIKE, heavy(3.0), heavy(25.0), heavy(25.0, "head")], ids=str)
def test_no_ball_goes_into_the_body_or_hangs_in_the_air(threat, azimuth_deg):
    blow = thrown(threat, azimuth_deg)
    ticks = blow.ticks_of(Phase.RESPOND, Phase.DOWN)[:60]
    assert max(blow.ball_depth_m(k) for k in ticks) < 0.06  # one tick of a spike, at its contact
    # free of the body it is in free fall; pressed against it, it never stands still for a tenth of a second
    still = np.linalg.norm(blow.ball_m[ticks[12:]] - blow.ball_m[ticks[:-12]], axis=1) < 0.01
    assert not still.any()


def test_a_runner_is_not_down_for_running():
    """The velocity that a clip has itself is no loss of balance."""
    blow = thrown({**SPIKE, "target": "torso"}, clip="run", protects=False)
    assert events(blow.simulation, "contact")
    assert not falls(blow)


@pytest.mark.parametrize("azimuth_deg", [0.0, 120.0, 180.0])
def test_the_fallen_come_to_rest_on_the_floor(azimuth_deg):
    blow = thrown(FELLS, azimuth_deg, duration_s=5.5)
    down = blow.ticks_of(Phase.DOWN)
    assert len(down) > 240
    joints_m = joints_of(blow.track.body, blow.track.pose)[0]
    assert joints_m[-1, [HEAD, PELVIS], 2].max() < 0.4
    moved_m = np.linalg.norm(joints_m[-60:] - joints_m[-60], axis=2).max(axis=0)
    assert moved_m[[HEAD, PELVIS]].max() < 0.01
    assert moved_m.max() < 0.05  # a hand may still slide off
    speeds_mps = np.linalg.norm(np.diff(joints_m[-60:], axis=0), axis=2) / TICK_S
    assert np.median(speeds_mps.max(axis=1)) < 0.1
    assert min(blow.lowest_m(k) for k in down) > -0.08  # as it strikes the ground
    assert min(blow.lowest_m(k) for k in down[-60:]) > -0.01
    lies = Pose(np.array(blow.track.root_m)[down], np.array(blow.track.rotations)[down])
    assert overlaps_m(blow.track.body, lies).max() < 0.02
    assert math.degrees(limits.excess_rad(blow.track.body, lies.rotations).max()) < 3.0


def test_who_falls_forwards_lands_on_the_hands_and_bends_the_knees():
    blow = thrown(FELLS, 180.0, duration_s=5.5)
    down = blow.ticks_of(Phase.DOWN)
    joints_m = joints_of(blow.track.body, blow.track.pose)[0]
    landed = next(k for k in down if joints_m[k, HEAD, 2] < 0.4)
    assert joints_m[landed, list(WRISTS), 2].min() < joints_m[landed, HEAD, 2]
    bent = [limits.components(blow.track.rotations[k][j])[1] for k in down[:60] for j in (14, 18)]
    assert max(bent) > math.radians(25.0)


def test_a_response_is_mirrored_with_its_threat():
    """To what the solver before contact leaves of symmetry, grown over the response."""
    ours = thrown({**SPIKE, "elevation_deg": 12.0}, 35.0, startle=False)
    theirs = thrown({**SPIKE, "elevation_deg": 12.0}, -35.0, startle=False, mirrored=True)
    ticks = ours.ticks_of(Phase.RESPOND)
    np.testing.assert_array_equal(ticks, theirs.ticks_of(Phase.RESPOND))
    one, other = (joints_of(blow.track.body, blow.track.pose)[0][ticks] for blow in (ours, theirs))
    np.testing.assert_allclose(one, mirrored_back(other), atol=1e-3)


def test_the_pose_of_a_fall_stays_within_limits_changes_smoothly_and_has_no_better_side():
    sides = np.radians(np.arange(-180.0, 180.5, 2.0))
    poses = [falling_rotations(BODY, side) for side in sides]
    assert limits.excess_rad(BODY, np.array(poses)).max() < 1e-9
    for one, other in itertools.pairwise(poses):
        assert max(quaternion.angle_between(a, b) for a, b in zip(one, other, strict=True)) < math.radians(6.0)
    for pose, opposite in zip(poses, poses[::-1], strict=True):
        mirrored = mirror_pose(Pose(np.zeros(3), opposite)).rotations
        assert max(quaternion.angle_between(a, b) for a, b in zip(pose, mirrored, strict=True)) < 1e-6


def test_the_side_of_a_fall_is_seen_from_the_body():
    pose = standing()
    for facing_deg, way_deg in ((0.0, 90.0), (70.0, 70.0), (-120.0, 60.0)):
        rotations = pose.rotations.copy()
        rotations[PELVIS] = quaternion.about_z(math.radians(facing_deg))
        way = (math.cos(math.radians(way_deg)), math.sin(math.radians(way_deg)), -1.0)
        side = side_rad(Pose(pose.root_m, rotations), way)
        assert math.cos(side) == pytest.approx(math.cos(math.radians(way_deg - facing_deg)))
        assert math.sin(side) == pytest.approx(math.sin(math.radians(way_deg - facing_deg)))
