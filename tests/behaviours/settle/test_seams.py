"""Seams, and what is shown on top of a source: continuous in place and velocity, within limits, never frozen."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from behaviours.blends.arm_ways import BEYOND_RAD
from behaviours.blends.leg_limits import EARLY_RAD
from behaviours.components import Phase
from behaviours.measure.measures import foot_slide_max_m, seam_jumps
from behaviours.settle.inertialise import SNATCHED_RADPS, add_remaining, calm_legs, carry_on, measure_seam
from behaviours.settle.seams import MOMENT
from behaviours.settle.settling import keep_joints, keep_swinging_legs
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.body.limb_ik import apply_leg
from engine.body.limits import beyond_limits, excess_rad
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, KNEES, Pose
from engine.maths import quaternion
from tests.behaviours.people import BODY, standing
from tests.behaviours.runs import AHEAD, run, track_of
from tests.behaviours.two_poses import on_guard

HALF_LIFE_S, DT_S = 0.07, 1e-4
ARMS_AND_TRUNK = slice(1, HIPS[0])


def turning(pose, radps: float, seconds: float):
    """A pose whose joints all turn evenly about X."""
    turn = quaternion.about_x(radps * seconds)
    rotations = np.array([quaternion.multiply(turn, tuple(q)) for q in pose.rotations])
    return pose.root_m + [0.0, 2.0 * seconds, 0.0], rotations


def test_a_residual_begins_on_the_old_motion_in_place_and_velocity_and_dies():
    """Against the old motion itself, which goes on as if there were no seam for the first moment."""
    offsets, joints = np.empty((2, 3)), np.empty((2, JOINT_COUNT, 3))
    source, now, before = on_guard(), standing(), turning(standing(), 3.0, -DT_S)
    ahead = (np.empty(3), np.empty((JOINT_COUNT, 4)))
    carry_on(*now, *before, *ahead)
    measure_seam(*source, *source, *now, *ahead, DT_S, offsets, joints)

    def shown(seconds: float) -> tuple[np.ndarray, np.ndarray]:
        root_m, rotations = source.root_m.copy(), source.rotations.copy()
        add_remaining(root_m, rotations, offsets, joints, seconds, HALF_LIFE_S)
        return root_m, rotations

    for seconds, tolerance in ((0.0, 1e-9), (1e-3, 2e-4)):
        root_m, rotations = shown(seconds)
        wanted = turning(now, 3.0, seconds)
        np.testing.assert_allclose(root_m, wanted[0], atol=tolerance)
        assert max(quaternion.angle_between(a, b) for a, b in zip(rotations, wanted[1], strict=True)) < 10.0 * tolerance
    root_m, rotations = shown(1.5)
    np.testing.assert_allclose(root_m, source.root_m, atol=1e-5)
    assert max(quaternion.angle_between(a, b) for a, b in zip(rotations, source.rotations, strict=True)) < 1e-4


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.floats(0.0, 0.5))
def test_what_a_seam_leaves_over_takes_no_joint_beyond_its_limits(seed, elapsed_s):
    """However fast the old motion was: only what it itself was beyond them at the seam is let be, as it dies away."""
    chance = np.random.default_rng(seed)
    source, offsets = standing(), np.zeros((2, JOINT_COUNT, 3))
    offsets[1] = chance.normal(size=(JOINT_COUNT, 3)) * 12.0  # radians a second, from a pose within limits
    rotations = source.rotations.copy()
    add_remaining(source.root_m.copy(), rotations, np.zeros((2, 3)), offsets, elapsed_s, HALF_LIFE_S)
    keep_joints(BODY, source.rotations, np.zeros((JOINT_COUNT, 3)), rotations)
    own = excess_rad(BODY, source.rotations)
    assert (excess_rad(BODY, rotations) - own)[list(KNEES)].max() < BEYOND_RAD
    assert (excess_rad(BODY, rotations) - own)[ARMS_AND_TRUNK].max() < BEYOND_RAD


def fast_legs(seed: int, elapsed_s: float):
    """What an old motion that turned all joints fast makes of a standing pose after a time."""
    offsets = np.zeros((2, JOINT_COUNT, 3))
    offsets[1] = np.random.default_rng(seed).normal(size=(JOINT_COUNT, 3)) * 12.0
    rotations = standing().rotations.copy()
    add_remaining(standing().root_m.copy(), rotations, np.zeros((2, 3)), offsets, elapsed_s, HALF_LIFE_S)
    return rotations


@settings(max_examples=40)
@given(st.integers(0, 10_000), st.floats(0.0, 0.5), st.floats(0.0, 1.0))
def test_a_leg_in_the_air_stays_within_its_limits_and_one_that_bears_where_it_is(seed, elapsed_s, bears):
    swung = fast_legs(seed, elapsed_s)
    kept, legs = swung.copy(), [HIPS[0], ANKLES[0]]
    own = excess_rad(BODY, standing().rotations)
    share = np.array([bears, 1.0])
    keep_swinging_legs(BODY, standing().rotations, np.zeros((JOINT_COUNT, 3)), share, kept)
    before, after = ((excess_rad(BODY, rotations) - own)[legs] for rotations in (swung, kept))
    assert (after < np.maximum(bears * before, 0.0) + BEYOND_RAD).all()
    np.testing.assert_array_equal(kept[HIPS[1] :], swung[HIPS[1] :])


def test_a_seam_itself_is_left_alone_however_far_beyond_its_limits_the_old_motion_was():
    offsets = np.zeros((2, JOINT_COUNT, 3))
    offsets[0] = 1.2
    rotations = standing().rotations.copy()
    add_remaining(standing().root_m.copy(), rotations, np.zeros((2, 3)), offsets, 0.0, HALF_LIFE_S)
    shown = rotations.copy()
    assert excess_rad(BODY, shown).max() > 0.3
    beyond = beyond_limits(BODY.limit_low_rad + EARLY_RAD, BODY.limit_high_rad - EARLY_RAD, shown)
    keep_joints(BODY, standing().rotations, beyond, shown)
    np.testing.assert_allclose(shown, rotations, atol=1e-9)


def still_ticks(track, phases) -> int:
    """How many ticks of some phases show, joint for joint, what the tick before showed."""
    joints_m = joints_of(track.body, track.pose)[0]
    moved_m = np.abs(np.diff(joints_m, axis=0)).max(axis=(1, 2))
    return int((moved_m[np.isin(track.phase, phases)[1:]] < 1e-7).sum())


def test_no_frame_of_a_hold_is_frozen(missed):
    assert Phase.HOLD in track_of(missed).phase
    assert still_ticks(track_of(missed), (Phase.PROTECT, Phase.HOLD)) == 0


@pytest.fixture(scope="module")
def early():
    """A threat from the side, noticed early: the movement takes no longer than from ahead, and then there is time."""
    aside = AHEAD | {"azimuth_deg": 80.0, "speed_mps": 24.0}
    return run([aside], startle=False, settings={"timing": {"angle_free": True}})


def test_a_pause_is_filled_by_a_swing_that_dies(early):
    track = track_of(early)
    assert still_ticks(track, (Phase.PROTECT,)) == 0


def test_knees_that_move_the_least_make_a_whole_run_without_a_jump():
    """The thesis's rule, selected: it ends elsewhere than the sustained knee, and nothing of that shows as a jump."""
    simulation = run([AHEAD], startle=True, duration_s=2.6, settings={"blend": {"knee_rule": "least"}})
    track = track_of(simulation)
    jump_m, jump_mps = seam_jumps(track)
    assert jump_m < 0.0005
    assert jump_mps < 0.05
    assert foot_slide_max_m(track) < 0.002


def sunk(down_m: float) -> tuple[np.ndarray, np.ndarray]:
    """Standing on dead straight legs, the pelvis so much lower, the ankles where they were."""
    root_m, rotations = standing().root_m - [0.0, 0.0, down_m], standing().rotations.copy()
    rotations[[*HIPS, *KNEES]] = quaternion.IDENTITY
    ankles_m = joints_of(BODY, Pose(standing().root_m, rotations))[0][list(ANKLES)]
    positions, orientations = joints_of(BODY, Pose(root_m, rotations))
    for side in range(2):
        apply_leg(
            BODY, rotations, positions, orientations, side, ankles_m[side], np.array(quaternion.IDENTITY), 0.0, 0.0
        )
    return root_m, rotations


def test_a_leg_that_is_dead_straight_is_not_turned_over_by_a_seam():
    """Its knee leaves at a speed without bounds; a tick later the pose is still near the source's."""
    source, later = sunk(1e-7), sunk(4e-6)
    offsets, joints = np.empty((2, 3)), np.empty((2, JOINT_COUNT, 3))
    measure_seam(*source, *later, *source, *source, MOMENT * TICK_S, offsets, joints)
    speeds = np.linalg.norm(joints[1, [*HIPS, *KNEES]], axis=1)
    assert speeds.min() > 2.0 * SNATCHED_RADPS
    calm_legs(joints)
    calmed = np.linalg.norm(joints[1, [*HIPS, *KNEES]], axis=1)
    assert calmed.max() < 0.5 * SNATCHED_RADPS
    np.testing.assert_allclose(calmed / calmed[0], speeds / speeds[0], rtol=1e-9)
    root_m, rotations = source[0].copy(), source[1].copy()
    add_remaining(root_m, rotations, offsets, joints, TICK_S, HALF_LIFE_S)
    turned = [quaternion.angle_between(rotations[j], source[1][j]) for j in (*HIPS, *KNEES)]
    assert max(turned) < np.radians(10.0)


@given(st.integers(0, 10_000))
def test_what_legs_can_do_is_kept_to_the_last_bit(seed):
    chance = np.random.default_rng(seed)
    joints = chance.normal(size=(2, JOINT_COUNT, 3))
    joints[1] *= chance.uniform(0.0, SNATCHED_RADPS, (JOINT_COUNT, 1)) / np.linalg.norm(joints[1], axis=1)[:, None]
    joints[1, : HIPS[0]] *= 10.0  # arms may be faster
    before = joints.copy()
    calm_legs(joints)
    np.testing.assert_array_equal(joints, before)
