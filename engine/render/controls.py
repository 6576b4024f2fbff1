"""Hands on the camera: drag to orbit, right or Shift drag to pan, wheel to zoom, X to centre. Events in, camera out."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from engine.render import camera as cam
from engine.render.camera import Camera
from engine.render.events import (
    CTRL,
    LEFT_BUTTON,
    MIDDLE_BUTTON,
    RIGHT_BUTTON,
    SHIFT,
    Event,
    Key,
    MouseButton,
    MouseMove,
    Scroll,
)

ORBIT_RAD_PER_HEIGHT = 3.6  # a drag over the height of the picture turns the camera this far


@dataclass
class CameraHands:
    """The camera and which drag is under way; the loop feeds it events and asks it for the camera."""

    camera: Camera = field(default_factory=Camera)
    drag: str = ""  # "", orbit or pan
    centred: bool = False  # X was pressed: the loop should frame everything
    aside_m: np.ndarray = field(default_factory=lambda: np.zeros(3))  # how far a pan has put what is followed aside

    def take(self, events: Iterable[Event], size_px) -> list[Event]:
        """Applies what is meant for the camera; returns what is not."""
        return [event for event in events if not self._took(event, size_px)]

    def follow(self, point_m, passed_s: float) -> None:
        """Glides along with a moving point, unless the user is just turning the view; None: stays.

        What the user panned away from the point stays away as far.
        """
        if point_m is None or self.drag:
            return
        self.camera = cam.follow(self.camera, np.add(point_m, self.aside_m), passed_s)

    def frame(self, points_m, size_px) -> None:
        """Brings all points (N, 3) into the picture; waits while there is none (minimised)."""
        if min(size_px) <= 0:
            return
        self.camera = cam.frame_all(self.camera, points_m, size_px)
        self.centred = False
        self.aside_m = np.zeros(3)

    def _took(self, event: Event, size_px) -> bool:
        if isinstance(event, MouseButton):
            return self._took_button(event)
        if isinstance(event, MouseMove) and self.drag:
            self._move(event, size_px)
            return True
        if isinstance(event, Scroll):
            self.camera = cam.zoom(self.camera, event.steps_y)
            return True
        if isinstance(event, Key) and event.name == "x" and event.action == "press" and not event.modifiers:
            self.centred = True
            return True
        return False

    def _took_button(self, event: MouseButton) -> bool:
        """Ctrl-click is a throw and a double click selects: those are for others."""
        if not event.pressed:
            was, self.drag = self.drag, ""
            return bool(was)
        if event.modifiers & CTRL or event.clicks > 1:
            return False
        if event.button in (RIGHT_BUTTON, MIDDLE_BUTTON) or event.modifiers & SHIFT:
            self.drag = "pan"
        elif event.button == LEFT_BUTTON:
            self.drag = "orbit"
        return bool(self.drag)

    def _move(self, event: MouseMove, size_px) -> None:
        if self.drag == "pan":
            before, self.camera = self.camera, cam.pan(self.camera, event.dx_px, event.dy_px, size_px)
            self.aside_m = self.aside_m + np.subtract(self.camera.target, before.target)
            return
        per_px = ORBIT_RAD_PER_HEIGHT / max(size_px[1], 1)
        self.camera = cam.orbit(self.camera, -event.dx_px * per_px, event.dy_px * per_px)


def steadied(camera: Camera, floor_m: float = 0.06) -> Camera:
    """The same view from no lower than just over the floor: under it there is nothing to see."""
    x, y, z = camera.eye
    return camera if z >= floor_m else replace(camera, eye=(x, y, floor_m))
