"""The renderer against what light, geometry and blending must do, whatever the pictures look like."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from engine.body.anthropometry import standard_body
from engine.core.debug_draw import DebugDraw
from engine.core.errors import EXIT_ENVIRONMENT, EnvironmentTrouble
from engine.maths import quaternion
from engine.render import shader_source
from engine.render.camera import orbit_camera, project
from engine.render.context import check_gl
from engine.render.frame import TO_LIGHT, fit_shadow
from engine.render.passes.figures import dual_quaternions
from engine.render.scene import CLIP_BLUE, Ball, FloorStyle, Scene, extent_points
from engine.render.shader_source import make_program
from tests.render.people import PROTECT, STAND, person

SIZE = (320, 240)
BARE = FloorStyle(shown=False)
VIEW = orbit_camera((0.0, 0.0, 0.9), 30.0, 15.0, 4.0)


def _draw(renderer, scene, camera=VIEW, size_px=SIZE) -> np.ndarray:
    renderer.draw(scene, camera, size_px)
    return renderer.read_rgb().astype(float)


def _middle_of(changed: np.ndarray) -> np.ndarray:
    """Weighted mean pixel (x, y) of a difference picture."""
    weight = np.abs(changed).sum(axis=2)
    y, x = np.mgrid[: weight.shape[0], : weight.shape[1]] + 0.5
    return np.array([(x * weight).sum(), (y * weight).sum()]) / weight.sum()


@pytest.mark.parametrize("place", [(0.0, 0.0, 0.9), (0.8, -0.9, 1.6), (-1.0, 1.2, 0.3)])
def test_things_appear_where_the_camera_says(renderer, place):
    with_ball = _draw(renderer, Scene(balls=[Ball(place, 0.06)], floor=BARE))
    where = _middle_of(with_ball - _draw(renderer, Scene(floor=BARE)))
    assert where == pytest.approx(project(VIEW, [place], SIZE)[0][0], abs=1.0)


def test_nearer_things_hide_farther_ones_in_any_order(renderer):
    near, far = Ball((0.5, 0.3, 1.0), 0.1), Ball((-0.5, -0.28, 0.85), 0.1, kind="custom")
    both = _draw(renderer, Scene(balls=[near, far], floor=BARE))
    assert (both == _draw(renderer, Scene(balls=[far, near], floor=BARE))).all()


def test_shadows_fall_away_from_the_light(renderer):
    ball, camera = Ball((0.0, 0.0, 0.8), 0.1), orbit_camera((0.0, 0.0, 0.2), 30.0, 60.0, 5.0)
    lit = _draw(renderer, Scene(balls=[Ball((0.0, 0.0, 0.8), 0.1, alpha=0.999)]), camera)  # ghosts cast no shadow
    darker = np.maximum(lit - _draw(renderer, Scene(balls=[ball]), camera), 0.0)
    darker[darker.max(axis=2) < 25] = 0.0  # the ball's own shading is no shadow on the floor
    on_floor = np.array([0.0, 0.0, 0.8]) - TO_LIGHT * 0.8 / TO_LIGHT[2]
    assert _middle_of(darker) == pytest.approx(project(camera, [on_floor], SIZE)[0][0], abs=3.0)


def test_nothing_shades_itself_where_the_light_shines_straight_at_it(renderer):
    """Shadow acne would show as speckles: neighbouring pixels of a large lit ball must stay alike."""
    camera = orbit_camera((0.0, 0.0, 1.0), np.degrees(np.arctan2(TO_LIGHT[1], TO_LIGHT[0])), 50.0, 4.0)
    cap_to_light = quaternion.between((0.0, 0.0, 1.0), tuple(TO_LIGHT))
    picture = _draw(renderer, Scene(balls=[Ball((0.0, 0.0, 1.0), 0.6, cap_to_light, "custom")], floor=BARE), camera)
    lit = picture[100:140, 140:180, 1]
    assert lit.min() > 150
    assert np.abs(np.diff(lit, n=2, axis=1)).max() < 6
    assert np.abs(np.diff(lit, n=2, axis=0)).max() < 6


def test_a_spinning_ball_changes_only_inside_its_outline(renderer):
    centre, radius_m = np.array([0.0, 0.0, 0.9]), 0.3
    still = _draw(renderer, Scene(balls=[Ball(centre, radius_m)], floor=BARE))
    spun = _draw(renderer, Scene(balls=[Ball(centre, radius_m, quaternion.about_z(0.5))], floor=BARE))
    middle, rim = project(VIEW, [centre, centre + radius_m * VIEW.axes()[0]], SIZE)[0]
    y, x = np.mgrid[: SIZE[1], : SIZE[0]] + 0.5
    away = np.hypot(x - middle[0], y - middle[1]) / np.linalg.norm(rim - middle)
    changed = np.abs(spun - still).max(axis=2) > 20
    assert not changed[away > 1.05].any()
    assert 0.2 < changed[away < 0.95].mean() < 0.9


def test_a_ghost_is_one_layer_however_many_bones_lie_behind_each_other(renderer):
    """Twice the alpha must bring twice the colour. Were inner parts blended too, it would bring less than twice."""
    base = _draw(renderer, Scene(floor=BARE))
    thin, thick = (
        _draw(renderer, Scene(figures=[person(PROTECT, CLIP_BLUE, alpha)], floor=BARE)) - base for alpha in (0.16, 0.32)
    )
    inside = np.abs(thick).max(axis=2) > 25
    assert inside.sum() > 1000
    assert (2.0 * thin - thick)[inside] == pytest.approx(0.0, abs=3.0)


def test_ghosts_that_stand_in_each_other_both_stay_whole(renderer):
    base = _draw(renderer, Scene(floor=BARE))
    one = person(STAND, CLIP_BLUE, 0.3)
    other = person(PROTECT, (0.9, 0.5, 0.1), 0.3)
    alone = _draw(renderer, Scene(figures=[other], floor=BARE))
    both = _draw(renderer, Scene(figures=[one, other], floor=BARE))
    behind = _draw(renderer, Scene(figures=[one], floor=BARE))
    where_other = np.abs(alone - base).max(axis=2) > 8
    where_one = np.abs(behind - base).max(axis=2) > 8
    assert (where_one & where_other).sum() > 1000
    for seen, reference in ((where_one & where_other, behind), (where_one & where_other, alone)):
        assert (np.abs(both - reference).max(axis=2)[seen] > 3).mean() > 0.97


def test_ghosts_neither_cast_shadows_nor_hide_behind_nothing(renderer):
    ghost = person(STAND, CLIP_BLUE, 0.4)
    assert fit_shadow(Scene(figures=[ghost])) is None
    solid = person(STAND, at=(0.7, 0.4))  # between the camera and the ghost
    with_ghost = _draw(renderer, Scene(figures=[solid, ghost], floor=BARE))
    without = _draw(renderer, Scene(figures=[solid], floor=BARE))
    covered = np.abs(without - _draw(renderer, Scene(floor=BARE))).max(axis=2) > 40
    assert np.abs(with_ghost - without).max(axis=2)[covered].mean() < 1.0


def test_marks_are_seen_faintly_through_bodies_and_plainly_before_them(renderer):
    plain, draw = _draw(renderer, Scene(figures=[person(STAND)])), DebugDraw()
    draw.point((0.0, 0.0, 1.2), 0.05, (1.0, 0.0, 0.0))
    hidden = np.abs(_draw(renderer, Scene(figures=[person(STAND)], draw=draw)) - plain).max()
    draw.clear()
    draw.point((0.4, 0.23, 1.2), 0.05, (1.0, 0.0, 0.0))
    open_ = np.abs(_draw(renderer, Scene(figures=[person(STAND)], draw=draw)) - plain).max()
    assert 10 < hidden < 0.5 * open_


def test_the_shadow_map_holds_every_caster_at_a_steady_scale():
    scene = Scene(figures=[person(PROTECT)], balls=[Ball((1.0, 0.3, 1.5))])
    shadow = fit_shadow(scene)
    points = np.column_stack([extent_points(scene), np.ones(len(extent_points(scene)))])
    seen = points @ shadow.from_world.T
    assert seen[:, :3].min() > 0.0
    assert seen[:, :3].max() < 1.0
    moved = fit_shadow(Scene(figures=[person(PROTECT, at=(0.013, 0.021))], balls=[Ball((1.013, 0.321, 1.5))]))
    assert moved.texel_m == shadow.texel_m
    steps = (moved.from_world[:2, 3] - shadow.from_world[:2, 3]) * shadow.size_px
    assert steps == pytest.approx(np.round(steps), abs=1e-6)  # whole texels: edges do not crawl


def test_dual_quaternions_hold_turn_and_shift():
    figure = person(PROTECT)
    real, dual = np.moveaxis(dual_quaternions(figure.positions, figure.orientations).astype(float), 1, 0)
    assert np.sum(real * dual, axis=1) == pytest.approx(0.0, abs=1e-6)  # what makes a dual quaternion a unit one
    for joint in range(21):
        undone = quaternion.conjugate(tuple(real[joint]))
        shift = 2.0 * np.array(quaternion.multiply(tuple(dual[joint]), undone))
        assert shift[1:] == pytest.approx(figure.positions[joint], abs=1e-6)


def test_bodies_are_uploaded_once_and_shared(renderer):
    body, other = standard_body(1.81), standard_body(1.66)
    before = len(renderer.figures.meshes)
    crowd = [person(STAND, body=body, at=(0.0, 0.6 * k)) for k in range(5)]
    _draw(renderer, Scene(figures=crowd))
    _draw(renderer, Scene(figures=[*crowd, person(PROTECT, body=other, at=(1.0, 0.0))]))
    assert len(renderer.figures.meshes) == before + 2


def test_hundreds_of_marks_and_balls_outgrow_the_first_buffers(renderer):
    places = np.random.default_rng(5).uniform((-1, -1, 0.2), (1, 1, 1.8), (700, 3))
    draw = DebugDraw()
    for place in places:
        draw.line(place, place + (0, 0, 0.1), CLIP_BLUE)
        draw.polygon(place + np.array([(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0)]), CLIP_BLUE)
    many = _draw(renderer, Scene(balls=[Ball(place, 0.03) for place in places], draw=draw))
    last = _draw(renderer, Scene(balls=[Ball(place, 0.03) for place in places[:-1]], draw=draw))
    assert np.abs(many - last).max() > 10


@pytest.mark.parametrize("size_px", [(1, 1), (17, 9), (641, 359), (64, 500)])
def test_any_size_works(renderer, size_px):
    assert _draw(renderer, Scene(figures=[person(STAND)]), size_px=size_px).shape == (size_px[1], size_px[0], 3)


def test_a_window_without_area_draws_nothing_and_keeps_the_last_picture(renderer):
    before = _draw(renderer, Scene(figures=[person(STAND)]))
    for size_px in ((0, 0), (0, 200), (200, 0)):
        renderer.draw(Scene(), VIEW, size_px)
        renderer.present()
    assert (renderer.read_rgb() == before).all()


def test_words_that_the_font_lacks_do_not_stop_the_picture(renderer):
    draw = DebugDraw()
    draw.label((0.0, 0.0, 1.0), "Δv → 3 µm · 漢", CLIP_BLUE)
    draw.label((9.0, 9.0, 3.0), "behind the camera", CLIP_BLUE)
    assert np.ptp(_draw(renderer, Scene(draw=draw, captions=[("top-left", "")]))) > 100


def test_the_same_scene_gives_the_same_picture(renderer):
    scene = Scene(figures=[person(PROTECT)], balls=[Ball((0.4, 0.4, 1.5))])
    first = _draw(renderer, scene)
    _draw(renderer, Scene(), size_px=(64, 64))
    assert (_draw(renderer, scene) == first).all()


def test_a_gl_error_ends_with_a_line_and_not_with_silence():
    broken = SimpleNamespace(error="GL_OUT_OF_MEMORY", info={"GL_RENDERER": "a card"})
    with pytest.raises(EnvironmentTrouble, match="GL_OUT_OF_MEMORY while drawing with a card") as trouble:
        check_gl(broken, "drawing")
    assert trouble.value.exit_code == EXIT_ENVIRONMENT
    assert "\n" not in trouble.value.line()


@pytest.mark.parametrize(
    ("where", "expected"),
    [("floor.frag", "shaders/floor.frag:3"), ("include/tone.glsl", "shaders/include/tone.glsl:3")],
)
def test_a_shader_error_names_file_and_line(renderer, monkeypatch, where, expected):
    read = shader_source._read

    def broken(name: str) -> str:
        lines = read(name).splitlines()
        return "\n".join([*lines[:2], "no such thing;", *lines[3:]]) if name == where else read(name)

    monkeypatch.setattr(shader_source, "_read", broken)
    with pytest.raises(EnvironmentTrouble, match=expected):
        make_program(renderer.gl, "floor")
