"""The interactive loop: the one place where the wall clock, the user and the renderer meet.

Nothing here knows what is shown:

    run_loop(context, Renderer(context), show)

`show` is anything with the three methods of `Show`; `demos` has the real ones, tests have tiny ones.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Protocol

from engine.render.camera import Camera
from engine.render.context import Context
from engine.render.controls import CameraHands, steadied
from engine.render.events import Event
from engine.render.quality import Governor
from engine.render.renderer import Renderer
from engine.render.scene import Scene, extent_points


class Show(Protocol):
    """What a demo gives the loop."""

    def handle(self, events: list[Event], camera: Camera, size_px: tuple[int, int]) -> None:
        """What the user did, less what moved the camera. The camera and size turn pixels into rays."""

    def advance(self, passed_s: float) -> None:
        """Real time has passed; the show's clock decides how many ticks that is."""

    def scene(self) -> Scene:
        """What to draw now. `scene.floor`, balances and so on are the show's choice."""


class Layer(Protocol):
    """What lies on the picture: panels and words."""

    def take(self, events: list[Event], context: Context) -> list[Event]:
        """Its share of what the user did, before anybody else; returns the rest."""

    def paint(self, renderer: Renderer, context: Context, passed_s: float) -> None:
        """The picture is drawn and not shown yet. Called only where there is one."""


def run_loop(
    context: Context,
    renderer: Renderer,
    show: Show,
    *,
    layer: Layer | None = None,
    hands: CameraHands | None = None,
    follow: Callable[[], object] | None = None,
    framed: Callable[[Camera, tuple[int, int]], Camera] | None = None,
    frames: int | None = None,
    clock: Callable[[], float] = time.perf_counter,
    governor: Governor | None = None,
) -> CameraHands:
    """Runs until the window closes, or for a number of frames. Returns the hands, with the camera where it was left.

    layer: paints over the finished picture, and is the first to be shown events.
    framed: the camera that the picture is taken with, from the one in the hands: for pictures that are partly covered.
    governor: picks the quality from what frames take; None leaves the renderer's as it is.
    follow: gives a point (3,) that the camera keeps up with, or None to stay. hands None: the first picture frames
    everything in it.
    """
    hands = hands or CameraHands(centred=True)
    last_s, drawn = clock(), 0
    while not context.closing and (frames is None or drawn < frames):
        happened, size_px = context.poll(), context.size_px
        if layer:
            happened = layer.take(happened, context)
        events = hands.take(happened, size_px)
        now_s = clock()
        passed_s, last_s = now_s - last_s, now_s
        show.handle(events, framed(hands.camera, size_px) if framed else hands.camera, size_px)
        show.advance(passed_s)
        scene = show.scene()
        if hands.centred:
            hands.frame(extent_points(scene), size_px)
        elif follow is not None:
            hands.follow(follow(), passed_s)
        begun_s = clock() if governor else 0.0
        renderer.draw(scene, steadied(framed(hands.camera, size_px) if framed else hands.camera))
        if governor:
            renderer.finish()
            renderer.quality = governor.took(clock() - begun_s, size_px)
        if layer and min(size_px) > 0:
            layer.paint(renderer, context, passed_s)
        renderer.present()
        drawn += 1
    return hands
