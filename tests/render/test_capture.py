"""Captures: whole or absent, never half; what is in them is what was put in."""

from __future__ import annotations

import itertools
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

from engine.core import files
from engine.core.errors import EXIT_BAD_INPUT, EXIT_ENVIRONMENT, BadInput, EnvironmentTrouble
from engine.render import capture
from engine.render.capture import video
from engine.render.capture.filmstrip import PAPER
from engine.render.capture.pictures import gif_delays_ms

ROOT = Path(__file__).resolve().parents[2]


def _film(count: int = 9, width: int = 64, height: int = 48):
    """A red square that walks over a grey field: each frame differs, and compresses well."""
    for number in range(count):
        frame = np.full((height, width, 3), 128, np.uint8)
        frame[10:20, 3 * number : 3 * number + 10] = (220, 30, 30)
        yield frame


def _decoded(path: Path, width: int, height: int) -> np.ndarray:
    """All frames of a film by ffmpeg itself, not by our code."""
    command = [capture.find_ffmpeg(), "-v", "error", "-i", str(path), "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
    done = subprocess.run(command, capture_output=True, check=True)
    return np.frombuffer(done.stdout, np.uint8).reshape(-1, height, width, 3)


@pytest.fixture(params=["ffmpeg on PATH", "the wheel's ffmpeg"])
def either_ffmpeg(request, monkeypatch):
    """Both ways to an encoder, where the machine has both."""
    if request.param == "the wheel's ffmpeg" or shutil.which("ffmpeg") is None:
        monkeypatch.setattr(video.shutil, "which", lambda name: None)


def test_an_mp4_holds_every_frame_in_its_colours(tmp_path, either_ffmpeg):
    seen = []
    assert capture.write_mp4(tmp_path / "a.mp4", _film(), 30, seen.append) == 9
    assert seen == list(range(1, 10))
    decoded = _decoded(tmp_path / "a.mp4", 64, 48)
    assert len(decoded) == 9 == capture.count_frames(tmp_path / "a.mp4")
    for got, put in zip(decoded, _film(), strict=True):
        assert np.abs(got.astype(int) - put).mean() < 4
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.mp4"]


@pytest.mark.parametrize("size", [(63, 48), (64, 47), (1, 1)])
def test_odd_sizes_gain_a_column_or_row_and_lose_nothing(tmp_path, size):
    width, height = size
    put = [np.full((height, width, 3), 60 + 20 * k, np.uint8) for k in range(3)]
    capture.write_mp4(tmp_path / "odd.mp4", put, 25)
    decoded = _decoded(tmp_path / "odd.mp4", width + width % 2, height + height % 2)
    assert np.abs(decoded[:, :height, :width].astype(int) - np.stack(put)).max() < 8


@pytest.mark.parametrize("write", [capture.write_mp4, capture.write_gif, capture.write_png_folder])
def test_no_frames_or_frames_of_two_sizes_leave_nothing(tmp_path, write):
    with pytest.raises(BadInput, match="not a single frame"):
        write(tmp_path / "film", [], 30)
    mixed = itertools.chain(_film(2), _film(1, width=32))
    with pytest.raises(BadInput, match="frame 2 is 32 x 48, the first 64 x 48"):
        write(tmp_path / "film", mixed, 30)
    with pytest.raises(BadInput, match="uint8"):
        write(tmp_path / "film", [np.zeros((4, 4, 3))], 30)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["film.mp4", "film.gif", "film"])
def test_an_interrupted_capture_leaves_the_old_one_untouched(tmp_path, name):
    target = tmp_path / name
    capture.write_film(target, _film(3), 30)
    before = _contents(tmp_path)

    def interrupted():
        yield from _film(4)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        capture.write_film(target, interrupted(), 30)
    assert _contents(tmp_path) == before


@pytest.mark.parametrize("name", ["film.mp4", "film.gif", "film"])
def test_a_second_capture_replaces_the_first(tmp_path, name):
    capture.write_film(tmp_path / name, _film(5), 30)
    before = _contents(tmp_path)
    assert capture.write_film(tmp_path / name, _film(2), 30) == 2
    assert _contents(tmp_path) != before
    assert [entry.name for entry in tmp_path.iterdir()] == [name]


def test_a_gif_keeps_time_and_loops(tmp_path):
    capture.write_gif(tmp_path / "a.gif", _film(), 30)
    with Image.open(tmp_path / "a.gif") as film:
        assert film.n_frames == 9
        assert film.info["loop"] == 0
        delays = []
        for number, put in enumerate(_film()):
            film.seek(number)
            delays.append(film.info["duration"])
            assert np.abs(np.asarray(film.convert("RGB")).astype(int) - put).mean() < 4
    assert sum(delays) == 300


@pytest.mark.parametrize("fps", [12, 24, 25, 30, 50])
def test_gif_delays_are_whole_hundredths_that_do_not_drift(fps):
    delays = gif_delays_ms(1000, fps)
    assert set(delays) <= {10 * (100 // fps), 10 * (100 // fps + 1)}
    assert np.abs(np.cumsum(delays) - np.arange(1, 1001) * 1000 / fps).max() <= 5.001


def test_a_folder_of_pictures_is_exact_and_lists_its_files(tmp_path):
    capture.write_png_folder(tmp_path / "film", _film(), 24)
    manifest = json.loads((tmp_path / "film" / "frames.json").read_text())
    assert manifest["fps"] == 24
    assert manifest["size"] == [64, 48]
    assert sorted(manifest["files"]) == sorted(p.name for p in (tmp_path / "film").glob("*.png"))
    for name, put in zip(manifest["files"], _film(), strict=True):
        with Image.open(tmp_path / "film" / name) as picture:
            assert (np.asarray(picture) == put).all()


def test_a_folder_with_foreign_files_is_refused_before_anything_is_drawn(tmp_path):
    (tmp_path / "film").mkdir()
    (tmp_path / "film" / "holiday.jpg").write_text("mine")

    def never():
        raise AssertionError("a frame was asked for")
        yield

    with pytest.raises(BadInput, match=r"holiday\.jpg") as trouble:
        capture.write_png_folder(tmp_path / "film", never(), 24)
    assert trouble.value.exit_code == EXIT_BAD_INPUT
    assert (tmp_path / "film" / "holiday.jpg").read_text() == "mine"


def test_a_foreign_file_among_our_own_is_kept_too(tmp_path):
    capture.write_png_folder(tmp_path / "film", _film(2), 24)
    (tmp_path / "film" / "notes.txt").write_text("mine")
    with pytest.raises(BadInput, match=r"notes\.txt"):
        capture.write_png_folder(tmp_path / "film", _film(3), 24)
    assert (tmp_path / "film" / "notes.txt").exists()


def test_an_empty_folder_is_taken(tmp_path):
    (tmp_path / "film").mkdir()
    assert capture.write_png_folder(tmp_path / "film", _film(2), 24) == 2


def test_no_ffmpeg_is_one_line(tmp_path, monkeypatch):
    monkeypatch.setattr(video.shutil, "which", lambda name: None)

    def absent():
        raise RuntimeError("No ffmpeg exe could be found")

    monkeypatch.setattr(imageio_ffmpeg, "get_ffmpeg_exe", absent)
    with pytest.raises(EnvironmentTrouble, match="apt-get install ffmpeg") as trouble:
        capture.write_mp4(tmp_path / "a.mp4", _film(), 30)
    assert trouble.value.exit_code == EXIT_ENVIRONMENT
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("behaviour", "said"),
    [
        ("exit 1", "ended with code 1"),
        ("echo 'av_interleaved_write_frame(): No space left on device' >&2; exit 1", "disk is full"),
        ("cat > /dev/null; echo 'Error writing trailer: No space left on device' >&2; exit 0", "disk is full"),
        ("cat > /dev/null; exit 0", "9 frames were written but 0"),  # claims success, wrote nothing
    ],
)
def test_an_ffmpeg_that_fails_or_lies_leaves_nothing(tmp_path, monkeypatch, behaviour, said):
    liar = tmp_path / "bin" / "ffmpeg"
    liar.parent.mkdir()
    liar.write_text(
        f'#!/bin/sh\ncase "$*" in *-encoders*) echo " V libx264 x";; *rawvideo*) {behaviour};; *) exit 1;; esac\n'
    )
    liar.chmod(0o755)
    monkeypatch.setenv("PATH", f"{liar.parent}:{os.environ['PATH']}")
    (tmp_path / "out").mkdir()
    with pytest.raises(EnvironmentTrouble, match=said) as trouble:
        capture.write_mp4(tmp_path / "out" / "a.mp4", _film(), 30)
    assert "\n" not in trouble.value.line()
    assert list((tmp_path / "out").iterdir()) == []


FULL_DISK = """
import sys, resource
import numpy as np
from engine.core.errors import EnvironmentTrouble
from engine.render import capture
random = np.random.default_rng(6)
frames = (random.integers(0, 256, (240, 320, 3), np.uint8) for _ in range(8))
resource.setrlimit(resource.RLIMIT_FSIZE, (150_000, 150_000))
try:
    path = sys.argv[1]
    capture.write_png(path, next(frames)) if path.endswith(".png") else capture.write_film(path, frames, 30)
except EnvironmentTrouble as trouble:
    print(trouble.line())
    sys.exit(trouble.exit_code)
"""


@pytest.mark.parametrize("name", ["film.mp4", "film.gif", "film", "one.png"])
def test_no_room_is_one_line_and_no_half_file(tmp_path, name):
    """A limit on file size, set in a process of its own, stops the real writes as a full disk does."""
    done = subprocess.run(
        [sys.executable, "-c", FULL_DISK, str(tmp_path / name)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert done.returncode == EXIT_ENVIRONMENT, done.stderr
    assert done.stdout.startswith("error[disk-full]")
    assert done.stdout.count("\n") == 1
    assert done.stderr == ""
    assert list(tmp_path.iterdir()) == []


def test_what_a_full_device_says_becomes_one_line():
    with (
        pytest.raises(EnvironmentTrouble, match="the disk is full"),
        files.disk_trouble("film.mp4"),
        open("/dev/full", "wb", buffering=0) as device,
    ):
        device.write(b"x")


@pytest.mark.parametrize("write", [capture.write_png, capture.write_mp4])
def test_places_that_cannot_be_written_are_refused_first(tmp_path, write):
    more = () if write is capture.write_png else (30,)
    picture = np.zeros((4, 4, 3), np.uint8)
    frames = picture if write is capture.write_png else [picture]
    with pytest.raises(EnvironmentTrouble, match="no folder") as trouble:
        write(tmp_path / "nowhere" / "a.mp4", frames, *more)
    assert trouble.value.exit_code == EXIT_ENVIRONMENT
    with pytest.raises(BadInput, match="not a plain file"):
        write("/dev/full", frames, *more)  # a device must not be renamed away
    assert Path("/dev/full").is_char_device()


def test_a_forbidden_folder_is_refused_as_any_user(tmp_path, monkeypatch):
    """Root may write anywhere, so the system's own answer is put in its mouth."""
    monkeypatch.setattr(files.os, "access", lambda *_: False)
    with pytest.raises(EnvironmentTrouble, match="no leave to write"):
        capture.write_png(tmp_path / "a.png", np.zeros((4, 4, 3), np.uint8))


def test_a_link_keeps_pointing_to_what_is_replaced(tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "real" / "a.png").write_bytes(b"old")
    (tmp_path / "a.png").symlink_to(tmp_path / "real" / "a.png")
    capture.write_png(tmp_path / "a.png", np.zeros((4, 4, 3), np.uint8))
    assert (tmp_path / "a.png").is_symlink()
    with Image.open(tmp_path / "real" / "a.png") as picture:
        assert picture.size == (4, 4)


def test_the_ending_chooses_the_writer(tmp_path):
    expected = {"a.mp4": "mp4", "a.GIF": "gif", "a.png": "png", "folder": "folder"}
    assert {name: capture.capture_kind(tmp_path / name) for name in expected} == expected
    (tmp_path / "v1.2").mkdir()
    assert capture.capture_kind(tmp_path / "v1.2") == "folder"
    with pytest.raises(BadInput, match=r"unknown ending \.avi, expected"):
        capture.capture_kind(tmp_path / "a.avi")
    with pytest.raises(BadInput, match="filmstrip"):
        capture.write_film(tmp_path / "a.png", _film(), 30)


def test_a_filmstrip_shows_every_picture_whole_beside_the_next(tmp_path):
    pictures = list(_film(6))
    sheet = capture.compose_filmstrip(pictures, [f"{k / 30:.2f} s" for k in range(6)])
    assert sheet.shape[1] > 6 * 64
    assert sheet.shape[0] < 2 * 48 + 60
    assert (sheet[0, 0] == PAPER).all()
    for put in pictures:  # its middle is found unchanged, somewhere along one row
        middle = put[8:40, 4:60]
        windows = np.lib.stride_tricks.sliding_window_view(sheet, (32, 56, 3))[:, :, 0]
        assert (windows == middle).all(axis=(2, 3, 4)).any()


def test_filmstrips_wrap_carry_words_and_refuse_what_does_not_fit():
    pictures = list(_film(6))
    row = capture.compose_filmstrip(pictures, [""] * 6)
    grid = capture.compose_filmstrip(pictures, ["slow\n12 m/s", "", "x" * 200, "", "", ""], columns=3, title="Sweep")
    assert grid.shape[1] < row.shape[1]
    assert grid.shape[0] > 2 * row.shape[0] - 30
    bare = capture.compose_filmstrip(pictures, [""] * 6, columns=3)
    assert (bare.min(axis=2) < 100).sum() < (grid.min(axis=2) < 100).sum()  # ink
    with pytest.raises(BadInput, match="2 captions for 6 pictures"):
        capture.compose_filmstrip(pictures, ["a", "b"])
    with pytest.raises(BadInput, match="not a single frame"):
        capture.compose_filmstrip([], [])


def _contents(folder: Path) -> dict[str, bytes]:
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}
