"""Levels of drawing: all show the same, the governor settles on the dearest that is fast enough."""

from __future__ import annotations

import numpy as np
import pytest

from engine.render.camera import orbit_camera
from engine.render.quality import BEST, LEVELS, NAMES, Governor, quality_named, target_fps
from engine.render.scene import Ball, FloorStyle, Scene
from tests.render.golden import tile_differences
from tests.render.people import PROTECT, person

LARGE, SMALL = (1280, 720), (640, 360)


def _after(frames: int, cost_s, governor: Governor | None = None, size_px=LARGE) -> Governor:
    """A governor that has seen so many frames; cost_s: seconds of each level."""
    governor = governor or Governor()
    for _ in range(frames):
        governor.took(cost_s[governor.index], size_px)
    return governor


def test_it_settles_on_the_first_level_that_is_fast_enough():
    costs = [0.080, 0.060, 0.031, 0.020, 0.010]
    assert _after(200, costs).quality.name == "fair"
    assert _after(200, [0.020] * 5).quality is BEST


def test_small_pictures_are_wanted_at_sixty():
    assert target_fps(SMALL) == 60.0
    assert target_fps(LARGE) == 30.0
    costs = [0.028, 0.020, 0.015, 0.010, 0.005]
    assert _after(200, costs, size_px=SMALL).quality.name == "fair"
    assert _after(200, costs, size_px=LARGE).quality is BEST


def test_too_slow_everywhere_ends_at_the_cheapest():
    assert _after(500, [1.0] * 5).quality is LEVELS[-1]


def test_single_slow_frames_change_nothing():
    governor = Governor()
    for frame in range(300):
        governor.took(0.5 if frame % 10 == 0 else 0.02, LARGE)
    assert governor.quality is BEST


def test_it_comes_back_when_the_machine_is_free_again():
    governor = _after(100, [0.2] * 5)
    assert governor.quality is LEVELS[-1]
    assert _after(3000, [0.010] * 5, governor).quality is BEST


def test_it_does_not_flicker_between_a_level_too_slow_and_one_with_room_to_spare():
    governor, costs, changes = Governor(), [0.040, 0.010, 0.008, 0.006, 0.004], 0
    before = governor.index
    for _ in range(6000):
        governor.took(costs[governor.index], LARGE)
        changes += governor.index != before
        before = governor.index
    assert 1 <= changes <= 12  # each attempt at the dear level waits twice as long as the last


def test_names_lead_to_levels():
    assert [quality_named(name) for name in NAMES] == list(LEVELS)
    with pytest.raises(ValueError, match="best, good"):
        quality_named("ultra")


def test_every_level_shows_the_same_things(renderer):
    scene = Scene([person(PROTECT)], [Ball((0.7, 0.5, 1.7))], floor=FloorStyle("gym"), captions=[("top-left", "0.5 s")])
    camera, pictures = orbit_camera((0.0, 0.0, 0.95), 55.0, 9.0, 4.4), []
    for quality in LEVELS:
        renderer.quality = quality
        renderer.draw(scene, camera, SMALL)
        pictures.append(renderer.read_rgb())
    renderer.quality = BEST
    for cheaper in pictures[1:]:
        assert cheaper.shape == pictures[0].shape
        differences = tile_differences(pictures[0], cheaper)
        assert np.median(differences) < 5.0
        assert differences.max() < 60.0
    renderer.draw(scene, camera, SMALL)
    assert (renderer.read_rgb() == pictures[0]).all()
