"""DeepMimic's JSON motions, written here by hand from the format's description, and the fetched get-ups."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from engine.body.kinematics import joints_of
from engine.body.skeleton import (
    HEAD,
    LEFT_ANKLE,
    LEFT_ELBOW,
    LEFT_HIP,
    LEFT_KNEE,
    LEFT_WRIST,
    PELVIS,
    RIGHT_HIP,
    RIGHT_WRIST,
    Pose,
)
from engine.clips.importing import import_clip
from engine.core.errors import BadInput

UPRIGHT = [1.0, 0.0, 0.0, 0.0]


def row(lasts_s=1 / 60, root=(0.0, 0.87, 0.0), left_knee=0.0, left_elbow=0.0, heading=0.0) -> list[float]:
    """One frame of somebody standing; `heading` turns them about the file's Y."""
    turned = [math.cos(heading / 2), 0.0, math.sin(heading / 2), 0.0]
    legs_right = UPRIGHT + [0.0] + UPRIGHT
    return [
        lasts_s, *root, *turned, *UPRIGHT, *UPRIGHT, *legs_right, *UPRIGHT, 0.0,
        *UPRIGHT, left_knee, *UPRIGHT, *UPRIGHT, left_elbow,
    ]  # fmt: skip


def written(tmp_path, rows, **more):
    path = tmp_path / "motion.json"
    path.write_text(json.dumps({"Loop": "none", "Frames": rows, **more}))
    return path


def test_somebody_standing_faces_ahead_with_the_left_hand_on_the_left(tmp_path):
    clip = import_clip(written(tmp_path, [row()] * 30))
    at, _ = joints_of(clip.body, clip.pose)
    assert at[0, LEFT_HIP, 1] - at[0, RIGHT_HIP, 1] == pytest.approx(2 * 0.084887, abs=1e-6)
    assert at[0, LEFT_WRIST, 1] > 0.1 > -0.1 > at[0, RIGHT_WRIST, 1]
    assert at[0, HEAD, 2] - at[0, PELVIS, 2] == pytest.approx(0.236151 + 0.223894, abs=0.1)
    assert clip.fps == 60.0
    assert clip.planted.all()
    assert not np.any(clip.pose.root_m[0, :2])


def test_a_knee_bends_back_and_an_elbow_forward(tmp_path):
    """The file's knee angle is negative for a bent knee, its elbow angle positive, both about the side axis."""
    clip = import_clip(written(tmp_path, [row()] * 30 + [row(left_knee=-1.0, left_elbow=1.0)] * 30))
    at, _ = joints_of(clip.body, Pose(clip.pose.root_m, clip.pose.rotations))
    ankle = at[:, LEFT_ANKLE]
    assert ankle[-1, 0] - at[-1, LEFT_KNEE, 0] == pytest.approx(-0.40987 * math.sin(1.0), abs=1e-6)
    assert at[-1, LEFT_WRIST, 0] - at[-1, LEFT_ELBOW, 0] == pytest.approx(0.258947 * math.sin(1.0), abs=1e-6)


def test_the_file_s_own_heading_is_put_right(tmp_path):
    clip = import_clip(written(tmp_path, [row(heading=2.0)] * 20))
    assert clip.report.facing_deg == pytest.approx(math.degrees(2.0), abs=1e-3)


@pytest.mark.parametrize(
    ("rows", "found"),
    [
        ([], 'no "Frames"'),
        ([row()[:-1]], "43 numbers in frame 0"),
        ([row(), "frame"], "in frame 1"),
        ([row(), [*row()[:-1], "x"]], "else than numbers"),
        ([row(), [*row()[:-1], math.inf]], "not finite in frame 1"),
        ([row(), row(1 / 30), row(), row()], "frames of 0.01667 to 0.03333"),
        ([[1 / 60, 0.0, 0.9, 0.0, *[0.0] * 40]] * 2, "length 0 at pelvis"),
    ],
)
def test_what_is_wrong_is_said(tmp_path, rows, found):
    with pytest.raises(BadInput, match=found):
        import_clip(written(tmp_path, rows))


def test_what_is_no_json_is_said(tmp_path):
    path = tmp_path / "motion.json"
    path.write_bytes(b"\xff\xfe {")
    with pytest.raises(BadInput, match="no JSON"):
        import_clip(path)


@pytest.mark.parametrize("name", ["getup_faceup", "getup_facedown"])
def test_a_get_up_starts_lying_and_ends_standing_on_the_floor(library_clip, name):
    clip = library_clip(name)
    at, _ = joints_of(clip.body, clip.pose)
    assert at[0, [PELVIS, HEAD], 2].max() < 0.35
    assert at[-1, HEAD, 2] > 1.2
    assert at[-1, PELVIS, 2] > 0.8
    assert clip.planted[-1].all()
    assert clip.report.floor_slope == 0.0
    assert abs(clip.report.floor_m) < 0.025  # DeepMimic's own floor is at zero
