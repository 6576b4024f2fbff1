"""The window of `brace demo` on a virtual display: everything is done by real keys and a real mouse, and judged by what
the screen shows and by the files that were saved.
"""

from __future__ import annotations

import json
import time
import tomllib

import numpy as np
import pytest
from PIL import Image

from demos.window.panels import make_panels
from engine.body.skeleton import Pose
from engine.clips.synthetic import sway
from engine.clips.write_bvh import bvh_text
from engine.render.capture import count_frames
from tests.window.desk import PATIENCE_S, Desk, needs_display
from tests.window.dropping import drop

pytestmark = needs_display
WIDTH, HEIGHT = 960, 600
PANEL = (650, 950)  # left and right of the panel, pixels
TABS = {
    panel.title: (PANEL[0] + 45 + 70 * (number % 4), 30 + 25 * (number // 4))
    for number, panel in enumerate(make_panels())
}
PAPER = np.array((0.972, 0.966, 0.955))
TIMELINE_Y, TIMELINE_X = 552, (22, 938)  # the phases, and where the line begins and ends
TICK_PX = (TIMELINE_X[1] - TIMELINE_X[0]) / (12.0 * 120.0)


@pytest.fixture
def desk(tmp_path):
    """A window of its own for each test: nothing depends on which of them ran before, or beside."""
    with Desk(tmp_path) as desk:
        desk.start("sway", "--set", "threat=[]", "--size", f"{WIDTH}x{HEIGHT}", "--quality", "fastest")
        desk.until(lambda: is_paper(desk, 655, 200), "the panel")
        yield desk


def is_paper(desk, x, y):
    """Whether a small patch is the panels' paper, which lets a little of the picture through."""
    patch = desk.screen()[y - 3 : y + 3, x - 2 : x + 2]
    return bool(np.abs(patch - PAPER).max() < 0.09)


def picture(desk):
    """The part of the screen where nothing lies on the picture."""
    return desk.screen()[190:340, 260:640]


def differ(a, b):
    return float(np.abs(a - b).max()) > 0.1


def turned(a, b):
    """Whether most of the picture is another."""
    return float(np.abs(a - b).mean()) > 0.02


def stands_still(desk):
    """Over a time in which the slowest machine has drawn another frame."""
    first = picture(desk)
    time.sleep(1.5)
    return not differ(first, picture(desk))


def saved(desk):
    """What the run is by now, as a scenario that is saved for it."""
    number = len(list(desk.folder.glob("scenario-*.toml"))) + 1
    desk.key("ctrl+s")
    path = desk.file(f"scenario-{number}.toml")
    return tomllib.loads(path.read_text())


def came_in(desk, count):
    """What has come in from outside, once it is that many."""

    def found():
        commands = saved(desk).get("command", [])
        return commands if len(commands) == count else None

    return desk.until(found, f"{count} commands")


def space_pauses_and_goes_on(desk):
    first = picture(desk)
    desk.until(lambda: differ(first, picture(desk)), "a moving picture")
    desk.key("space")
    desk.until(lambda: stands_still(desk), "a still picture")
    desk.key("space")
    still = picture(desk)
    desk.until(lambda: differ(still, picture(desk)), "a moving picture again")


def tab_takes_the_panels_away_and_brings_them_back(desk):
    desk.key("Tab")
    desk.until(lambda: not is_paper(desk, 655, 200), "no panel")
    desk.key("Tab")
    desk.until(lambda: is_paper(desk, 655, 200), "the panel")


def a_throw_is_held_and_let_go(desk):
    desk.move(480, 160)
    desk.xdotool("keydown", "f")
    time.sleep(4.0)  # long enough on a busy machine, whose window hears of the key late
    desk.xdotool("keyup", "f")
    (command,) = came_in(desk, 1)
    assert np.linalg.norm(command["throw"]["velocity_mps"]) == pytest.approx(30.0, rel=0.1)  # held to the full


def a_slider_is_dragged_and_the_threat_sent_by_its_button(desk):
    desk.click(*TABS["Threat"])
    desk.drag(PANEL[0] + 211, 120, PANEL[0] + 150, 120)  # azimuth, to the left
    time.sleep(0.3)
    desk.click(PANEL[0] + 150, 412)  # Send it now
    commands = came_in(desk, 2)
    assert commands[1]["threat"]["azimuth_deg"] < -40.0


def panels_do_not_turn_the_camera_and_the_picture_does(desk):
    desk.key("space")
    desk.until(lambda: stands_still(desk), "a still picture")
    still = picture(desk)
    desk.drag(PANEL[0] + 150, 560 - 70, PANEL[0] + 40, 560 - 70)  # on the panel's paper
    time.sleep(0.5)
    assert not turned(still, picture(desk))
    desk.drag(450, 300, 520, 300)
    desk.until(lambda: turned(still, picture(desk)), "another view")


def the_timeline_is_clicked_and_dragged(desk):
    """Paused by the step before. What was thrown can be gone back to, and another throw begins another future."""
    desk.key("End")
    time.sleep(0.3)
    ends = picture(desk)
    last = saved(desk)["duration_s"]
    desk.click(TIMELINE_X[0] + 30 * TICK_PX, TIMELINE_Y)
    desk.until(lambda: differ(ends, picture(desk)), "an earlier picture")
    desk.drag(TIMELINE_X[0] + 30 * TICK_PX, TIMELINE_Y, TIMELINE_X[0] + 90 * TICK_PX, TIMELINE_Y)
    desk.until(lambda: abs(dark_column(desk) - TIMELINE_X[0] - 90 * TICK_PX) < 6, "the needle where it was dragged to")
    assert saved(desk)["duration_s"] == last  # looking back loses nothing
    desk.key("t")
    (command,) = came_in(desk, 1)  # what came in later, in the old future, is gone with it
    assert command["at_s"] == pytest.approx(0.75, abs=0.06)
    desk.key("space")


def dark_column(desk) -> float:
    """Where the needle of the timeline stands."""
    strip = desk.screen()[TIMELINE_Y - 22 : TIMELINE_Y + 5, TIMELINE_X[0] - 4 : TIMELINE_X[1] + 4].mean(axis=(0, 2))
    return TIMELINE_X[0] - 4 + float(np.argmin(strip))


def single_steps_move_the_needle_by_ticks(desk):
    desk.until(lambda: stands_still(desk), "a still picture")
    before = dark_column(desk)
    desk.key(*["comma"] * 12)
    desk.until(lambda: abs(before - dark_column(desk) - 12 * TICK_PX) < 1.6, "the needle 12 ticks back")
    desk.key(*["period"] * 12)
    desk.until(lambda: abs(dark_column(desk) - before) < 1.1, "the needle where it was")


def help_shows_and_goes(desk):
    desk.key("Tab")
    desk.until(lambda: not is_paper(desk, 655, 200), "no panel")
    desk.key("F1")
    desk.until(lambda: is_paper(desk, 655, 200), "the help")
    desk.key("Escape")
    desk.until(lambda: not is_paper(desk, 655, 200), "no help")
    desk.key("Tab")
    desk.until(lambda: is_paper(desk, 655, 200), "the panel")


def a_screenshot_is_the_picture_without_what_lies_on_it(desk):
    desk.until(lambda: stands_still(desk), "a still picture")
    desk.key("p")
    path = desk.file("screenshot-1.png")
    with Image.open(path) as kept:
        assert kept.size == (WIDTH, HEIGHT)
        shot = np.asarray(kept).astype(float) / 255.0
    shown = desk.screen()[:HEIGHT, :WIDTH]
    assert np.abs(shot[190:340, 260:420] - shown[190:340, 260:420]).mean() < 0.004  # the camera may still glide a bit
    assert np.abs(shot[150:300, 652:662] - PAPER).max() > 0.15  # where the panel lies on the screen


def search_takes_the_keys_while_it_is_typed_in(desk):
    desk.click(*TABS["Clips"])
    time.sleep(2.0)
    desk.click(PANEL[0] + 100, 98)
    time.sleep(2.0)
    desk.xdotool("type", "sway p t")
    time.sleep(1.0)
    assert not (desk.folder / "screenshot-2.png").exists()
    desk.click(450, 350)
    desk.key("p")
    desk.file("screenshot-2.png")


def a_film_is_made_while_it_plays(desk):
    desk.key("r")
    time.sleep(2.0)
    desk.key("r")
    time.sleep(0.5)
    path = desk.file("film-1.mp4")
    assert 20 <= count_frames(path) <= 60 * PATIENCE_S


def plays(desk):
    return saved(desk)["character"][0]["clip"]


def test_a_file_is_dropped_on_it(desk):
    """One that is no clip first: it is said, and all goes on as it was."""
    clip, bad = sway(), desk.folder / "bad.bvh"
    bad.write_text("HIERARCHY\nROOT", encoding="utf-8")
    assert drop(desk.env["DISPLAY"], int(desk.window), (450, 300), bad, PATIENCE_S)
    time.sleep(1.0)
    assert plays(desk) == "sway"
    good = desk.folder / "mine.bvh"
    pose = Pose(clip.pose.root_m[:120], clip.pose.rotations[:120])
    good.write_text(bvh_text(clip.body, pose, clip.fps), encoding="utf-8")
    assert drop(desk.env["DISPLAY"], int(desk.window), (450, 300), good, PATIENCE_S)
    desk.until(lambda: plays(desk) == str(good), "the dropped clip")


def the_panels_go_along_with_the_size(desk):
    desk.xdotool("windowsize", "--sync", desk.window, "800", "500")
    desk.until(lambda: is_paper(desk, 495, 200) and not is_paper(desk, 482, 200), "the panel at its new place")
    desk.xdotool("windowsize", "--sync", desk.window, str(WIDTH), str(HEIGHT))
    desk.until(lambda: is_paper(desk, 655, 200) and not is_paper(desk, 642, 200), "the panel at its old place")


def minimised_it_lives_on(desk):
    desk.xdotool("windowunmap", "--sync", desk.window)
    time.sleep(0.5)
    desk.xdotool("windowmap", "--sync", desk.window)
    desk.xdotool("windowfocus", desk.window)
    desk.until(lambda: is_paper(desk, 655, 200), "the panel")
    first = picture(desk)
    desk.until(lambda: differ(first, picture(desk)), "a moving picture")


def test_keys_pause_hide_and_help(desk):
    space_pauses_and_goes_on(desk)
    tab_takes_the_panels_away_and_brings_them_back(desk)
    help_shows_and_goes(desk)


def test_balls_are_thrown_and_time_is_gone_back_in(desk):
    a_throw_is_held_and_let_go(desk)
    a_slider_is_dragged_and_the_threat_sent_by_its_button(desk)
    panels_do_not_turn_the_camera_and_the_picture_does(desk)
    the_timeline_is_clicked_and_dragged(desk)
    single_steps_move_the_needle_by_ticks(desk)


def test_pictures_and_films_are_kept(desk):
    a_film_is_made_while_it_plays(desk)
    desk.key("space")
    a_screenshot_is_the_picture_without_what_lies_on_it(desk)
    search_takes_the_keys_while_it_is_typed_in(desk)


def test_the_window_changes_its_size_and_goes_away_for_a_while(desk):
    the_panels_go_along_with_the_size(desk)
    minimised_it_lives_on(desk)


def test_closed_it_ends_in_order_and_remembers(desk):
    desk.click(*TABS["View"])
    time.sleep(2.0)
    desk.key("g")
    time.sleep(1.0)
    desk.quit()
    program = desk.programs[0]
    assert program.wait(PATIENCE_S) == 0
    kept = json.loads((desk.folder / "config" / "brace" / "window.json").read_text())
    assert kept["tab"] == "View"
    assert kept["view"]["ghost_rules"] is True
    desk.start("sway", "--size", f"{WIDTH}x{HEIGHT}", "--quality", "fastest")
    desk.until(lambda: is_paper(desk, 655, 200), "the panel")
    desk.click(*TABS["Threat"])
    time.sleep(2.0)
    desk.quit()
    assert desk.programs[1].wait(PATIENCE_S) == 0
    kept = json.loads((desk.folder / "config" / "brace" / "window.json").read_text())
    assert kept["view"]["ghost_rules"] is True
    assert kept["tab"] == "Threat"
