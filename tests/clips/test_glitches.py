"""Glitches of a frame or two are found and bridged; motion, however fast, is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, ELBOWS, JOINTS, MIRRORED, NECK, PELVIS, WAIST, WRISTS, Pose
from engine.clips.glitches import mend_glitches
from engine.clips.importing import import_clip
from engine.clips.mirror import mirror_clip
from engine.clips.synthetic import sway
from engine.maths import rotations
from tests.clips.people import swing_arms, write_person

FPS = 120.0
AMC = ["01_01", "02_01", "02_03", "02_05", "05_02", "07_04", "11_01", "135_04",
       "14_02", "14_31", "14_37", "16_01", "16_08", "16_17", "16_33", "49_18"]  # fmt: skip
FILES = [*(f"asfamc/{name}.amc" for name in AMC), "bvh/13_26.bvh"]
LIBRARY = ["walk", "run", "dance", "stand", "kneel"]


def smooth_motion(frames=120, tempo=1.0):
    """Every joint turns to and fro about an axis of its own at two hertz or so; the pelvis goes ahead, up and down."""
    chance = np.random.default_rng(3)
    time_s = np.arange(frames)[:, None] / FPS
    rate = 2.0 * np.pi * chance.uniform(1.0, 2.0, len(JOINTS)) * tempo
    angle = np.radians(25.0) * np.sin(rate * time_s + chance.uniform(0.0, 6.0, len(JOINTS)))
    axis = chance.normal(size=(len(JOINTS), 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    root_m = np.column_stack([1.4 * time_s, 0.02 * np.sin(6.0 * time_s), 0.9 + 0.03 * np.sin(12.0 * time_s)])
    return Pose(root_m, rotations.continuity(rotations.from_axis_angle(axis, angle)))


def turned(pose, frame, joint, degrees, axis=(0.6, 0.0, 0.8)):
    """The pose with one joint of one frame turned away, in its own frame."""
    local = pose.rotations.copy()
    turn = rotations.from_axis_angle(np.array(axis), np.radians(degrees))
    local[frame, joint] = rotations.multiply(local[frame, joint], turn)
    return Pose(pose.root_m, local)


def off_deg(a, b):
    """(F, J) degrees between the joints of two poses."""
    return np.degrees(rotations.angle_between(a.rotations, b.rotations))


def test_a_smooth_motion_comes_back_itself():
    for pose in (smooth_motion(), smooth_motion(tempo=3.0), sway().pose):
        mended, glitches = mend_glitches(pose, FPS)
        assert mended is pose
        assert glitches == []


@pytest.mark.parametrize("degrees", [6.0, 20.0, 90.0, 170.0])
@pytest.mark.parametrize("joint", [PELVIS, NECK, ELBOWS[0], WRISTS[1], ANKLES[0]])
def test_one_planted_frame_is_found_and_nothing_else_touched(joint, degrees):
    smooth = smooth_motion()
    mended, [glitch] = mend_glitches(turned(smooth, 60, joint, degrees), FPS)
    assert glitch == (60, 60, (JOINTS[joint],))
    # what a cubic misses of five hertz in a frame
    assert off_deg(mended, smooth).max() < 0.3
    others = np.ones(smooth.rotations.shape[:2], bool)
    others[60, joint] = False
    np.testing.assert_array_equal(mended.rotations[others], smooth.rotations[others])
    np.testing.assert_array_equal(mended.root_m, smooth.root_m)


def test_two_planted_frames_are_found_together():
    smooth = smooth_motion()
    glitched = turned(turned(smooth, 40, ELBOWS[1], 8.0), 41, ELBOWS[1], -11.0)
    mended, [glitch] = mend_glitches(glitched, FPS)
    assert glitch == (40, 41, (JOINTS[ELBOWS[1]],))
    assert off_deg(mended, smooth).max() < 0.3


def test_many_are_each_found():
    smooth, planted = smooth_motion(600), []
    chance = np.random.default_rng(8)
    glitched = smooth
    for frame in range(12, 590, 16):
        joint = int(chance.integers(len(JOINTS)))
        glitched = turned(glitched, frame, joint, float(chance.uniform(6.0, 60.0)), axis=(0.0, 1.0, 0.0))
        planted.append((frame, frame, (JOINTS[joint],)))
    mended, glitches = mend_glitches(glitched, FPS)
    assert glitches == planted
    assert off_deg(mended, smooth).max() < 0.3


def test_the_root_is_found():
    smooth = smooth_motion()
    root_m = smooth.root_m.copy()
    root_m[30] += [0.0, 0.03, -0.02]
    mended, [glitch] = mend_glitches(Pose(root_m, smooth.rotations), FPS)
    assert glitch == (30, 30, ("root",))
    assert np.linalg.norm(mended.root_m - smooth.root_m, axis=1).max() < 2e-4
    np.testing.assert_array_equal(mended.rotations, smooth.rotations)


def test_a_pelvis_astray_from_under_a_body_that_is_not_leaves_that_body_where_it_is():
    """As a solver has it whose pelvis marker was lost: what hangs on the pelvis turns back against it."""
    smooth, body = smooth_motion(), sway().body
    glitched = turned(smooth, 60, PELVIS, 9.0)
    back = rotations.from_axis_angle(np.array([0.6, 0.0, 0.8]), np.radians(-9.0))
    for joint in (WAIST, JOINTS.index("left_hip"), JOINTS.index("right_hip")):
        glitched.rotations[60, joint] = rotations.multiply(back, glitched.rotations[60, joint])
    mended, [glitch] = mend_glitches(glitched, FPS)
    assert set(glitch.joints) == {"pelvis", "waist", "left_hip", "right_hip"}
    assert np.linalg.norm(joints_of(body, mended)[0] - joints_of(body, smooth)[0], axis=2).max() < 2e-3


@pytest.mark.parametrize("rate_hz", [30.0, 60.0, 120.0])
def test_a_punch_that_lands_is_no_glitch(rate_hz):
    """An elbow that opens at 20 rad/s, stands still within a frame and is drawn back at 8."""
    smooth = smooth_motion()
    time_s = (np.arange(len(smooth.root_m)) - 60) / rate_hz
    angle = np.where(time_s < 0.0, 20.0 * time_s, -8.0 * np.maximum(time_s - 0.05, 0.0))
    local = smooth.rotations.copy()
    local[:, ELBOWS[0]] = rotations.from_axis_angle(np.array([0.0, 1.0, 0.0]), np.clip(angle, -2.0, 0.0))
    pose = Pose(smooth.root_m, local)
    assert mend_glitches(pose, rate_hz) == (pose, [])


def test_what_stays_away_for_longer_is_a_motion():
    pose = smooth_motion()
    for frame in range(50, 56):
        pose = turned(pose, frame, WRISTS[0], 15.0)
    assert mend_glitches(pose, FPS)[1] == []


def test_a_jerk_that_anybody_could_make_in_a_slow_clip_stays():
    """At thirty frames a second even twenty degrees there and back are in reach of an arm."""
    pose = turned(smooth_motion(tempo=0.2), 60, ELBOWS[0], 20.0)
    assert mend_glitches(pose, 30.0)[1] == []
    assert len(mend_glitches(turned(pose, 60, ELBOWS[0], 100.0), 30.0)[1]) == 1


def test_no_more_than_a_few_frames_have_nothing_around_them():
    for frames in (1, 2, 6, 7):
        pose = Pose(smooth_motion().root_m[:frames], smooth_motion().rotations[:frames])
        assert mend_glitches(pose, FPS) == (pose, [])


def test_the_import_says_what_it_bridged_and_can_be_told_not_to(tmp_path):
    poses = swing_arms(60)
    plain = import_clip(write_person(tmp_path / "plain.bvh", poses, fps=120))
    poses[30] = {**poses[30], "Head": (0.0, 25.0, 0.0)}
    path = write_person(tmp_path / "glitched.bvh", poses, fps=120)
    clip = import_clip(path)
    assert plain.report.glitches == []
    assert clip.report.glitches == [{"first": 30, "last": 30, "joints": ["head"]}]
    np.testing.assert_allclose(clip.pose.rotations, plain.pose.rotations, atol=1e-4)
    as_captured = import_clip(path, as_captured=True)
    assert as_captured.report.glitches == []
    assert off_deg(as_captured.pose, plain.pose).max() == pytest.approx(25.0, abs=0.5)
    assert as_captured.key != clip.key


def test_in_the_mirror_it_is_of_the_other_side(tmp_path):
    poses = swing_arms(60)
    poses[30] = {**poses[30], "LeftForeArm": (0.0, 30.0, 0.0)}
    clip = import_clip(write_person(tmp_path / "glitched.bvh", poses, fps=120))
    [own], [other] = clip.report.glitches, mirror_clip(clip).report.glitches
    assert [JOINTS[MIRRORED[JOINTS.index(name)]] for name in own["joints"]] == list(other["joints"])
    assert "left_elbow" in own["joints"]


def test_it_is_the_same_in_the_mirror():
    smooth = turned(smooth_motion(), 60, ELBOWS[0], 30.0)
    clip = sway()
    clip = replace(clip, pose=smooth, planted=np.ones((len(smooth.root_m), 2), bool))
    mended = mend_glitches(smooth, FPS)[0]
    other = mend_glitches(mirror_clip(clip).pose, FPS)[0]
    expected = mirror_clip(replace(clip, pose=mended)).pose
    np.testing.assert_allclose(off_deg(other, expected), 0.0, atol=1e-5)


# --- real motion


@pytest.fixture(scope="module", params=FILES)
def both(request, shared_mocap):
    """A clip as it was captured, and mended."""
    captured = import_clip(shared_mocap / request.param, as_captured=True)
    return captured, *mend_glitches(captured.pose, captured.fps)


def speeds_mps(clip, pose):
    """(F - 1, J)."""
    return np.linalg.norm(np.diff(joints_of(clip.body, pose)[0], axis=0), axis=2) * clip.fps


def test_no_joint_is_shaken_more_than_before(both):
    """Nowhere does a joint's velocity change more within a frame than it did within three frames of there, by what is
    near to a tenth of the bar of a pop; and the worst of a clip never gets worse."""
    clip, mended, _ = both
    before, after = (np.linalg.norm(np.diff(joints_of(clip.body, p)[0], 2, axis=0), axis=2) * clip.fps
                     for p in (clip.pose, mended))  # fmt: skip
    near = np.array([before[max(0, k - 3) : k + 4].max(axis=0) for k in range(len(before))])
    assert (after - near).max() < 0.7
    assert after.max() <= before.max()


def test_fast_motion_is_what_it_was(both):
    """Of the fastest fiftieth of what wrists and ankles do (blows, kicks, jumps, turns), next to nothing is touched."""
    clip, mended, _ = both
    before, after = (joints_of(clip.body, p)[0] for p in (clip.pose, mended))
    touched = total = 0
    for joint in (*WRISTS, *ANKLES):
        speed = np.linalg.norm(np.gradient(before[:, joint], axis=0), axis=1)
        fast = speed > np.percentile(speed, 98.0)
        touched += int((np.linalg.norm(before - after, axis=2)[fast, joint] > 1e-3).sum())
        total += int(fast.sum())
    assert touched <= max(2, 0.02 * total)  # one glitch in a short clip


def test_at_a_quarter_of_its_rate_hardly_anything_could_not_be_motion(both):
    clip, _, _ = both
    quarter = Pose(clip.pose.root_m[::4], clip.pose.rotations[::4])
    assert len(mend_glitches(quarter, clip.fps / 4.0)[1]) <= 1


def test_a_mended_clip_needs_hardly_any_mending(both):
    clip, mended, glitches = both
    assert len(mend_glitches(mended, clip.fps)[1]) <= 0.2 * len(glitches)


def test_the_run_to_a_stop_loses_its_two_jumps(shared_mocap):
    """The pelvis of 16_08 leaps by eight degrees at 0.69 s and by four at 0.78 s, and straight back."""
    path = shared_mocap / "asfamc/16_08.amc"
    clip, captured = import_clip(path), import_clip(path, as_captured=True)
    frames = [(glitch["first"], glitch["last"]) for glitch in clip.report.glitches if "pelvis" in glitch["joints"]]
    assert frames == [(82, 83), (93, 94)]
    jumps = [np.linalg.norm(np.diff(joints_of(c.body, c.pose)[0], 2, axis=0), axis=2)[75:100].max() * c.fps
             for c in (captured, clip)]  # fmt: skip
    assert jumps[0] > 6.0
    assert jumps[1] < 1.5


def test_the_same_trial_in_two_formats_has_the_same_glitches(shared_mocap):
    for trial in ("01_01", "02_01", "07_04"):
        ours, other = (import_clip(shared_mocap / folder / f"{trial}.{folder[-3:]}").report.glitches
                       for folder in ("asfamc", "bvh"))  # fmt: skip
        assert [g["first"] for g in ours] == [g["first"] for g in other]
        assert len(ours) > 0


@pytest.mark.parametrize("name", LIBRARY)
def test_clips_of_the_library_without_glitches_are_bit_for_bit_as_captured(library_clip, name):
    clip, captured = library_clip(name), library_clip(name, as_captured=True)
    assert clip.report.glitches == []
    np.testing.assert_array_equal(clip.pose.rotations, captured.pose.rotations)
    np.testing.assert_array_equal(clip.pose.root_m, captured.pose.root_m)
