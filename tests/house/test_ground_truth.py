"""Depth, mask and tracks of a film: they agree with each other, appear whole, and need a film."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from demos.benchmarks.render import SIZES_PX, FrameTime, lines_of
from demos.cli import main
from demos.ground_truth import FARTHEST_MM, in_millimetres
from engine.render.measures import FIRST_BALL, FIRST_FIGURE, FLOOR, NOTHING
from tests.conftest import ROOT

SIZE = (160, 90)


@pytest.fixture(scope="module")
def captured(tmp_path_factory):
    """A folder with a film and all that goes beside it, made by a process of its own, as its pictures need."""
    folder = tmp_path_factory.mktemp("truth")
    words = ["capture", "sway", "-o", "film", "--depth", "depth", "--mask", "mask", "--tracks", "tracks.npz"]
    words += ["--size", "160x90", "--fps", "10", "--set", "duration_s=1.4"]
    done = subprocess.run(
        [sys.executable, "-P", "-m", "demos.cli", *words], cwd=folder, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert (done.returncode, done.stderr.count("error")) == (0, 0), done.stderr
    return folder


def _pictures(folder) -> np.ndarray:
    names = json.loads((folder / "frames.json").read_text())["files"]
    return np.stack([np.asarray(Image.open(folder / name)) for name in names])


def test_every_joint_on_the_pictures_lies_on_its_figure_and_behind_its_skin(captured):
    depths, masks = _pictures(captured / "depth"), _pictures(captured / "mask")
    tracks = np.load(captured / "tracks.npz")
    assert depths.shape == masks.shape == (len(tracks["time_s"]), SIZE[1], SIZE[0])
    assert depths.dtype == np.uint16
    for frame, (pixels, far_m) in enumerate(
        zip(tracks["joints_px"][:, 0], tracks["joints_depth_m"][:, 0], strict=True)
    ):
        x, y = pixels.astype(int).T
        whose = masks[frame, y, x]
        assert (whose == FIRST_FIGURE).mean() > 0.8  # a toe may be a pixel beside; a ball may be before an elbow
        on = whose == FIRST_FIGURE
        before_m = far_m[on] - depths[frame, y[on], x[on]] / 1000.0
        assert (before_m > -0.05).all()
        assert (before_m < 0.6).all()  # the other arm may be before it


def test_a_ball_that_flies_is_marked_where_the_tracks_say(captured):
    masks, tracks = _pictures(captured / "mask"), np.load(captured / "tracks.npz")
    seen = [frame for frame, mask in enumerate(masks) if (mask == FIRST_BALL).sum() > 6]
    assert seen
    for frame in seen:
        y, x = np.nonzero(masks[frame] == FIRST_BALL)
        if x.min() > 0 and x.max() < SIZE[0] - 1 and y.min() > 0 and y.max() < SIZE[1] - 1:
            assert np.hypot(*(np.mean([x, y], axis=1) + 0.5 - tracks["ball_px"][frame, 0])) < 5.0


def test_tracks_say_how_to_read_them(captured):
    tracks = np.load(captured / "tracks.npz")
    assert list(tracks["joints"][:2]) == ["pelvis", "waist"]
    assert np.diff(tracks["time_s"]) == pytest.approx(0.1)
    assert tuple(tracks["size_px"]) == SIZE
    assert tracks["eye_m"].shape == tracks["target_m"].shape == (len(tracks["time_s"]), 3)


def test_distances_that_do_not_fit_are_the_farthest_and_nothing_is_nothing():
    mask = np.array([[NOTHING, FLOOR, FLOOR, FIRST_FIGURE]], np.uint8)
    depth_m = np.array([[np.inf, 900.0, 2.0004, 0.0001]], np.float32)
    assert in_millimetres(depth_m, mask).tolist() == [[0, FARTHEST_MM, 2000, 1]]


def test_a_strip_has_none(tmp_path, capsys):
    assert main(["capture", "sway", "-o", str(tmp_path / "s.png"), "--mask", str(tmp_path / "m")]) == 2
    assert "not with a strip" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_floor_that_is_none_is_told(tmp_path, capsys):
    assert main(["capture", "sway", "-o", str(tmp_path / "s.gif"), "--floor", "lawn"]) == 2
    assert "plain, gym" in capsys.readouterr().err


def test_frame_times_are_told_with_what_was_wanted():
    rows = [FrameTime("what it picks", size, "fair", 0.025, 0.040) for size in SIZES_PX]
    assert [row.wanted_fps for row in rows] == [30.0, 60.0]
    head, large, small = lines_of(rows)
    assert len(head) == len(large) == len(small)
    assert large.split()[-3:] == ["ms", "40", "30"]
    assert "640 x 360" in small
