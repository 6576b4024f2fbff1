"""The window's hands on a scenario, driven by the events that a user would cause."""

import numpy as np
import pytest

from behaviours.components import Flight, Reaction, Threat
from demos.filming import CAMERAS
from demos.play import Play, play_of, throw_speed_mps, under_cursor, velocity_to
from demos.running import journal_of, open_scenario, start
from engine.core.journal_file import load_journal
from engine.maths.ballistics import GRAVITY_MPS2, fly
from engine.render.camera import orbit_camera, project
from engine.render.events import CTRL, LEFT_BUTTON, Key, MouseButton, MouseMove

SIZE_PX = (640, 480)
FRAME_S = 1.0 / 60.0


@pytest.fixture
def play(tmp_path) -> Play:
    scenario, folder = open_scenario("sway", ("threat=[]",))
    simulation = start(scenario, folder)
    picture = np.zeros((8, 8, 3), np.uint8)
    return play_of(simulation, journal_of(simulation, folder), lambda: picture, tmp_path)


def camera_of(play):
    return orbit_camera(play.centre_m(), *CAMERAS["front"])


def do(play, *events, frames=1):
    play.handle(list(events), camera_of(play), SIZE_PX)
    for _ in range(frames):
        play.advance(FRAME_S)


def tap(name):
    return (Key(name, "press"), Key(name, "release"))


def test_real_time_passes_in_ticks(play):
    do(play, frames=60)
    assert play.world.tick == 120


def test_space_holds_and_goes_on(play):
    do(play, *tap("space"), frames=10)
    assert play.world.tick == 0
    do(play, *tap("space"), frames=10)
    assert play.world.tick == 20


def test_steps_forth_and_back_are_exact(play):
    do(play, frames=30)
    before = play.world.digest()
    tick = play.world.tick
    do(play, *tap("."))
    assert play.world.tick == tick + 1
    do(play, *tap("left"))
    assert (play.world.tick, play.world.digest()) == (tick, before)


def test_speed_changes_by_steps_and_stops_at_its_ends(play):
    for _ in range(9):
        do(play, *tap("-"), frames=0)
    assert play.clock.rate == 0.05
    for _ in range(9):
        do(play, *tap("="), frames=0)
    assert play.clock.rate == 2.0


def test_backspace_begins_again(play):
    start_digest = play.world.digest()
    do(play, frames=30)
    do(play, *tap("backspace"), frames=0)
    assert (play.world.tick, play.world.digest()) == (0, start_digest)


@pytest.mark.parametrize("how", ["f", "click"])
def test_a_throw_goes_to_what_is_under_the_cursor_and_is_seen_coming(play, how):
    do(play, frames=30)
    camera = camera_of(play)
    head_m = play.scene().figures[0].positions[4] + (0.0, 0.0, 0.08)
    (cursor,), _ = project(camera, head_m, SIZE_PX)
    if how == "f":
        do(play, MouseMove(*cursor, 0, 0), Key("f", "press"), frames=12)
        do(play, Key("f", "release"))
    else:
        do(play, MouseButton(LEFT_BUTTON, True, *cursor, CTRL), frames=12)
        do(play, MouseButton(LEFT_BUTTON, False, *cursor, CTRL))
    (ball,) = play.world.rows(Flight, Threat)
    assert np.linalg.norm(play.world[Flight].velocity_mps[ball]) == pytest.approx(throw_speed_mps(0.2), rel=0.1)
    do(play, frames=90)
    kinds = [event.kind for event in play.world.events]
    assert "perceived" in kinds
    assert "contact" in kinds
    assert play.world[Reaction].struck[0]


def test_a_throw_can_be_taken_back(play):
    do(play, frames=30)
    do(play, MouseMove(320, 200, 0, 0), Key("f", "press"), Key("f", "release"), frames=30)
    do(play, *tap("backspace"), frames=0)
    assert len(play.world.rows(Flight)) == 0


def test_a_recording_of_play_holds_the_throws(play, tmp_path):
    do(play, MouseMove(320, 200, 0, 0), Key("f", "press"), Key("f", "release"), frames=10)
    do(play, *tap("r"), *tap("r"))
    journal = load_journal(tmp_path / "recording-1.brace")
    assert [command["do"] for commands in journal.inputs.values() for command in commands] == ["throw"]
    assert (tmp_path / "recording-2.brace").exists()


def test_what_is_on_the_screen(play, tmp_path):
    do(play, *tap("f1"), *tap("g"), *tap("p"))
    words = "\n".join(text for _, text in play.scene().captions)
    assert "orbit" not in words
    assert "screenshot-1.png" in words
    assert (tmp_path / "screenshot-1.png").exists()
    do(play, *tap("f1"), Key("f", "press"), frames=240)
    words = "\n".join(text for _, text in play.scene().captions)
    assert "orbit" in words
    assert f"throw {throw_speed_mps(9.0):.0f} m/s" in words
    assert "screenshot" not in words.replace("P screenshot", "")


def test_what_is_under_the_cursor(play):
    camera = camera_of(play)
    chest_m = play.scene().figures[0].positions[2]
    eye = np.array(camera.eye)
    ray = (chest_m - eye) / np.linalg.norm(chest_m - eye)
    row, met = under_cursor(play.world, eye, ray)
    assert row == 0
    assert np.linalg.norm(met - chest_m) < 0.25
    assert np.linalg.norm(met - eye) < np.linalg.norm(chest_m - eye)  # the near side
    row, beside = under_cursor(play.world, eye, -np.cross(ray, (0.0, 0.0, 1.0)))
    assert row == 0
    assert np.all(np.isfinite(beside))


def test_a_throw_arrives_where_it_was_aimed():
    start_m, target = np.array([4.0, 1.0, 1.6]), np.array([0.0, 0.0, 1.7])
    for speed in (12.0, 30.0):
        velocity = velocity_to(start_m, target, speed)
        flight_s = np.linalg.norm(target - start_m) / speed
        at, _ = fly(tuple(start_m), tuple(velocity), GRAVITY_MPS2, 0.0, flight_s)
        assert np.linalg.norm(np.array(at) - target) < 1e-9
