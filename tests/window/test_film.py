"""Filming while the window is played with: a steady rate, whole files, and never in the window's way."""

import shutil
import threading

import numpy as np
import pytest

from demos.window.film import FPS, Film
from engine.core.errors import BraceError, EnvironmentTrouble
from engine.render.capture import count_frames, find_ffmpeg


def picture(shade=0, size=(48, 64)):
    return np.full((*size, 3), shade, np.uint8)


@pytest.fixture(autouse=True)
def _needs_ffmpeg():
    try:
        find_ffmpeg()
    except EnvironmentTrouble as trouble:
        pytest.skip(trouble.message)


@pytest.mark.parametrize("frame_s", [1 / 120, 1 / 60, 1 / 25, 1 / 7])
def test_it_lasts_as_long_as_was_filmed_however_fast_the_window_is(tmp_path, frame_s):
    film = Film(tmp_path / "a.mp4")
    for _ in range(round(1.0 / frame_s)):
        assert film.offer(frame_s, picture)
    film.stop()
    film.wait()
    assert film.trouble is None
    assert film.skipped == 0
    assert count_frames(tmp_path / "a.mp4") == pytest.approx(FPS, abs=2)


def test_another_size_ends_it_and_what_was_filmed_is_kept(tmp_path):
    film = Film(tmp_path / "a.mp4")
    assert film.offer(0.5, picture)
    assert not film.offer(0.5, lambda: picture(0, (50, 64)))
    film.stop()
    film.wait()
    assert count_frames(tmp_path / "a.mp4") == 16


def test_pictures_that_ffmpeg_has_no_time_for_are_skipped_and_nobody_waits(tmp_path, monkeypatch):
    monkeypatch.setattr("demos.window.film.WAITING_FRAMES", 3)
    go_on = threading.Event()
    monkeypatch.setattr("demos.window.film.write_mp4", lambda path, frames, fps: go_on.wait() and list(frames))
    film = Film(tmp_path / "a.mp4")
    for _ in range(200):
        assert film.offer(1 / 30, picture)
    assert film.frames == 3
    go_on.set()
    film.stop()
    film.wait()
    assert film.frames + film.skipped in (200, 201)
    assert film.skipped > 0


def test_no_ffmpeg_is_one_line_and_nothing_begins(tmp_path, monkeypatch):
    def nowhere():
        raise EnvironmentTrouble("no-ffmpeg", "no ffmpeg here")

    monkeypatch.setattr("demos.window.film.find_ffmpeg", nowhere)
    with pytest.raises(EnvironmentTrouble, match="no ffmpeg"):
        Film(tmp_path / "a.mp4")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("what", ["disk", "folder"])
def test_a_film_that_cannot_be_written_leaves_nothing_and_says_why(tmp_path, monkeypatch, what):
    if what == "folder":
        with pytest.raises(EnvironmentTrouble):
            Film(tmp_path / "nowhere" / "a.mp4")
        return

    def full(path, frames, fps):
        next(iter(frames))
        raise EnvironmentTrouble("disk-full", "the disk is full; nothing was kept", str(path))

    monkeypatch.setattr("demos.window.film.write_mp4", full)
    film = Film(tmp_path / "a.mp4")
    while film.offer(1 / 30, picture):  # goes on until it notices
        pass
    film.stop()
    film.wait()
    assert isinstance(film.trouble, BraceError)
    assert list(tmp_path.iterdir()) == []
    assert shutil.disk_usage(tmp_path).free > 0
