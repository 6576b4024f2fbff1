"""Depth and mask against geometry: the same camera, the same figures, other arithmetic."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.skeleton import HEAD, LEFT_KNEE, PELVIS
from engine.render.camera import orbit_camera, project
from engine.render.measures import FIRST_BALL, FIRST_FIGURE, FLOOR, NOTHING
from engine.render.scene import CLIP_BLUE, Ball, FloorStyle, Scene
from tests.render.people import PROTECT, STAND, person

SIZE = (320, 240)
VIEW = orbit_camera((0.0, 0.0, 0.9), 30.0, 15.0, 4.0)


def test_a_balls_pixels_are_as_far_as_its_surface(renderer):
    ball = Ball((0.3, -0.2, 1.1), 0.25)
    depth_m, mask = renderer.measure(Scene(balls=[ball], floor=FloorStyle(shown=False)), VIEW, SIZE)
    (pixel,), (centre_m,) = project(VIEW, [ball.position_m], SIZE)
    assert depth_m[int(pixel[1]), int(pixel[0])] == pytest.approx(centre_m - ball.radius_m, abs=0.01)
    seen = mask == FIRST_BALL
    radius_px = 0.5 * SIZE[1] * ball.radius_m / (centre_m * np.tan(0.5 * VIEW.fov_rad))
    assert seen.sum() == pytest.approx(np.pi * radius_px**2, rel=0.04)
    assert (depth_m[seen] > centre_m - 0.26).all()
    assert (depth_m[seen] < centre_m + 0.05).all()
    assert np.isinf(depth_m[~seen]).all()
    assert (mask[~seen] == NOTHING).all()


def test_floor_depth_is_where_rays_meet_the_floor(renderer):
    depth_m, mask = renderer.measure(Scene(), VIEW, SIZE)
    for place in ((0.0, 0.0, 0.0), (0.8, -0.6, 0.0), (-1.5, 0.7, 0.0)):
        (pixel,), (far_m,) = project(VIEW, [place], SIZE)
        x, y = int(pixel[0]), int(pixel[1])
        assert mask[y, x] == FLOOR
        assert depth_m[y, x] == pytest.approx(far_m, rel=0.02)


def test_figures_are_told_apart_and_ghosts_are_left_out(renderer):
    figures = [person(STAND, at=(0.0, 0.6)), person(STAND, CLIP_BLUE, 0.4), person(PROTECT, at=(0.0, -0.6))]
    depth_m, mask = renderer.measure(Scene(figures, [Ball((0.0, 0.0, 1.9))]), VIEW, SIZE)
    assert set(np.unique(mask)) <= {NOTHING, FLOOR, FIRST_FIGURE, FIRST_FIGURE + 1, FIRST_BALL}
    for who, figure in ((0, figures[0]), (1, figures[2])):
        pixels, far_m = project(VIEW, figure.positions[[PELVIS, HEAD, LEFT_KNEE]], SIZE)
        for (x, y), joint_m in zip(pixels.astype(int), far_m, strict=True):
            assert mask[y, x] == FIRST_FIGURE + who
            assert 0.0 < joint_m - depth_m[y, x] < 0.35  # flesh before the joint


def test_measuring_leaves_pictures_as_they_are(renderer):
    scene = Scene([person(PROTECT)], floor=FloorStyle("gym"))
    renderer.draw(scene, VIEW, SIZE)
    before = renderer.read_rgb()
    renderer.measure(scene, VIEW, SIZE)
    assert (renderer.read_rgb() == before).all()
    renderer.draw(scene, VIEW, SIZE)
    assert (renderer.read_rgb() == before).all()
