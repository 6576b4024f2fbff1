"""The camera's hands: which events they take, what those do, and what they leave to others."""

from __future__ import annotations

import pytest

from engine.render.camera import Camera, orbit_camera
from engine.render.controls import CameraHands, steadied
from engine.render.events import (
    CTRL,
    LEFT_BUTTON,
    RIGHT_BUTTON,
    SHIFT,
    Key,
    MouseButton,
    MouseMove,
    Resize,
    Scroll,
)

SIZE = (800, 600)
START = orbit_camera((0, 0, 1), 20, 10, 4.0)


def _drag(button: int, modifiers: int = 0):
    return [
        MouseButton(button, True, 100, 100, modifiers),
        MouseMove(140, 110, 40, 10),
        MouseButton(button, False, 140, 110, modifiers),
    ]


def test_a_left_drag_orbits_about_the_same_target():
    hands = CameraHands(START)
    assert hands.take(_drag(LEFT_BUTTON), SIZE) == []
    assert hands.camera.target == START.target
    assert hands.camera.distance_m == pytest.approx(START.distance_m)
    assert hands.camera.eye != pytest.approx(START.eye)
    assert hands.camera.eye[2] > START.eye[2]  # dragging down shows more from above


@pytest.mark.parametrize(("button", "modifiers"), [(RIGHT_BUTTON, 0), (LEFT_BUTTON, SHIFT)])
def test_right_and_shift_drags_pan(button, modifiers):
    hands = CameraHands(START)
    assert hands.take(_drag(button, modifiers), SIZE) == []
    assert hands.camera.target != pytest.approx(START.target)
    assert hands.camera.axes()[2] == pytest.approx(START.axes()[2])


def test_the_wheel_zooms_and_x_asks_for_a_frame():
    hands = CameraHands(START)
    assert hands.take([Scroll(0, 2, 5, 5), Key("x", "press")], SIZE) == []
    assert hands.camera.distance_m < START.distance_m
    assert hands.centred
    hands.frame([(0, 0, 0), (0, 0, 1.8)], SIZE)
    assert not hands.centred


def test_throws_selections_and_keys_are_left_to_others():
    hands, others = CameraHands(START), [
        MouseButton(LEFT_BUTTON, True, 1, 1, CTRL),
        MouseMove(5, 5, 4, 4),
        MouseButton(LEFT_BUTTON, False, 5, 5, CTRL),
        MouseButton(LEFT_BUTTON, True, 1, 1, 0, clicks=2),
        Key("space", "press"),
        Key("x", "press", CTRL),
        Resize(3, 4),
    ]  # fmt: skip
    assert hands.take(others, SIZE) == others
    assert hands.camera == START


def test_the_camera_does_not_follow_while_it_is_being_turned():
    hands = CameraHands(START)
    hands.take([MouseButton(LEFT_BUTTON, True, 1, 1)], SIZE)
    hands.follow((5, 5, 5), 1.0)
    assert hands.camera == START
    hands.take([MouseButton(LEFT_BUTTON, False, 1, 1)], SIZE)
    hands.follow((5, 5, 5), 0.1)
    assert hands.camera.target[0] > START.target[0]


def test_the_eye_stays_over_the_floor():
    low = Camera(eye=(3, 0, -0.5))
    assert steadied(low).eye[2] > 0
    assert steadied(START) is START
