"""The real window under a virtual display, driven by real input: moves, drags, wheel, keys, resize, minimise, close."""

from __future__ import annotations

import json
import os
import queue
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageGrab

from tests.window.desk import ask_to_close, needs_display

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_S = 30.0

pytestmark = needs_display


class Desk:
    """A display of its own with the probe's window on it."""

    def __init__(self, folder: Path):
        self.folder = folder
        read, write = os.pipe()
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", "800x600x24", "-nolisten", "tcp"]
        self.server = subprocess.Popen(command, pass_fds=(write,), stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as answer:
            number = answer.readline().strip()
        self.env = {**os.environ, "DISPLAY": f":{number}"}
        self.probe = subprocess.Popen(
            [sys.executable, "-m", "tests.render.window_probe"],
            cwd=ROOT, env=self.env, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
        )  # fmt: skip
        self.said: queue.Queue = queue.Queue()
        self.listener = threading.Thread(target=self._listen)
        self.listener.start()
        self.ready = self.wait_for(lambda line: "ready" in line)
        self.window = self.xdotool("search", "--sync", "--name", "^probe$").split()[0]
        self.xdotool("windowfocus", self.window)
        self.xdotool("windowmove", self.window, "0", "0")

    def close(self) -> None:
        """Ends the probe and the display that this desk started, and nothing else."""
        for process in (self.probe, self.server):
            if process.poll() is None:
                process.terminate()
            process.wait(PATIENCE_S)
        self.listener.join(PATIENCE_S)
        self.probe.stdin.close()
        self.probe.stdout.close()

    def xdotool(self, *words: str) -> str:
        done = subprocess.run(
            ["xdotool", *words], env=self.env, capture_output=True, text=True, timeout=PATIENCE_S, check=False
        )
        return done.stdout

    def tell(self, command: str) -> None:
        self.probe.stdin.write(command + "\n")
        self.probe.stdin.flush()

    def ask(self) -> dict:
        """Where the camera is and how large the picture, after everything done so far has arrived."""
        self.tell("where")
        return self.wait_for(lambda line: "eye" in line)

    def wait_for(self, wanted) -> dict:
        """The next line that is wanted; those before it are dropped."""
        end = time.monotonic() + PATIENCE_S
        while True:
            line = self.said.get(timeout=max(end - time.monotonic(), 0.01))
            if wanted(line):
                return line

    def event(self, kind: str, **parts) -> dict:
        return self.wait_for(
            lambda line: line.get("event") == kind and all(line[key] == value for key, value in parts.items())
        )

    def shot(self) -> tuple[np.ndarray, np.ndarray]:
        """What the renderer drew, and what the screen shows."""
        path = self.folder / "drawn.png"
        self.tell(f"shot {path}")
        self.wait_for(lambda line: "shot" in line)
        with Image.open(path) as picture:
            drawn = np.asarray(picture).astype(int)
        height, width = drawn.shape[:2]
        screen = ImageGrab.grab((0, 0, width, height), xdisplay=self.env["DISPLAY"])
        return drawn, np.asarray(screen.convert("RGB")).astype(int)

    def _listen(self) -> None:
        for line in self.probe.stdout:
            self.said.put(json.loads(line))


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    desk = Desk(tmp_path_factory.mktemp("desk"))
    yield desk
    desk.close()


def test_the_screen_shows_what_was_drawn(desk):
    assert desk.ready["size"] == [480, 360]
    desk.ask()
    drawn, screen = desk.shot()
    assert np.abs(drawn - screen).max() == 0
    assert np.ptp(screen) > 150  # a person, not an empty sheet


def test_dragging_orbits_and_shift_or_right_dragging_pans(desk):
    before = desk.ask()
    desk.xdotool("mousemove", "240", "180", "mousedown", "1", "mousemove", "300", "200", "mouseup", "1")
    time.sleep(0.2)
    orbited = desk.ask()
    assert orbited["target"] == pytest.approx(before["target"])
    assert orbited["eye"] != pytest.approx(before["eye"], abs=1e-3)
    desk.xdotool("mousemove", "240", "180", "mousedown", "3", "mousemove", "280", "180", "mouseup", "3")
    time.sleep(0.2)
    panned = desk.ask()
    assert panned["target"] != pytest.approx(orbited["target"], abs=1e-3)
    desk.xdotool("keydown", "shift", "mousedown", "1", "mousemove", "240", "180", "mouseup", "1", "keyup", "shift")
    time.sleep(0.2)
    assert desk.ask()["target"] == pytest.approx(orbited["target"], abs=1e-3)  # dragged back


def test_the_wheel_zooms(desk):
    before = desk.ask()
    desk.xdotool("click", "4", "click", "4")
    time.sleep(0.2)
    after = desk.ask()
    distances = [np.linalg.norm(np.subtract(where["eye"], where["target"])) for where in (before, after)]
    assert distances[1] < 0.9 * distances[0]


def test_keys_come_with_their_names_and_modifiers(desk):
    for pressed, name in (("space", "space"), ("comma", ","), ("F1", "f1"), ("Tab", "tab"), ("BackSpace", "backspace")):
        desk.xdotool("key", pressed)
        desk.event("Key", name=name, action="press")
        desk.event("Key", name=name, action="release")
    desk.xdotool("key", "ctrl+f")
    assert desk.event("Key", name="f", action="press")["modifiers"] == 2


def test_ctrl_click_and_double_click_arrive_with_their_place(desk):
    desk.xdotool("mousemove", "100", "50", "keydown", "ctrl", "click", "1", "keyup", "ctrl")
    click = desk.event("MouseButton", pressed=True)
    assert (click["x_px"], click["y_px"], click["modifiers"]) == (100, 50, 2)
    desk.xdotool("mousemove", "200", "150", "click", "--repeat", "2", "--delay", "40", "1")
    assert desk.event("MouseButton", pressed=True, clicks=2)["x_px"] == 200


def test_resizing_and_minimising(desk):
    desk.xdotool("windowsize", "--sync", desk.window, "601", "343")
    desk.event("Resize", width_px=601, height_px=343)
    desk.ask()
    drawn, screen = desk.shot()
    assert drawn.shape == screen.shape == (343, 601, 3)
    assert np.abs(drawn - screen).max() == 0
    frames = desk.ask()["frames"]
    desk.xdotool("windowunmap", "--sync", desk.window)
    time.sleep(0.3)
    assert desk.ask()["frames"] > frames  # it lives on
    desk.xdotool("windowmap", "--sync", desk.window)
    assert desk.ask()["size"] == [601, 343]


def test_closing_the_window_ends_the_loop_in_order(desk):
    ask_to_close(desk.env["DISPLAY"], int(desk.window))
    desk.event("Close")
    desk.wait_for(lambda line: "closed" in line)
    assert desk.probe.wait(PATIENCE_S) == 0
