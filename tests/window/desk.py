"""A virtual display with the window of `brace demo` on it, used as people use theirs: by mouse and keys."""

from __future__ import annotations

import ctypes
import functools
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import ImageGrab

ROOT = Path(__file__).resolve().parents[2]
PATIENCE_S = 90.0
SCREEN = (1300, 900)

needs_display = pytest.mark.skipif(
    shutil.which("Xvfb") is None or shutil.which("xdotool") is None,
    reason="needs Xvfb and xdotool for a virtual display",
)


@functools.cache
def make_ready() -> None:
    """What only the first window has to wait for, in a process of its own: one GL context a process is enough."""
    subprocess.run([sys.executable, "-m", "tests.window.ready"], cwd=ROOT, check=True)


class Desk:
    """`screen` of 0..1 floats; `key`, `click`, `drag` as a user does; `start` runs the command in `folder`."""

    def __init__(self, folder: Path, resources: str = ""):
        """resources: what the desktop tells programs, such as `Xft.dpi: 192` for a high-DPI screen."""
        self.folder = folder
        read, write = os.pipe()
        size = f"{SCREEN[0]}x{SCREEN[1]}x24"
        # -noreset: properties of the screen outlive the client that set them
        command = ["Xvfb", "-displayfd", str(write), "-screen", "0", size, "-nolisten", "tcp", "-noreset"]
        self.server = subprocess.Popen(command, pass_fds=(write,), stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as answer:
            number = answer.readline().strip()
        self.env = {
            **os.environ, "DISPLAY": f":{number}", "XDG_CONFIG_HOME": str(folder / "config"), "PYTHONPATH": str(ROOT),
        }  # fmt: skip
        self.env.pop("WAYLAND_DISPLAY", None)
        self.programs: list[subprocess.Popen] = []
        self.window = ""
        if resources:
            set_resources(self.env["DISPLAY"], resources)

    def start(self, *words: str, **environment: str) -> subprocess.Popen:
        """`brace demo` with these words; returns once its window has shown a picture."""
        program = self.run(*words, **environment)
        self.window = self.xdotool("search", "--sync", "--onlyvisible", "--name", "^Brace").split()[0]
        self.xdotool("windowmove", self.window, "0", "0")
        self.xdotool("windowfocus", self.window)
        self.until(lambda: np.ptp(self.screen()[:300, :300]) > 0.3, "a picture")
        return program

    def run(self, *words: str, **environment: str) -> subprocess.Popen:
        """`brace demo` with these words."""
        make_ready()
        program = subprocess.Popen(
            [sys.executable, "-m", "demos.cli", "demo", *words], cwd=self.folder, env={**self.env, **environment},
            text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )  # fmt: skip
        self.programs.append(program)
        return program

    def close(self) -> None:
        """Ends what this desk started, and nothing else."""
        for program in (*self.programs, self.server):
            if program.poll() is None:
                program.terminate()
            program.wait(PATIENCE_S)
            for stream in (program.stdout, program.stderr):
                if stream:
                    stream.close()

    def __enter__(self) -> Desk:
        return self

    def __exit__(self, *failure) -> None:
        self.close()

    def xdotool(self, *words: str) -> str:
        done = subprocess.run(
            ["xdotool", *words], env=self.env, capture_output=True, text=True, timeout=PATIENCE_S, check=False
        )
        return done.stdout

    def key(self, *names: str) -> None:
        for name in names:
            self.xdotool("key", name)

    def click(self, x: float, y: float, button: int = 1) -> None:
        self.move(x, y)
        self.xdotool("click", str(button))

    def move(self, x: float, y: float) -> None:
        self.xdotool("mousemove", str(round(x)), str(round(y)))

    def drag(self, x: float, y: float, to_x: float, to_y: float, button: int = 1) -> None:
        self.move(x, y)
        self.xdotool("mousedown", str(button))
        for share in (0.3, 0.6, 1.0):
            self.move(x + share * (to_x - x), y + share * (to_y - y))
            time.sleep(0.1)
        self.xdotool("mouseup", str(button))

    def quit(self) -> None:
        """The cross of the window is pressed."""
        ask_to_close(self.env["DISPLAY"], int(self.window))

    def screen(self) -> np.ndarray:
        """(H, W, 3) all of the screen."""
        picture = ImageGrab.grab(xdisplay=self.env["DISPLAY"]).convert("RGB")
        return np.asarray(picture).astype(float) / 255.0

    def until(self, holds: Callable[[], object], what: str):
        """What a condition gives once it holds; the screen is kept where it never does."""
        end = time.monotonic() + PATIENCE_S
        while not (found := holds()):
            if time.monotonic() > end:
                ImageGrab.grab(xdisplay=self.env["DISPLAY"]).save(self.folder / "never.png")
                pytest.fail(f"waited in vain for {what}; the screen is in {self.folder / 'never.png'}")
            time.sleep(0.05)
        return found

    def file(self, name: str) -> Path:
        """A file in the folder, once it is there."""
        return self.until(lambda: next(iter(self.folder.glob(name)), None), name)


def set_resources(display_name: str, text: str) -> None:
    """The RESOURCE_MANAGER property of the screen, which tells programs the DPI."""
    x = ctypes.CDLL("libX11.so.6")
    x.XOpenDisplay.restype = ctypes.c_void_p
    x.XInternAtom.restype = x.XDefaultRootWindow.restype = ctypes.c_ulong
    display = ctypes.c_void_p(x.XOpenDisplay(display_name.encode()))
    kind = x.XInternAtom(display, b"STRING", 0)
    name = x.XInternAtom(display, b"RESOURCE_MANAGER", 0)
    data = f"{text}\n".encode()
    root = ctypes.c_ulong(x.XDefaultRootWindow(display))
    x.XChangeProperty(display, root, ctypes.c_ulong(name), ctypes.c_ulong(kind), 8, 0, data, len(data))
    x.XCloseDisplay(display)


class _ClientMessage(ctypes.Structure):
    """Xlib's XClientMessageEvent, padded to the size of XEvent."""

    _fields_ = (
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("window", ctypes.c_ulong),
        ("message_type", ctypes.c_ulong),
        ("format", ctypes.c_int),
        ("data", ctypes.c_long * 5),
        ("padding", ctypes.c_long * 24),
    )


def ask_to_close(display_name: str, window: int) -> None:
    """What a window manager sends when the user presses the cross."""
    x = ctypes.CDLL("libX11.so.6")
    x.XOpenDisplay.restype = ctypes.c_void_p
    x.XInternAtom.restype = ctypes.c_ulong
    display = ctypes.c_void_p(x.XOpenDisplay(display_name.encode()))
    protocols, delete = (x.XInternAtom(display, name, 0) for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW"))
    message = _ClientMessage(type=33, window=window, message_type=protocols, format=32)
    message.data[0] = delete
    x.XSendEvent(display, ctypes.c_ulong(window), 0, ctypes.c_long(0), ctypes.byref(message))
    x.XCloseDisplay(display)
