"""A T-pose put in front of a clip is dropped, with the smear out of it; a clip that merely begins with its arms out is
not."""

from __future__ import annotations

import numpy as np
import pytest

from engine.clips.importing import import_clip
from engine.core.errors import BadInput
from tests.clips.people import ARMS_HANG, swing_arms, write_person


def between(a, b, weight):
    joints = {*a, *b}
    none = np.zeros(3)
    return {j: tuple((1 - weight) * np.array(a.get(j, none)) + weight * np.array(b.get(j, none))) for j in joints}


def test_one_t_pose_frame_is_dropped(tmp_path):
    poses = swing_arms(40)
    plain = import_clip(write_person(tmp_path / "plain.bvh", poses, fps=120))
    posed = import_clip(write_person(tmp_path / "posed.bvh", [{}, *poses], fps=120))
    assert (plain.report.rest_frames_dropped, posed.report.rest_frames_dropped) == (0, 1)
    np.testing.assert_allclose(posed.pose.rotations, plain.pose.rotations, atol=1e-12)


def test_the_smear_out_of_it_goes_too(tmp_path):
    poses = swing_arms(40)
    smear = [between({}, poses[0], weight) for weight in (0.0, 0.25, 0.5, 0.75)]
    clip = import_clip(write_person(tmp_path / "smeared.bvh", [*smear, *poses], fps=120))
    assert clip.report.rest_frames_dropped == 4
    assert clip.frames == 40


def test_arms_that_are_lowered_from_a_t_pose_are_a_motion(tmp_path):
    lowering = [between({}, ARMS_HANG, weight) for weight in np.linspace(0, 1, 60)]
    clip = import_clip(write_person(tmp_path / "lowering.bvh", lowering, fps=120))
    assert clip.report.rest_frames_dropped == 0


def test_a_quick_start_that_is_no_rest_pose_is_a_motion(tmp_path):
    jerk = [{**ARMS_HANG, "LeftForeArm": (0, -90, 0)}, *swing_arms(30)]
    clip = import_clip(write_person(tmp_path / "jerk.bvh", jerk, fps=120))
    assert clip.report.rest_frames_dropped == 0


def test_frames_may_be_asked_for_by_the_files_own_numbers(tmp_path):
    path = write_person(tmp_path / "a.bvh", [{}, *swing_arms(40)], fps=120)
    assert import_clip(path, frames=(0, 20)).frames == 20
    assert import_clip(path, frames=(10, 20)).frames == 11
    with pytest.raises(BadInput, match="found frames 0 to 40, expected 10 to 41 among them"):
        import_clip(path, frames=(10, 41))
    with pytest.raises(BadInput, match="found nothing but a rest pose"):
        import_clip(path, frames=(0, 0))
