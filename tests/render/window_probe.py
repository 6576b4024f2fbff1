"""A small show in a real window, run as a process of its own by test_window.py: prints what happens, a JSON line each.

Commands come on standard input: `where` says where the camera is, `shot FILE` writes what was drawn, `quit` ends.
"""

from __future__ import annotations

import json
import os
import select
import sys

from PIL import Image

from engine.render.context import make_context
from engine.render.controls import CameraHands
from engine.render.loop import run_loop
from engine.render.renderer import Renderer
from engine.render.scene import Scene
from tests.render.people import person


def _say(**what) -> None:
    print(json.dumps(what), flush=True)


class Probe:
    """Reports events and obeys commands."""

    def __init__(self, context, renderer):
        self.context, self.renderer, self.frames, self.passed_s = context, renderer, 0, 0.0
        self.figure = person()
        self.hands = CameraHands(centred=True)
        self.pending = b""

    def handle(self, events, camera, size_px) -> None:
        for event in events:
            _say(event=type(event).__name__, **event._asdict())
        for command in self._commands():
            word, *rest = command.split(maxsplit=1)
            if word == "quit":
                raise SystemExit
            if word == "where":
                _say(eye=list(camera.eye), target=list(camera.target), size=list(size_px), frames=self.frames)
            if word == "shot":
                self._shot(rest[0])

    def advance(self, passed_s: float) -> None:
        self.passed_s += passed_s
        self.frames += 1

    def scene(self) -> Scene:
        return Scene(figures=[self.figure])

    def _commands(self) -> list[str]:
        while select.select([0], [], [], 0.0)[0]:
            more = os.read(0, 4096)
            if not more:
                raise SystemExit
            self.pending += more
        *whole, self.pending = self.pending.split(b"\n")
        return [line.decode() for line in whole if line]

    def _shot(self, path: str) -> None:
        Image.fromarray(self.renderer.read_rgb()).save(path)
        _say(shot=path)


def main() -> None:
    with make_context(headless=False, size=(480, 360), title="probe") as context:
        probe = Probe(context, Renderer(context))
        _say(ready=True, size=list(context.size_px), scale=context.scale)
        run_loop(context, probe.renderer, probe, hands=probe.hands)
        _say(closed=True)


if __name__ == "__main__":
    sys.exit(main())
