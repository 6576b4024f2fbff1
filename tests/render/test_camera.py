"""The camera against geometry: what is asked to be seen is seen, what is dragged stays under the cursor."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.render.camera import (
    Camera,
    clip_from_world,
    follow,
    frame_all,
    orbit,
    orbit_camera,
    pan,
    project,
    ray_through,
    zoom,
)

SIZES = st.tuples(st.integers(64, 2000), st.integers(64, 2000))
ANGLES = st.tuples(st.integers(-180, 180), st.integers(-80, 80))
MILLIMETRES = st.integers(-4000, 4000).map(lambda mm: mm / 1000)
POINTS = st.lists(st.tuples(*[MILLIMETRES] * 3), min_size=1, max_size=12)


@given(ANGLES, SIZES, POINTS, st.floats(0.0, 0.3))
def test_framing_holds_every_point_inside_the_margin_and_wastes_nothing(angles, size_px, points, margin):
    points = [*points, (0.0, 0.0, 0.5), (0.3, -0.2, 0.9), (0.1, 0.4, 1.3)]
    camera = frame_all(orbit_camera((0, 0, 1), *angles, 3.0), points, size_px, margin)
    pixels, depth = project(camera, points, size_px)
    share = pixels / size_px
    assert depth.min() > 0.29
    assert share.min() > margin - 1e-6
    assert share.max() < 1.0 - margin + 1e-6
    # one of the two spans fills what the margin leaves, unless the nearest point stopped the camera
    if depth.min() > 0.31:
        assert max(np.ptp(share, axis=0)) > 0.8 * (1.0 - 2.0 * margin)
    # and the picture is balanced: as much free on the left as on the right, above as below
    assert share.min(axis=0) + share.max(axis=0) == pytest.approx(1.0, abs=1e-6)


def test_framing_nothing_changes_nothing():
    assert frame_all(Camera(), np.zeros((0, 3)), (640, 480)) == Camera()


@given(ANGLES, SIZES, st.tuples(st.floats(0, 1), st.floats(0, 1)), st.floats(0.5, 20))
def test_a_ray_through_a_pixel_meets_what_is_drawn_there(angles, size_px, place, distance_m):
    camera = orbit_camera((0.2, -0.4, 1), *angles, 3.0)
    pixel = (place[0] * size_px[0], place[1] * size_px[1])
    origin, direction = ray_through(camera, pixel, size_px)
    assert np.linalg.norm(direction) == pytest.approx(1.0)
    pixels, depth = project(camera, [origin + distance_m * direction], size_px)
    assert pixels[0] == pytest.approx(pixel, abs=1e-6)
    assert depth[0] > 0


def test_projection_and_clip_matrix_say_the_same():
    camera, size_px = orbit_camera((0, 0, 1), 30, 20, 4.0), (640, 360)
    points = np.random.default_rng(1).uniform(-1, 2, (50, 3))
    clip = np.column_stack([points, np.ones(50)]) @ clip_from_world(camera, size_px).T
    pixels, depth = project(camera, points, size_px)
    assert clip[:, 3] == pytest.approx(depth)
    assert (clip[:, 0] / clip[:, 3] + 1) / 2 * 640 == pytest.approx(pixels[:, 0])
    assert (1 - clip[:, 1] / clip[:, 3]) / 2 * 360 == pytest.approx(pixels[:, 1])


def test_seen_from_the_front_the_left_hand_is_on_the_right_and_up_is_up():
    camera = orbit_camera((0, 0, 1), azimuth_deg=0, elevation_deg=0, distance_m=3.0)
    assert camera.eye == pytest.approx((3, 0, 1))
    (left, right, head), _ = project(camera, [(0, 0.5, 1), (0, -0.5, 1), (0, 0, 1.6)], (200, 100))
    assert left[0] > 100 > right[0]
    assert head[1] < 50


@given(st.floats(-3, 3), st.floats(-3, 3))
def test_orbiting_keeps_the_target_and_the_distance_and_never_tips_over(yaw_rad, pitch_rad):
    camera = orbit(orbit_camera((1, 2, 1), 10, 30, 5.0), yaw_rad, pitch_rad)
    assert camera.target == (1, 2, 1)
    assert camera.distance_m == pytest.approx(5.0)
    assert camera.axes()[1][2] > 0  # up in the picture is up in the world


def test_panning_keeps_what_is_dragged_under_the_cursor():
    camera, size_px = orbit_camera((0, 0, 1), 25, 15, 4.0), (800, 600)
    before, _ = project(camera, [camera.target], size_px)
    after, _ = project(pan(camera, 37, -21, size_px), [camera.target], size_px)
    assert after - before == pytest.approx(np.array([[37, -21]]), abs=1e-6)


def test_zooming_in_and_out_comes_back_and_stops_short_of_the_target():
    camera = orbit_camera((0, 0, 1), 25, 15, 4.0)
    assert zoom(zoom(camera, 3), -3).eye == pytest.approx(camera.eye)
    assert zoom(camera, 2).distance_m < camera.distance_m
    assert zoom(camera, 1000).distance_m == pytest.approx(0.3)
    assert zoom(camera, -1000).distance_m == pytest.approx(60.0)


def test_following_halves_the_distance_in_each_half_life_at_any_frame_rate():
    camera, goal = Camera(), np.array([2.0, 1.0, 0.5])
    once = follow(camera, goal, 0.25, half_life_s=0.25)
    often = camera
    for _ in range(10):
        often = follow(often, goal, 0.025, half_life_s=0.25)
    assert np.subtract(goal, once.target) == pytest.approx(0.5 * np.subtract(goal, camera.target))
    assert often.target == pytest.approx(once.target)
    assert np.subtract(once.eye, once.target) == pytest.approx(np.subtract(camera.eye, camera.target))


def test_a_wider_lens_sees_more():
    narrow = Camera()
    wide = replace(narrow, fov_rad=math.radians(60))
    (near_edge,), _ = project(narrow, [(0, 0, 1.6)], (100, 100))
    (same,), _ = project(wide, [(0, 0, 1.6)], (100, 100))
    assert abs(same[1] - 50) < abs(near_edge[1] - 50)
