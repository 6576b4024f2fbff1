"""The window's hands on a scenario, driven by the events that a user would cause."""

import numpy as np
import pytest
from PIL import Image

from behaviours.components import Flight, Posture, Reaction, Threat
from demos.filming import CAMERAS
from demos.play import Play, play_of
from demos.running import open_scenario
from demos.window.throwing import throw_speed_mps, thrown, under_cursor, velocity_to
from engine.body.skeleton import Pose
from engine.clips.synthetic import sway
from engine.clips.write_bvh import bvh_text
from engine.core.clock import TICK_RATE_HZ
from engine.core.journal_file import load_journal
from engine.maths.ballistics import GRAVITY_MPS2, fly
from engine.render.camera import orbit_camera, project
from engine.render.events import CTRL, LEFT_BUTTON, Drop, Key, MouseButton, MouseMove

SIZE_PX = (640, 480)
FRAME_S = 1.0 / 60.0
PICTURE = np.zeros((8, 8, 3), np.uint8)


@pytest.fixture
def play(tmp_path) -> Play:
    play = play_of(*open_scenario("sway", ("threat=[]",)), tmp_path, lambda: 0.0)
    play.session.slow_motion.enabled = False
    return play


def camera_of(play):
    return orbit_camera(play.session.centre_m(), *CAMERAS["front"])


def do(play, *events, frames=1):
    play.handle(list(events), camera_of(play), SIZE_PX)
    for _ in range(frames):
        play.advance(FRAME_S)
        play.keep(lambda: PICTURE, FRAME_S)


def tap(name, modifiers=0):
    return (Key(name, "press", modifiers), Key(name, "release", modifiers))


def test_real_time_passes_in_ticks(play):
    do(play, frames=60)
    assert play.session.tick == 120


def test_space_holds_and_goes_on(play):
    do(play, *tap("space"), frames=10)
    assert play.session.tick == 0
    do(play, *tap("space"), frames=10)
    assert play.session.tick == 20


def test_steps_forth_and_back_are_exact(play):
    do(play, frames=30)
    before = play.session.world.digest()
    tick = play.session.tick
    do(play, *tap("."))
    assert play.session.tick == tick + 1
    do(play, *tap("left"))
    assert (play.session.tick, play.session.world.digest()) == (tick, before)


def test_speed_changes_by_steps_and_stops_at_its_ends(play):
    for _ in range(9):
        do(play, *tap("-"), frames=0)
    assert play.session.clock.rate == 0.05
    for _ in range(9):
        do(play, *tap("="), frames=0)
    assert play.session.clock.rate == 2.0


def test_backspace_begins_again_and_end_returns(play):
    start_digest = play.session.world.digest()
    do(play, frames=30)
    do(play, *tap("backspace"), frames=0)
    assert (play.session.tick, play.session.world.digest()) == (0, start_digest)
    do(play, *tap("end"), frames=0)
    assert play.session.tick == 60


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
    world = play.session.world
    (ball,) = world.rows(Flight, Threat)
    assert np.linalg.norm(world[Flight].velocity_mps[ball]) == pytest.approx(throw_speed_mps(0.2), rel=0.1)
    do(play, frames=90)
    kinds = [event.kind for event in play.session.world.events]
    assert "perceived" in kinds
    assert "contact" in kinds
    assert play.session.world[Reaction].struck[0]


def test_a_throw_can_be_taken_back(play):
    do(play, frames=30)
    do(play, MouseMove(320, 200, 0, 0), *tap("f"), frames=30)
    do(play, *tap("backspace"), frames=0)
    assert len(play.session.world.rows(Flight)) == 0


def test_a_throw_after_going_back_begins_another_future(play):
    do(play, frames=60)
    do(play, *tap("t"), frames=30)
    assert play.session.run.last_tick == 180
    play.session.seek(60)
    do(play, MouseMove(320, 200, 0, 0), *tap("f"), frames=1)
    assert [command["do"] for commands in play.session.run.inputs.values() for command in commands] == ["throw"]
    assert play.session.run.last_tick == 62


def test_files_are_kept_as_asked(play, tmp_path):
    do(play, MouseMove(320, 200, 0, 0), *tap("f"), frames=10)
    do(play, *tap("r", CTRL), *tap("r", CTRL), *tap("p"), *tap("s", CTRL))
    journal = load_journal(tmp_path / "recording-1.brace")
    assert [command["do"] for commands in journal.inputs.values() for command in commands] == ["throw"]
    assert {path.name for path in tmp_path.iterdir()} == {
        "recording-1.brace", "recording-2.brace", "screenshot-1.png", "scenario-1.toml",
    }  # fmt: skip
    said = "\n".join(line.text for line in play.session.toasts.lines)
    assert str(tmp_path / "screenshot-1.png") in said
    with Image.open(tmp_path / "screenshot-1.png") as picture:
        assert picture.size == (8, 8)


def test_where_nothing_can_be_written_one_line_says_so(play, tmp_path):
    play.session.save_in = tmp_path / "nowhere"
    do(play, *tap("p"), *tap("r", CTRL), *tap("s", CTRL), frames=2)
    lines = play.session.toasts.lines
    assert len(lines) == 3
    assert all(line.alarm and "nowhere" in line.text and "\n" not in line.text for line in lines)


def test_a_dropped_file_that_cannot_be_played_changes_nothing(play, tmp_path):
    do(play, frames=30)
    before = play.session.world.digest()
    bad = tmp_path / "bad.bvh"
    bad.write_text("HIERARCHY\nROOT", encoding="utf-8")
    do(play, Drop((str(bad),)), frames=0)
    assert play.session.world.digest() == before
    assert play.session.character.clip == "sway"
    (line,) = play.session.toasts.lines
    assert line.alarm
    assert "bad.bvh" in line.text


def test_a_dropped_file_is_played(play, tmp_path):
    clip = sway()
    some = Pose(clip.pose.root_m[:90], clip.pose.rotations[:90])
    file = tmp_path / "mine.bvh"
    file.write_text(bvh_text(clip.body, some, clip.fps), encoding="utf-8")
    do(play, Drop((str(file),)), frames=0)
    do(play, frames=30)
    assert play.session.character.clip == str(file)
    assert play.session.dropped == [str(file)]
    assert play.session.tick == 60


def test_a_double_click_selects(play):
    play.session.selected = 0
    camera = camera_of(play)
    (cursor,), _ = project(camera, play.scene().figures[0].positions[2], SIZE_PX)
    do(play, MouseButton(LEFT_BUTTON, True, *cursor, 0, 2), frames=0)
    assert play.session.selected == 0


def test_what_is_under_the_cursor(play):
    camera = camera_of(play)
    chest_m = play.scene().figures[0].positions[2]
    eye = np.array(camera.eye)
    ray = (chest_m - eye) / np.linalg.norm(chest_m - eye)
    row, met = under_cursor(play.session.world, eye, ray)
    assert row == 0
    assert np.linalg.norm(met - chest_m) < 0.25
    assert np.linalg.norm(met - eye) < np.linalg.norm(chest_m - eye)  # the near side
    row, beside = under_cursor(play.session.world, eye, -np.cross(ray, (0.0, 0.0, 1.0)))
    assert row == 0
    assert np.all(np.isfinite(beside))


@pytest.mark.parametrize("going_mps", [(0.0, 0.0), (1.4, 0.0), (-0.5, 3.0)])
def test_a_throw_meets_who_goes_on(play, going_mps):
    """In the straight time of flight to where it is aimed, the ball is where the cursor's point has gone to."""
    world, camera = play.session.world, camera_of(play)
    posture, drift_m = world[Posture], np.array([*going_mps, 0.0]) / TICK_RATE_HZ
    posture.before_root_m[0] = posture.root_m[0] - drift_m - (0.0, 0.0, 0.01)  # who hops is not aimed above
    eye, chest_m = np.array(camera.eye), play.scene().figures[0].positions[2]
    ray = (chest_m - eye) / np.linalg.norm(chest_m - eye)
    _, met = under_cursor(world, eye, ray)
    command = thrown(world, eye, ray, 20.0)
    start_m = np.array(command["position_m"])
    goes_s = np.linalg.norm(met - start_m) / 20.0
    aimed_m = met + goes_s * TICK_RATE_HZ * drift_m
    arrives_s = np.linalg.norm(aimed_m - start_m) / 20.0
    at, _ = fly(tuple(start_m), tuple(command["velocity_mps"]), GRAVITY_MPS2, 0.0, arrives_s)
    assert np.linalg.norm(np.array(at) - aimed_m) < 1e-9


def test_a_walker_is_hit_from_the_side(tmp_path, library_clip):
    """While the ball flies it goes on by more than its own width."""
    library_clip("walk")
    play = play_of(*open_scenario("volleyball", ("threat=[]", "character.0.protects=false")), tmp_path, lambda: 0.0)
    do(play, frames=30)
    camera = orbit_camera(play.session.centre_m(), *CAMERAS["left"])
    (cursor,), _ = project(camera, play.scene().figures[0].positions[2], SIZE_PX)
    play.handle([MouseMove(*cursor, 0, 0), *tap("f")], camera, SIZE_PX)
    do(play, frames=60)
    assert "contact" in [event.kind for event in play.session.world.events]


def test_a_throw_arrives_where_it_was_aimed():
    start_m, target = np.array([4.0, 1.0, 1.6]), np.array([0.0, 0.0, 1.7])
    for speed in (12.0, 30.0):
        velocity = velocity_to(start_m, target, speed)
        flight_s = np.linalg.norm(target - start_m) / speed
        at, _ = fly(tuple(start_m), tuple(velocity), GRAVITY_MPS2, 0.0, flight_s)
        assert np.linalg.norm(np.array(at) - target) < 1e-9
