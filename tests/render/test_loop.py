"""The interactive loop on a context without a screen: the same code, events pushed instead of happening."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from engine.core.debug_draw import DebugDraw
from engine.render.camera import Camera, project
from engine.render.context import Offscreen
from engine.render.controls import CameraHands
from engine.render.events import Close, Key, Resize, Scroll
from engine.render.loop import run_loop
from engine.render.scene import CLIP_BLUE, Ball, Scene, extent_points
from tests.render.people import person


class Recorder:
    """A show that writes down what it is told."""

    def __init__(self, scene: Scene):
        self.shown, self.events, self.passed_s, self.sizes = scene, [], [], []

    def handle(self, events, camera, size_px):
        self.events += events
        self.sizes.append(size_px)

    def advance(self, passed_s):
        self.passed_s.append(passed_s)

    def scene(self):
        return self.shown


@pytest.fixture
def stage(renderer):
    """The shared GL context with an event queue of its own, as a context that can be closed."""
    context = Offscreen.__new__(Offscreen)
    context.gl, context.size_px, context.scale = renderer.gl, (160, 120), 1.0
    context.closing, context._waiting = False, []
    shared, renderer.context = renderer.context, context
    yield context
    renderer.context = shared


def test_time_events_and_frames_reach_the_show(stage, renderer):
    show, ticks = Recorder(Scene(figures=[person()])), iter(np.arange(10) * 0.5)
    stage.push(Key("space", "press"), Scroll(0, 1, 5, 5))
    run_loop(stage, renderer, show, frames=3, clock=lambda: float(next(ticks)))
    assert show.events == [Key("space", "press")]  # the wheel is the camera's
    assert show.passed_s == [0.5, 0.5, 0.5]
    assert renderer.read_rgb().shape == (120, 160, 3)


def test_the_first_picture_frames_everything(stage, renderer):
    scene = Scene(figures=[person(at=(4.0, -3.0))], balls=[Ball((4.0, -1.0, 2.0))])
    hands = run_loop(stage, renderer, Recorder(scene), frames=1)
    pixels, _ = project(hands.camera, extent_points(scene), (160, 120))
    assert pixels.min() > 0
    assert (pixels < (160, 120)).all()


def test_following_keeps_up_with_a_walker(stage, renderer):
    walker, ticks = SimpleNamespace(x=0.0), iter(np.arange(500) / 60)

    def place():
        walker.x += 1.4 / 60
        return (walker.x, 0.0, 0.9)

    hands = CameraHands(Camera(eye=(3.0, 2.0, 1.5), target=(0.0, 0.0, 0.9)))
    run_loop(
        stage, renderer, Recorder(Scene()), hands=hands, follow=place, frames=240, clock=lambda: float(next(ticks))
    )
    lag_m = 1.4 * 0.25 / np.log(2.0)  # a point that moves steadily is followed a mean life behind
    assert walker.x - hands.camera.target[0] == pytest.approx(lag_m, rel=0.05)


def test_resizing_to_nothing_and_back_goes_on(stage, renderer):
    show, hands = Recorder(Scene(figures=[person()])), CameraHands(centred=True)
    stage.push(Resize(0, 0))
    run_loop(stage, renderer, show, hands=hands, frames=2)
    assert hands.centred  # still to be done when there is a picture again
    stage.push(Resize(90, 70))
    run_loop(stage, renderer, show, hands=hands, frames=2)
    assert show.sizes[-1] == (90, 70)
    assert renderer.read_rgb().shape == (70, 90, 3)
    assert not hands.centred


def test_closing_ends_the_loop(stage, renderer):
    stage.push(Close())
    show = Recorder(Scene())
    run_loop(stage, renderer, show)
    assert show.events == [Close()]


def test_words_and_lines_grow_with_the_screens_density(stage, renderer):
    draw = DebugDraw()
    draw.label((0.0, 0.0, 0.9), "26 m/s", CLIP_BLUE)
    draw.line((0.0, -0.5, 0.5), (0.0, 0.5, 0.5), CLIP_BLUE)
    inked = []
    for scale in (1.0, 2.0):
        stage.scale = scale
        renderer.draw(Scene(draw=draw), Camera(), (320, 240))
        inked.append((np.ptp(renderer.read_rgb().astype(int), axis=2) > 60).sum())
    assert 2.0 < inked[1] / inked[0] < 5.0
