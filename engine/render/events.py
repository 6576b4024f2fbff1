"""What the user did, as plain data: a window hands these out, controls and panels read them, tests write them.

Positions are framebuffer pixels from the top left corner, so that nobody downstream thinks about high-DPI scaling.
"""

from __future__ import annotations

from typing import NamedTuple

SHIFT, CTRL, ALT, SUPER = 1, 2, 4, 8  # bits of `modifiers`
LEFT_BUTTON, RIGHT_BUTTON, MIDDLE_BUTTON = 0, 1, 2


class Key(NamedTuple):
    """A key went down, came up or repeats. Names: "space", "left", "f1", "a", "-", ... lower case."""

    name: str
    action: str  # press | release | repeat
    modifiers: int = 0


class Text(NamedTuple):
    """A character was typed, after keyboard layout and dead keys."""

    character: str


class MouseMove(NamedTuple):
    """The cursor moved; the position is where it is now."""

    x_px: float
    y_px: float
    dx_px: float
    dy_px: float


class MouseButton(NamedTuple):
    """A button went down or up. `clicks` is 2 on the second press of a double click."""

    button: int
    pressed: bool
    x_px: float
    y_px: float
    modifiers: int = 0
    clicks: int = 1


class Scroll(NamedTuple):
    """The wheel turned: positive steps_y away from the user."""

    steps_x: float
    steps_y: float
    x_px: float
    y_px: float


class Resize(NamedTuple):
    """The framebuffer has a new size. Zero by zero while minimised."""

    width_px: int
    height_px: int


class Drop(NamedTuple):
    """Files were dropped on the window."""

    paths: tuple[str, ...]


class Close(NamedTuple):
    """The user asked the window to close."""


Event = Key | Text | MouseMove | MouseButton | Scroll | Resize | Drop | Close
