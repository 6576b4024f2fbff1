"""Floors that are known: tilted, under someone in the air, under a foot that never stands."""

from __future__ import annotations

import numpy as np
import pytest

from engine.clips.contacts import planted, runs, slow_limit, speeds, without_short
from engine.clips.floor import fit_floor, level_from_floor
from engine.maths import rotations

FPS = 120.0


def walking_feet(slope=(0.0, 0.0), steps=6, apart_m=0.0):
    """Balls, ankles (F, 2, 3) and pelvis of someone who puts down one foot after the other along X; and when each
    stands."""
    frames = 60 * steps
    ball, stands = np.zeros((frames, 2, 3)), np.zeros((frames, 2), bool)
    for side in (0, 1):
        ball[:, side, 1] = 0.1 if side == 0 else -0.1
        x = 0.7 * side
        for step in range(steps):
            span = slice(60 * step, 60 * step + 60)
            t = np.linspace(0.0, 1.0, 60)
            if step % 2 == side:
                ball[span, side, 0] = x
                stands[span, side] = True
            else:
                ball[span, side, 0] = x + 1.4 * t * t * (3 - 2 * t)
                ball[span, side, 2] = 0.15 * np.sin(np.pi * t)
                x += 1.4
    ball[..., 2] += np.sum(ball[..., :2] * slope, axis=-1)
    ball[:, 1, 2] += apart_m
    pelvis = ball.mean(axis=1) + [0.0, 0.0, 0.9]
    return ball, ball + [-0.12, 0.0, 0.05], pelvis, stands


@pytest.mark.parametrize("slope", [(0.0, 0.0), (0.02, 0.0), (-0.015, 0.0)])
def test_a_tilted_floor_is_found_along_the_path(slope):
    ball, ankle, pelvis, _ = walking_feet(slope)
    floor = fit_floor(ball, ankle, pelvis, FPS)
    assert floor.slope == pytest.approx(slope, abs=2e-3)
    assert floor.ball_level_m == pytest.approx([0.0, 0.0], abs=5e-3)


def test_feet_stand_when_they_stand_whatever_the_slope():
    for slope in ((0.0, 0.0), (0.02, 0.0)):
        ball, ankle, pelvis, stands = walking_feet(slope)
        floor = fit_floor(ball, ankle, pelvis, FPS)
        # a foot is still slow for a few frames after it leaves
        assert (floor.planted != stands).mean() < 0.15
        assert floor.planted[stands].mean() > 0.98


def test_left_and_right_may_differ_by_their_markers():
    ball, ankle, pelvis, _ = walking_feet(apart_m=0.015)
    floor = fit_floor(ball, ankle, pelvis, FPS)
    assert floor.ball_level_m == pytest.approx([0.0, 0.015], abs=2e-3)


def test_a_foot_that_hangs_still_in_the_air_does_not_stand():
    ball = np.zeros((200, 2, 3))
    ball[:, 1, 2] = 0.12
    ankle = ball + [-0.12, 0.0, 0.05]
    floor = fit_floor(ball, ankle, ball.mean(axis=1) + [0.0, 0.0, 0.9], FPS)
    assert floor.planted[:, 0].all()
    assert not floor.planted[:, 1].any()
    assert floor.ball_level_m == pytest.approx([0.0, 0.0], abs=1e-9)


def test_someone_who_never_stands_has_the_floor_at_the_lowest_point():
    ball = np.zeros((100, 2, 3))
    ball[..., 0] = np.linspace(0, 5, 100)[:, None]
    ball[..., 2] = 0.3 + 0.2 * np.sin(np.linspace(0, 6, 100))[:, None]
    floor = fit_floor(ball, ball + [0.0, 0.0, 0.05], ball.mean(axis=1), FPS)
    assert floor.ball_level_m == pytest.approx(ball[..., 2].min(), abs=0.06)


def test_levelling_makes_the_slope_flat():
    slope = np.array([0.03, -0.01])
    at = np.random.default_rng(0).uniform(-2, 2, (50, 2))
    points = np.column_stack([at, np.einsum("ni,i->n", at, slope)])
    np.testing.assert_allclose(rotations.rotate(level_from_floor(slope), points)[:, 2], 0.0, atol=1e-12)


def test_speed_is_distance_over_time():
    points = np.arange(50.0)[:, None, None] * np.array([0.02, 0.0, 0.0])
    np.testing.assert_allclose(speeds(points, FPS), 2.4)
    assert slow_limit(points[:, 0], FPS) == pytest.approx(0.6)


def test_short_stands_and_short_steps_are_noise():
    flags = np.array([0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 0, 1, 1, 1, 0, 0], bool)
    assert runs(flags) == [(2, 2), (6, 9), (11, 13)]
    assert runs(without_short(without_short(flags, False, 2), True, 2)) == [(6, 13)]
    still = np.zeros((9, 2, 3))
    assert planted(still, still, still[:, 0], FPS).all()
