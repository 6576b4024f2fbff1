"""Widgets over a picture, without a display: driven by the events of a window, judged by what they return and show."""

import numpy as np
import pytest

from engine.render.events import LEFT_BUTTON, Key, MouseButton, MouseMove, Scroll, Text
from engine.render.ui.overlay import Overlay
from engine.render.ui.style import PAPER

SIZE = (400, 300)
GREY = 0.5


class Stage:
    """A small window's worth of widgets. `values` are what the widgets are about."""

    def __init__(self, gl):
        self.gl = gl
        self.overlay = Overlay(gl)
        self.values = {"share": 0.25, "count": 2, "on": False, "word": "", "kind": "a", "clicks": 0}
        self.target, self.scale = None, 1.0
        self.canvas_pressed, self.canvas_mouse = False, None
        self.resize(1.0)

    def resize(self, scale):
        self.scale = scale
        size = (int(SIZE[0] * scale), int(SIZE[1] * scale))
        self.target = self.gl.framebuffer([self.gl.texture(size, 4)])

    def draw(self, ui):
        values = self.values
        with ui.area("panel", 200, 10, 190, 280):
            values["share"] = ui.slider("Share", values["share"], 0.0, 1.0)
            values["count"] = ui.whole("Count", values["count"], 0, 10)
            values["on"] = ui.toggle("On", values["on"])
            values["word"] = ui.entry("word", values["word"])
            values["clicks"] += ui.button("Click", width=-1.0)
            canvas = ui.canvas("canvas", 40.0)
            canvas.box(0, 0, canvas.width, 40, (0.8, 0.1, 0.1, 1.0))
            self.canvas_pressed |= canvas.pressed
            self.canvas_mouse = canvas.mouse if canvas.held else self.canvas_mouse

    def frames(self, count, *events):
        """Returns the events that no widget took."""
        rest = self.overlay.take(events, self.scale)
        for _ in range(count):
            self.target.clear(GREY, GREY, GREY, 1.0)
            self.overlay.paint(self.target, self.scale, 1 / 60, self.draw)
        return rest

    def picture(self):
        width, height = self.target.size
        pixels = np.frombuffer(self.target.read(components=3, alignment=1), np.uint8)
        return pixels.reshape(height, width, 3)[::-1].astype(float) / 255.0


@pytest.fixture(scope="module")
def module_stage(_shared_renderer):
    stage = Stage(_shared_renderer.gl)
    yield stage
    stage.overlay.close()


@pytest.fixture
def stage(module_stage, renderer):
    module_stage.resize(1.0)
    module_stage.values.update(share=0.25, count=2, on=False, word="", clicks=0)
    module_stage.canvas_pressed, module_stage.canvas_mouse = False, None
    module_stage.frames(3, MouseMove(5, 5, 0, 0))
    return module_stage


def at(x, y):
    return MouseMove(x, y, 0, 0)


def press(x, y):
    return MouseButton(LEFT_BUTTON, True, x, y)


def release(x, y):
    return MouseButton(LEFT_BUTTON, False, x, y)


def test_the_panel_is_paper_and_the_rest_is_left_alone(stage):
    picture = stage.picture()
    assert np.abs(picture[:, :195] - GREY).max() < 0.01
    paper = GREY + (np.array(PAPER[:3]) - GREY) * PAPER[3]
    assert np.abs(picture[260:280, 220:380] - paper).max() < 0.02
    assert picture[15:60, 205:280].min() < 0.4  # letters


def test_a_drag_within_one_frame_arrives_where_it_ends(stage):
    """Where frames are slow all of a drag comes at once."""
    slow = stage.frames(6, at(310, 31), press(310, 31), at(340, 31), at(360, 31), release(360, 31))
    assert slow == [at(310, 31)]  # a move without a button is everybody's
    assert stage.values["share"] > 0.6
    dragged = stage.values["share"]
    stage.frames(2, at(290, 31))
    assert stage.values["share"] == dragged


def test_a_click_a_drag_and_another_click_within_one_frame_all_arrive(stage):
    stage.frames(
        12,
        *(at(300, 134), press(300, 134), release(300, 134)),
        *(at(310, 31), press(310, 31), at(340, 31), at(360, 31), release(360, 31)),
        *(at(300, 134), press(300, 134), release(300, 134)),
    )
    assert stage.values["share"] > 0.6
    assert stage.values["clicks"] == 2


def test_a_drag_over_frames_arrives_at_the_same_place(stage):
    for events in ((at(310, 31), press(310, 31)), (at(340, 31),), (at(360, 31),), (release(360, 31),)):
        stage.frames(2, *events)
    assert stage.values["share"] > 0.6


def test_a_drag_out_of_the_panel_stays_the_widgets(stage):
    assert stage.frames(2, press(330, 31)) == []
    assert stage.frames(2, at(20, 200)) == []
    assert stage.frames(2, release(20, 200)) == []
    assert stage.values["share"] == 0.0


def test_what_is_done_beside_the_panel_is_not_the_widgets(stage):
    events = [at(50, 50), press(50, 50), at(60, 60), release(60, 60), Scroll(0, 1, 60, 60), Key("space", "press")]
    assert stage.frames(3, *events) == events
    assert stage.frames(1, Scroll(0, 1, 300, 100)) == []


def test_buttons_and_switches(stage):
    stage.frames(6, at(300, 134), press(300, 134), release(300, 134))
    assert stage.values["clicks"] == 1
    stage.frames(6, at(220, 83), press(220, 83), release(220, 83))
    assert stage.values["on"] is True


def test_typing_takes_the_keys_until_it_ends(stage):
    assert stage.frames(1, Key("p", "press")) == [Key("p", "press")]
    stage.frames(5, at(300, 108), press(300, 108), release(300, 108))
    assert stage.frames(5, Key("p", "press"), Text("h"), Text("ö"), Key("p", "release")) == []
    assert stage.values["word"] == "hö"
    backspace = (Key("backspace", "press"), Key("backspace", "release"))
    stage.frames(8, *backspace, *backspace, Text("a"))
    assert stage.values["word"] == "a"
    # the same frame may bring the press that ends the typing, and the next key
    assert Key("p", "press") in stage.frames(5, press(50, 50), release(50, 50), Key("p", "press"))
    assert stage.frames(1, Key("p", "press")) == [Key("p", "press")]
    assert stage.values["word"] == "a"


def test_a_canvas_knows_the_mouse(stage):
    stage.frames(2, at(250, 165), press(250, 165))
    assert stage.canvas_pressed
    assert stage.canvas_mouse == pytest.approx((250 - 212, 165 - 150), abs=8)
    stage.frames(2, at(390, 300), release(390, 300))


@pytest.mark.parametrize("scale", [1.5, 2.0, 3.0])
def test_a_dense_screen_shows_the_same_larger(stage, scale):
    small = stage.picture()
    stage.resize(scale)
    stage.frames(4)
    large = stage.picture()
    assert large.shape == (int(SIZE[1] * scale), int(SIZE[0] * scale), 3)
    for x, y in ((20, 20), (220, 270), (300, 165), (205, 100), (195, 100)):  # grey, paper, canvas, paper, grey
        assert np.abs(large[int(y * scale), int(x * scale)] - small[y, x]).max() < 0.03
    letters = large[int(15 * scale) : int(60 * scale), int(205 * scale) : int(280 * scale)]
    darkest = np.sort(letters.mean(axis=-1).ravel())
    assert darkest[len(darkest) // 200] < 0.45  # crisp strokes: not a small picture that was stretched
    stage.frames(4, at(310 * scale, 31 * scale), press(310 * scale, 31 * scale), release(310 * scale, 31 * scale))
    assert 0.2 < stage.values["share"] < 0.7
    assert stage.frames(1, press(195 * scale, 50 * scale)) != []
    stage.frames(1, release(195 * scale, 50 * scale))
