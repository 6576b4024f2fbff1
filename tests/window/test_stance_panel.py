"""The Stance panel, used by a hand without a window; its dots, dragged with a cursor that looks into the scene."""

from __future__ import annotations

import math
import tomllib

import numpy as np
import pytest

from behaviours.components import Posture
from behaviours.scenario import check_scenario
from behaviours.stance.shape import ALLOWED, RANGES
from behaviours.stance.shape_sets import SETS
from behaviours.stance.solve import solve_stance
from demos.window.session import Session
from demos.window.stance_desk import POINTS, StanceDesk, in_groups
from demos.window.stance_panel import FIRST, StancePanel
from engine.body.anthropometry import standard_body
from engine.body.skeleton import WRISTS
from engine.render.camera import orbit_camera, project
from engine.render.events import LEFT_BUTTON, MouseButton, MouseMove
from engine.render.scene import Scene
from tests.window.hand import HandUi

SIZE_PX = (900, 700)


@pytest.fixture
def session(tmp_path) -> Session:
    made = Session(check_scenario({"character": [{"clip": "sway"}]}), tmp_path, tmp_path, lambda: 0.0)
    made.camera, made.size_px = orbit_camera((0.0, 1.0, 1.0), 35.0, 12.0, 5.0), SIZE_PX
    return made


@pytest.fixture
def panel(session) -> StancePanel:
    return opened(session)


def opened(session) -> StancePanel:
    """A panel that has said that it gets ready."""
    panel = StancePanel()
    assert use(panel, session).said == [FIRST]
    return panel


def use(panel, session, **wanted) -> HandUi:
    ui = HandUi(**wanted)
    panel.draw(ui, session)
    return ui


def test_nothing_is_solved_before_it_is_seen_why_that_takes_long(session, monkeypatch):
    monkeypatch.setattr(StanceDesk, "solve", lambda *_: pytest.fail("solved"))
    panel, scene = StancePanel(), Scene()
    panel.drawn_into(scene, session)
    assert not scene.figures
    assert use(panel, session).said == [FIRST]


def test_every_number_stands_in_one_group_and_every_state_on_the_panel(panel, session):
    grouped = [name for names in in_groups().values() for name in names]
    assert sorted(grouped) == sorted(RANGES)
    ui = use(panel, session)
    assert len(ui.seen) >= len(RANGES) + len(ALLOWED) + 2


@pytest.mark.parametrize("name", SETS)
def test_set_intensity_and_object_make_the_stance_of_the_command(panel, session, name):
    use(panel, session, Set=name)
    use(panel, session, How_much=0.7)
    points = {point: tuple(panel.desk.points_m[point]) for point in POINTS if panel.desk.used[point]}
    result = panel.desk.solve(session.body)
    assert np.array_equal(
        result.pose.rotations, solve_stance(session.body, name, 0.7, **points).pose.rotations
    )  # fmt: skip
    assert bool(points) == (SETS[name].needs_object or name.startswith("reach"))


def test_a_slider_below_fine_tunes_and_a_choice_above_starts_anew(panel, session):
    use(panel, session, Set="slovenly")
    use(panel, session, Knee_left=60.0, Coronal_class="LargeC")
    made = panel.desk.shape(session.body)
    assert made.numbers.knee_left_rad == pytest.approx(math.radians(60.0))
    assert made.states.coronal_class == "LargeC"
    assert made.states.sagittal_class == "SmallC"  # of the set
    use(panel, session, How_much=0.2)
    assert panel.desk.tuned is None
    assert panel.desk.shape(session.body).numbers.knee_left_rad < 0.1


def test_numbers_stay_in_their_ranges(panel, session):
    panel.desk.tune(session.body, "width_m", 9.0)
    assert panel.desk.shape(session.body).numbers.width_m == RANGES["width_m"].high


def test_a_shape_is_saved_loaded_and_shown_by_the_command(panel, session, tmp_path, capsys):
    from demos.cli import main

    use(panel, session, Set="recoil-strong")
    use(panel, session, Gaze=0.3)
    use(panel, session, Save_shape=True)
    path = tmp_path / "stance-1.toml"
    assert tomllib.loads(path.read_text())["numbers"]["gaze"] == 0.3
    other = opened(session)
    use(other, session, Shape_file="stance-1.toml")
    use(other, session, Load_shape=True)
    poses = [p.desk.solve(session.body).pose.rotations for p in (panel, other)]
    assert np.array_equal(*poses)
    assert main(["stance", str(path), "--json"]) == 0
    assert '"gaze": 0.3' in capsys.readouterr().out


def test_a_file_that_is_none_is_said_and_changes_nothing(panel, session, tmp_path):
    (tmp_path / "bad.toml").write_text("version = 1\n[numbers]\nsagital = 1\n")
    before = panel.desk.shape(session.body)
    use(panel, session, Shape_file="bad.toml")
    use(panel, session, Load_shape=True)
    assert panel.desk.shape(session.body) == before
    assert any("sagital" in line for line in said(session))


def said(session) -> list[str]:
    return [str(line) for line in session.toasts.lines]


@pytest.mark.parametrize("tuned", [False, True])
def test_what_is_worn_is_what_is_shown(panel, session, tuned):
    plain = session.world[Posture].rotations[0].copy()
    use(panel, session, Set="posture", How_much=-0.9)
    if tuned:
        use(panel, session, Collar_z=-5.0)
    use(panel, session, Wear_it=True)
    stance = session.scenario.character[0].stance
    assert (stance.shape is not None) == tuned
    session.advance(0.0)
    worn = session.world[Posture].rotations[0]
    assert np.abs(worn - plain).max() > 0.05


def pixel_of(panel, session, name):
    (xy,), _ = project(session.camera, panel.world_of(panel.desk.points_m[name])[None], SIZE_PX)
    return tuple(float(c) for c in xy)


def press(panel, session, pressed, xy):
    session.cursor_px = (0.0, 0.0)  # the cursor has gone on since
    return panel.handle(MouseButton(LEFT_BUTTON, pressed, *xy), session)


def test_the_object_is_dragged_in_the_picture(panel, session):
    """Where the cursor lets go, the dot is: projected, it lies under it, as deep in the picture as before."""
    use(panel, session, Set="recoil-mild")
    start = panel.world_of(panel.desk.points_m["object_m"])
    at = pixel_of(panel, session, "object_m")
    assert press(panel, session, True, at)
    there = (at[0] - 60.0, at[1] - 25.0)
    assert panel.handle(MouseMove(*there, -60.0, -25.0), session)
    assert press(panel, session, False, there)
    assert pixel_of(panel, session, "object_m") == pytest.approx((at[0] - 60.0, at[1] - 25.0), abs=1.0)
    _, _, forward = session.camera.axes()
    assert (panel.world_of(panel.desk.points_m["object_m"]) - start) @ forward == pytest.approx(0.0, abs=1e-6)
    assert not panel.handle(MouseMove(0.0, 0.0, 1.0, 1.0), session)


def test_beside_the_dot_the_mouse_is_the_camera_s(panel, session):
    use(panel, session, Set="recoil-mild")
    x, y = pixel_of(panel, session, "object_m")
    assert not press(panel, session, True, (x + 200.0, y))
    assert not panel.handle(MouseMove(x, y, 1.0, 0.0), session)


def test_the_figure_stands_beside_the_character_with_its_balance(panel, session):
    use(panel, session, Set="reach")
    scene = Scene()
    panel.drawn_into(scene, session)
    (figure,), (balance,) = scene.figures, scene.balances
    away = figure.positions[0, :2] - session.joints_m(session.row)[0, :2]
    assert 1.0 < np.linalg.norm(away) < 1.6
    assert np.linalg.norm(balance.com_m[:2] - balance.wanted_m) < 2e-3
    dot = next(point for point in scene.draw.points if point.layer == "stance")
    assert np.linalg.norm(figure.positions[WRISTS[1]] - dot.position_m) < 1e-3


def test_a_world_point_comes_back_from_its_own_frame(panel, session):
    use(panel, session)
    point = np.array((0.3, -0.7, 1.1))
    assert panel.world_of(panel.frame_of(point)) == pytest.approx(point, abs=1e-12)


def test_what_is_remembered_is_taken_up_and_nonsense_is_not(panel):
    panel.desk.choose_set("interest")
    panel.desk.change_intensity(0.4)
    other = StancePanel()
    other.remember(panel.memory())
    assert (other.desk.set_name, other.desk.intensity) == ("interest", 0.4)
    other.remember({"set": "no such", "intensity": "much", "file": 3})
    assert (other.desk.set_name, other.desk.intensity) == ("interest", 0.4)


def test_a_stance_is_solved_only_where_something_changed():
    desk, body = StanceDesk(), standard_body()
    first = desk.solve(body)
    assert desk.solve(body) is first
    desk.use("object_m", True)
    desk.choose_set("interest")
    second = desk.solve(body)
    assert second is not first
    desk.move("object_m", (0.5, -0.5, 1.0))
    assert desk.solve(body) is not second
