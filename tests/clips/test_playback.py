"""A clip at any time: exact at its frames, smooth between them and round its loop, carried on along its path."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, PELVIS, Pose
from engine.clips.clip import Loop
from engine.clips.importing import import_clip
from engine.clips.playback import path_after, planted_at, sample
from engine.clips.synthetic import sway
from engine.maths import rotations
from tests.clips.people import swing_arms, write_person


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    """Half a second that does not loop, at 60 Hz."""
    roots = np.cumsum(np.full((31, 3), [0.001, 0.0, 0.004]), axis=0) + [0.0, 0.94, 0.0]
    return import_clip(write_person(tmp_path_factory.mktemp("p") / "plain.bvh", swing_arms(31)[:31], roots=roots))


def places(clip, time_s):
    return joints_of(clip.body, sample(clip, time_s))[0]


def assert_smooth(clip, time_s, jump_mps=0.02):
    """Position and velocity from both sides of a moment are the same."""
    h = 1e-5
    before = (places(clip, time_s) - places(clip, time_s - h)) / h
    after = (places(clip, time_s + h) - places(clip, time_s)) / h
    np.testing.assert_allclose(places(clip, time_s - 1e-9), places(clip, time_s + 1e-9), atol=1e-6)
    assert np.abs(after - before).max() < jump_mps


def test_every_frame_is_exact_and_both_ends_hold(plain):
    assert not plain.loops
    for frame in (0, 1, 7, 29, 30):
        pose = sample(plain, frame / plain.fps)
        np.testing.assert_allclose(pose.root_m, plain.pose.root_m[frame], atol=1e-12)
        np.testing.assert_allclose(pose.rotations, plain.pose.rotations[frame], atol=1e-12)
    np.testing.assert_array_equal(sample(plain, -3.0).root_m, sample(plain, 0.0).root_m)
    np.testing.assert_array_equal(sample(plain, 99.0).rotations, sample(plain, plain.duration_s).rotations)


def test_between_frames_it_is_a_slerp_to_within_the_noise_of_capture(plain):
    for time_s in (0.055, 0.2041, 0.49):
        frame = int(time_s * plain.fps)
        pair = plain.pose.rotations[frame : frame + 2]
        pose = sample(plain, time_s)
        for joint in range(21):
            keys = Rotation.from_quat(pair[:, joint], scalar_first=True)
            expected = Slerp([frame, frame + 1], keys)([time_s * plain.fps])[0]
            apart = (expected.inv() * Rotation.from_quat(pose.rotations[joint], scalar_first=True)).magnitude()
            assert np.degrees(apart) < 0.1
    np.testing.assert_allclose(np.linalg.norm(pose.rotations, axis=-1), 1.0, atol=1e-12)


def test_velocity_has_no_jump_at_a_frame(plain):
    for frame in (1, 2, 15, 29):
        assert_smooth(plain, frame / plain.fps, jump_mps=2e-3)


def test_a_loop_has_no_seam(library_clip):
    for name in ("walk", "run", "stand", "sway"):
        clip = sway() if name == "sway" else library_clip(name)
        assert clip.loops
        end = clip.loop.last / clip.fps
        blend, period = clip.loop.blend / clip.fps, (clip.loop.last - clip.loop.first) / clip.fps
        for moment in (end, end - blend, end - 0.5 * blend, end + period, end + 7 * period):
            assert_smooth(clip, moment)


def test_a_walk_walks_on(library_clip):
    walk = library_clip("walk")
    period = (walk.loop.last - walk.loop.first) / walk.fps
    roots = np.array([sample(walk, 1.5 + k * period).root_m for k in range(6)])
    np.testing.assert_allclose(np.diff(roots, axis=0), [[walk.loop.x_m, walk.loop.y_m, 0.0]] * 5, atol=1e-9)
    assert np.linalg.norm([walk.loop.x_m, walk.loop.y_m]) / period == pytest.approx(1.5, abs=0.1)
    for k in range(3):
        np.testing.assert_array_equal(planted_at(walk, 1.0), planted_at(walk, 1.0 + k * period))


def test_a_standing_foot_stays_through_the_seam_of_a_standing_loop(library_clip):
    stand = library_clip("stand")
    times = np.linspace(0.0, 4 * stand.duration_s, 400)
    feet = np.array([places(stand, t)[list(ANKLES)] for t in times])
    assert np.abs(feet - feet.mean(axis=0)).max() < 0.01


def test_a_turning_loop_goes_round_in_a_circle():
    """Four rounds that each go one metre ahead and turn left by a right angle come home."""
    clip = sway()
    turning = clip.loop._replace(x_m=1.0, y_m=0.0, yaw_rad=np.pi / 2)
    x, y, yaw = path_after(turning, 4.0)
    assert (x, y) == pytest.approx((0.0, 0.0), abs=1e-12)
    assert yaw == pytest.approx(2 * np.pi)
    assert path_after(turning, 2.0) == pytest.approx((1.0, 1.0, np.pi))
    assert path_after(turning, 3.0)[:2] == pytest.approx((0.0, 1.0))
    assert path_after(clip.loop._replace(x_m=0.5, y_m=-0.25), 10.0) == pytest.approx((5.0, -2.5, 0.0))
    # a very small turn is nearly none
    nearly = path_after(clip.loop._replace(x_m=1.0, yaw_rad=2e-9), 10.0)
    assert nearly == pytest.approx((10.0, 0.0, 0.0), abs=1e-6)


def test_the_pose_turns_with_the_path():
    clip = sway()
    turning = replace(clip, loop=Loop(3.0, 483.0, 3.0, 1.0, 0.0, 1.0))
    before, after = sample(turning, 1.0), sample(turning, 9.0)
    assert float(
        rotations.heading(after.rotations[PELVIS]) - rotations.heading(before.rotations[PELVIS])
    ) == pytest.approx(1.0)
    expected = rotations.rotate(rotations.about_z(1.0), before.root_m) + [1.0, 0.0, 0.0]
    np.testing.assert_allclose(after.root_m, expected, atol=1e-12)
    np.testing.assert_allclose(after.rotations[1:], before.rotations[1:], atol=1e-12)


def test_one_frame_can_be_played():
    clip = sway()
    one = replace(clip, pose=Pose(clip.pose.root_m[:1], clip.pose.rotations[:1]), planted=clip.planted[:1], loop=Loop())
    np.testing.assert_allclose(sample(one, 0.5).root_m, clip.pose.root_m[0])
    assert planted_at(one, 5.0).all()


def test_sampling_is_the_same_to_the_last_bit():
    clip = sway()
    for time_s in (0.0, 3.7, 8.04, 1000.123):
        first, second = sample(clip, time_s), sample(clip, time_s)
        assert (
            first.root_m.tobytes() + first.rotations.tobytes() == second.root_m.tobytes() + second.rotations.tobytes()
        )
