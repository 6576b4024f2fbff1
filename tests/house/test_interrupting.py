"""A person at a terminal: sees progress, and stops a command with Ctrl-C."""

import os
import pty
import signal
import subprocess
import sys
import termios
import time

import pytest

from engine.core.errors import EXIT_INTERRUPTED
from tests.conftest import ROOT

CAPTURE = [sys.executable, "-m", "demos.cli", "capture", "sway", "--size", "160x120", "--floor", "plain"]


def environment():
    return {**os.environ, "PYTHONPATH": str(ROOT)}


@pytest.mark.parametrize(
    ("name", "ending", "code"),
    [
        ("film.mp4", signal.SIGINT, EXIT_INTERRUPTED),
        ("film.gif", signal.SIGINT, EXIT_INTERRUPTED),
        ("film", signal.SIGINT, EXIT_INTERRUPTED),
        ("film.mp4", signal.SIGTERM, 143),
        ("film", signal.SIGTERM, 143),
    ],
)
def test_stopped_in_the_middle_of_a_film_nothing_is_left(tmp_path, name, ending, code):
    """A terminal sends the signal to ffmpeg as well."""
    process = subprocess.Popen(
        [*CAPTURE, "--fps", "240", "-o", name], cwd=tmp_path, env=environment(), stdout=subprocess.PIPE,
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    # a GIF has no file of its own until all is drawn
    begun, patience_s = time.monotonic(), 60.0 if name != "film.gif" else 6.0
    while not list(tmp_path.iterdir()) and time.monotonic() - begun < patience_s:
        assert process.poll() is None
        time.sleep(0.02)
    time.sleep(0.3)
    assert process.poll() is None
    os.killpg(process.pid, ending)
    out, err = process.communicate(timeout=60)
    assert process.returncode == code
    assert (out, err) == ("", "")
    assert list(tmp_path.iterdir()) == []


def test_a_terminal_sees_progress_and_the_result(tmp_path):
    ours, theirs = pty.openpty()
    termios.tcsetwinsize(theirs, (24, 80))
    process = subprocess.Popen(
        [*CAPTURE, "--set", "duration_s=0.5", "-o", "film.gif"], cwd=tmp_path, env=environment(), stderr=theirs
    )
    os.close(theirs)
    said = b""
    while True:
        try:
            part = os.read(ours, 4096)
        except OSError:  # what Linux says of a terminal that nobody holds any more
            break
        said += part
    os.close(ours)
    assert process.wait(timeout=60) == 0
    assert b"drawing" in said
    assert b"frame/s" in said
    assert said.rstrip().endswith(b"wrote film.gif")
