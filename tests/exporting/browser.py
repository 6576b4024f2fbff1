"""A headless Chromium for tests, driven through its debugging pipe: real pages, real mouse and keys, screenshots."""

from __future__ import annotations

import base64
import contextlib
import fcntl
import io
import json
import os
import select
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

PATIENCE_S = 60.0
FLAGS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--remote-debugging-pipe",
)  # fmt: skip


def find_chromium() -> str | None:
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


class Page:
    """One tab. `call` speaks the Chrome DevTools Protocol: JSON messages that end in a zero byte."""

    def __init__(self, to_browser: int, from_browser: int):
        self.to_browser, self.from_browser = to_browser, from_browser
        self.number, self.pending, self.session = 0, b"", None
        self.requests: list[str] = []  # addresses that the page asked for

    def call(self, method: str, **wanted: Any) -> dict[str, Any]:
        self.number += 1
        message = {"id": self.number, "method": method, "params": wanted}
        if self.session:
            message["sessionId"] = self.session
        os.write(self.to_browser, json.dumps(message).encode() + b"\0")
        while True:
            heard = self._hear()
            if heard.get("method") == "Network.requestWillBeSent":
                self.requests.append(heard["params"]["request"]["url"])
            if heard.get("id") == self.number:
                assert "error" not in heard, heard
                return heard["result"]

    def _hear(self) -> dict[str, Any]:
        while b"\0" not in self.pending:
            ready, _, _ = select.select([self.from_browser], [], [], PATIENCE_S)
            assert ready, "the browser says nothing"
            heard = os.read(self.from_browser, 1 << 20)
            assert heard, "the browser is gone"
            self.pending += heard
        first, _, self.pending = self.pending.partition(b"\0")
        return json.loads(first)

    def open(self, address: str) -> None:
        self.call("Page.navigate", url="about:blank")  # a change of the part after # alone would not load anything
        self.call("Page.navigate", url=address)
        self.wait_for("document.body && document.body.dataset.state && document.body.dataset.state !== 'loading'")

    def value(self, expression: str) -> Any:
        return self.call("Runtime.evaluate", expression=expression, returnByValue=True)["result"].get("value")

    def wait_for(self, expression: str) -> None:
        end = time.monotonic() + PATIENCE_S
        while not self.value(expression):
            assert time.monotonic() < end, f"never came true: {expression}"
            time.sleep(0.05)

    def mouse(self, kind: str, x: float, y: float, **more: Any) -> None:
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def drag(self, start: tuple[float, float], end: tuple[float, float], button: str = "left") -> None:
        held = {"left": 1, "right": 2}[button]
        self.mouse("mouseMoved", *start)
        self.mouse("mousePressed", *start, button=button, buttons=held, clickCount=1)
        for share in (0.5, 1.0):
            self.mouse("mouseMoved", *(a + share * (b - a) for a, b in zip(start, end, strict=True)),
                       button=button, buttons=held)  # fmt: skip
        self.mouse("mouseReleased", *end, button=button, clickCount=1)

    def key(self, key: str) -> None:
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **text)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key)

    def picture(self) -> np.ndarray:
        """(H, W, 3) uint8, once everything asked for is drawn."""
        drawn = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"
        self.call("Runtime.evaluate", awaitPromise=True, expression=drawn)
        data = base64.b64decode(self.call("Page.captureScreenshot", format="png")["data"])
        return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))


@contextlib.contextmanager
def browser_page(folder: Path, size: tuple[int, int] = (800, 560)) -> Iterator[Page]:
    """A page in a browser of its own, with its profile in `folder`; the browser and its children end with it."""
    ours, theirs = [], []
    for child_end in (0, 1):  # the child reads from the first pipe and writes into the second
        ends = os.pipe()
        theirs.append(fcntl.fcntl(ends[child_end], fcntl.F_DUPFD_CLOEXEC, 10))  # out of the way of 3 and 4
        ours.append(ends[1 - child_end])
        os.close(ends[child_end])

    def take_places() -> None:
        os.dup2(theirs[0], 3)
        os.dup2(theirs[1], 4)

    words = [find_chromium(), *FLAGS, f"--user-data-dir={folder}", f"--window-size={size[0]},{size[1]}", "about:blank"]
    process = subprocess.Popen(
        words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        preexec_fn=take_places, close_fds=False, start_new_session=True,
    )  # fmt: skip
    for end in theirs:
        os.close(end)
    try:
        page = Page(*ours)
        target = page.call("Target.createTarget", url="about:blank")["targetId"]
        page.session = page.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        page.call("Page.enable")
        page.call("Network.enable")
        page.call(
            "Emulation.setDeviceMetricsOverride", width=size[0], height=size[1], deviceScaleFactor=1, mobile=False
        )
        yield page
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        for end in ours:
            os.close(end)
