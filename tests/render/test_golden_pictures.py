"""One picture for each visible thing. The scenes are all there is to read; golden.py does the rest."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.anthropometry import standard_body
from engine.body.kinematics import com_of
from engine.body.skeleton import LEFT_WRIST
from engine.body.support import polygon_of
from engine.core.debug_draw import DebugDraw
from engine.maths import quaternion
from engine.render.camera import frame_all, orbit_camera
from engine.render.scene import (
    BLEND_GREY,
    CLIP_BLUE,
    RULES_YELLOW,
    SIMULATED_RED,
    SUSTAINED_ORANGE,
    Balance,
    Ball,
    FloorStyle,
    Scene,
    extent_points,
)
from tests.render.golden import SIZE_PX, TOLERANCE, golden, tile_differences
from tests.render.people import BEHIND_HEAD, PROTECT, SQUAT, STAND, WALK, person, pose_of

GYM = FloorStyle("gym")


def _framed(scene: Scene, azimuth_deg: float, elevation_deg: float = 8.0):
    camera = orbit_camera((0.0, 0.0, 0.9), azimuth_deg, elevation_deg, 4.0)
    return scene, frame_all(camera, extent_points(scene), SIZE_PX)


@golden()
def test_mannequin_front():
    return _framed(Scene(figures=[person(STAND)]), 0.0)


@golden()
def test_mannequin_side():
    return _framed(Scene(figures=[person(STAND)]), 90.0)


@golden()
def test_mannequin_back():
    return _framed(Scene(figures=[person(WALK)]), 200.0)


@golden()
def test_mannequin_protecting():
    return _framed(Scene(figures=[person(PROTECT)]), 40.0)


@golden()
def test_mannequin_behind_head():
    return _framed(Scene(figures=[person(BEHIND_HEAD)]), 20.0)


@golden()
def test_mannequin_squatting():
    return _framed(Scene(figures=[person(SQUAT)]), 50.0)


@golden()
def test_mannequin_jointed():
    return _framed(Scene(figures=[person(PROTECT, style="jointed")]), 40.0)


@golden()
def test_hand():
    figure = person(PROTECT)
    x, y, z = figure.positions[LEFT_WRIST]
    return Scene(figures=[figure]), orbit_camera((x, y, z + 0.05), 60.0, 5.0, 0.9)


@golden()
def test_feet():
    return Scene(figures=[person(WALK)]), orbit_camera((0.0, 0.0, 0.15), 70.0, 20.0, 1.7)


@golden()
def test_gym():
    figures = [person(PROTECT), person(WALK, CLIP_BLUE, at=(-0.5, 1.2))]
    return Scene(figures, [Ball((0.7, 0.5, 1.7))], floor=GYM), orbit_camera((0.0, 0.4, 0.95), 55.0, 9.0, 4.6)


@golden()
def test_gym_from_behind():
    return Scene(figures=[person(STAND)], floor=GYM), orbit_camera((0.0, 0.0, 2.0), 150.0, 3.0, 9.0)


@golden()
def test_court_from_above():
    return Scene(floor=GYM), orbit_camera((-6.0, 0.0, 0.0), 30.0, 35.0, 24.0)


@golden()
def test_net():
    return Scene(floor=GYM), orbit_camera((-6.0, 3.8, 2.0), 20.0, 6.0, 5.0)


@golden()
def test_face():
    return Scene(figures=[person(STAND)]), orbit_camera((0.0, 0.0, 1.6), 35.0, 4.0, 0.9)


@golden()
def test_small_woman():
    return _framed(
        Scene(figures=[person(STAND, body=standard_body(1.55, "female")), person(STAND, at=(0.0, 0.8))]), 10.0
    )


@golden()
def test_thesis_colours():
    colours = (CLIP_BLUE, RULES_YELLOW, SUSTAINED_ORANGE, SIMULATED_RED, BLEND_GREY)
    return _framed(
        Scene(figures=[person(PROTECT, c, at=(0.0, 1.4 - 0.7 * k)) for k, c in enumerate(colours)]), 15.0, 12.0
    )


@golden()
def test_ghosts():
    ghosts = [person(WALK, CLIP_BLUE, 0.35), person(PROTECT, RULES_YELLOW, 0.35, at=(0.1, 0.0))]
    return _framed(Scene(figures=[person(PROTECT, SUSTAINED_ORANGE, at=(0.0, 0.5)), *ghosts]), 40.0)


@golden()
def test_volleyball():
    turned = quaternion.from_rotation_vector((0.4, 0.9, 0.2))
    return _framed(Scene(balls=[Ball((0.0, 0.0, 0.3), orientation=turned)]), 30.0, 20.0)


@golden()
def test_other_balls():
    balls = [Ball((0.0, 0.2, 0.2), 0.15, kind="custom"), Ball((0.0, -0.2, 0.25), alpha=0.5)]
    return _framed(Scene(balls=balls), 30.0, 20.0)


@golden()
def test_shadow():
    return _framed(Scene(figures=[person(WALK)], balls=[Ball((0.5, 0.6, 0.5))]), 60.0, 50.0)


@golden()
def test_floor():
    return Scene(), orbit_camera((0.0, 0.0, 0.5), 30.0, 12.0, 5.0)


@golden()
def test_no_floor():
    return _framed(Scene(figures=[person(STAND)], floor=FloorStyle(shown=False)), 30.0)


@golden()
def test_balance():
    figure = person(PROTECT)
    com = com_of(figure.body, pose_of(figure.body, PROTECT))
    support = polygon_of(figure.body, figure.positions, figure.orientations, np.array([True, True]))
    scene = Scene(figures=[figure], balances=[Balance(support, com + (0.03, -0.03, 0.0), com[:2] + (-0.05, 0.06))])
    return scene, orbit_camera((0.0, 0.0, 0.2), 20.0, 40.0, 2.0)


@golden()
def test_marks_and_words():
    figure, draw = person(STAND), DebugDraw()
    draw.polyline(
        [(1.4 - 1.3 * t, 0.6 - 0.6 * t, 1.4 + 1.2 * t * (1.0 - t) + 0.2 * t) for t in np.linspace(0.0, 1.0, 16)],
        (0.2, 0.3, 0.4),
    )
    draw.arrow((1.4, 0.6, 1.4), (1.0, 0.4, 1.6), CLIP_BLUE)
    draw.arrow((0.2, -0.5, 0.6), (0.2, -0.5, 1.2), SIMULATED_RED)
    draw.point((0.2, 0.0, 1.15), 0.04, SIMULATED_RED)
    draw.polygon([(0.5, -0.4), (0.9, -0.4), (0.9, 0.1), (0.5, 0.1)], SUSTAINED_ORANGE)
    draw.polygon([(0.0, 0.5, 0.3), (0.0, 0.9, 0.3), (0.0, 0.9, 0.7)], CLIP_BLUE, filled=False)
    draw.label((1.4, 0.6, 1.5), "26.0 m/s", CLIP_BLUE)
    scene = Scene(
        figures=[figure], draw=draw, captions=[("top-right", "walk\nt = 1.25 s"), ("bottom-right", "protect 80%")]
    )
    return _framed(scene, 50.0)


PICTURES = {name: function for name, function in globals().items() if hasattr(function, "build")}
WITHOUT = [
    ("test_gym", lambda scene: scene.balls.clear()),
    ("test_gym", lambda scene: scene.figures.pop(1)),
    ("test_gym", lambda scene: setattr(scene, "floor", FloorStyle("plain"))),
    ("test_shadow", lambda scene: scene.balls.clear()),
    ("test_shadow", lambda scene: scene.figures.clear()),
    ("test_ghosts", lambda scene: scene.figures.pop(1)),
    ("test_ghosts", lambda scene: scene.figures.pop(2)),
    ("test_other_balls", lambda scene: scene.balls.pop(1)),
    ("test_balance", lambda scene: scene.balances.clear()),
    ("test_marks_and_words", lambda scene: scene.draw.arrows.pop(1)),
    ("test_marks_and_words", lambda scene: scene.draw.points.clear()),
    ("test_marks_and_words", lambda scene: scene.draw.polygons.pop(0)),
    ("test_marks_and_words", lambda scene: scene.draw.polygons.pop(1)),
    ("test_marks_and_words", lambda scene: scene.draw.labels.clear()),
    ("test_marks_and_words", lambda scene: scene.captions.pop(1)),
    ("test_thesis_colours", lambda scene: scene.figures.pop()),
]


@pytest.mark.parametrize(("name", "remove"), WITHOUT)
def test_one_missing_thing_is_seen(renderer, name, remove):
    """The comparison is only worth something if each thing, left out, fails it."""
    scene, camera = PICTURES[name].build()
    renderer.draw(scene, camera, SIZE_PX)
    whole = renderer.read_rgb()
    remove(scene)
    renderer.draw(scene, camera, SIZE_PX)
    assert tile_differences(whole, renderer.read_rgb()).max() > TOLERANCE


def test_the_marker_of_the_centre_of_mass_is_seen(renderer):
    scene, camera = PICTURES["test_balance"].build()
    renderer.draw(scene, camera, SIZE_PX)
    whole = renderer.read_rgb()
    support, _, wanted, colour = vars(scene.balances[0]).values()
    for partial in (Balance(support, None, wanted, colour), Balance(support, scene.balances[0].com_m, None, colour)):
        renderer.draw(Scene(figures=scene.figures, balances=[partial]), camera, SIZE_PX)
        assert tile_differences(whole, renderer.read_rgb()).max() > TOLERANCE
