"""The comparison of two windows of motion, against its definition and a minimiser that knows no closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import minimize

from behaviours.components import SAMPLES
from behaviours.recover.windows import (
    FEATURES,
    difference,
    facing,
    features_into,
    joint_shares,
    nearest_of,
    sample_weight,
)
from engine.body.anthropometry import standard_body
from engine.body.skeleton import JOINT_COUNT, LEFT_HIP, LEFT_KNEE, MIRRORED

VELOCITY_S = 0.1
SHARE = joint_shares(standard_body())


def motion(seed: int, samples: int = SAMPLES) -> tuple[np.ndarray, np.ndarray]:
    """Joints and velocities (S, J, 3) of no person, the latest first."""
    chance = np.random.default_rng(seed)
    return chance.normal(size=(samples, JOINT_COUNT, 3)), 2.0 * chance.normal(size=(samples, JOINT_COUNT, 3))


def turned(vectors: np.ndarray, yaw: float) -> np.ndarray:
    c, s = math.cos(yaw), math.sin(yaw)
    return vectors @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])


def by_definition(one, other, yaw: float, x: float, y: float) -> float:
    """The weighted mean square of what is left between a window and another one turned and shifted."""
    samples = len(one[0])
    weight = np.array([sample_weight(k, samples) for k in range(samples)])
    weight = weight[:, None] * SHARE / weight.sum()
    places = ((one[0] - turned(other[0], yaw) - (x, y, 0.0)) ** 2).sum(axis=2)
    velocities = ((one[1] - turned(other[1], yaw)) ** 2).sum(axis=2)
    return float((weight * (places + VELOCITY_S**2 * velocities)).sum())


def as_index(*windows) -> tuple[np.ndarray, np.ndarray, list[int]]:
    """Windows one after the other as an index has them, earliest sample first, and the rows at which they end."""
    joints_m, joints_mps = (np.concatenate([window[n][::-1] for window in windows]) for n in (0, 1))
    return joints_m, joints_mps, [len(windows[0][0]) * (k + 1) - 1 for k in range(len(windows))]


@pytest.mark.parametrize("samples", [1, 2, SAMPLES])
@pytest.mark.parametrize("seed", range(3))
def test_what_is_left_is_what_the_definition_leaves_and_no_less_is_possible(seed, samples):
    one, other = motion(seed, samples), motion(seed + 10, samples)
    joints_m, joints_mps, (row,) = as_index(other)
    square, yaw, x, y = difference(*one, joints_m, joints_mps, row, SHARE, VELOCITY_S)
    assert square == pytest.approx(by_definition(one, other, yaw, x, y), rel=1e-12)
    starts = [(start, 0.0, 0.0) for start in np.linspace(-math.pi, math.pi, 7)]
    least = min(minimize(lambda v: by_definition(one, other, *v), start).fun for start in starts)
    assert square == pytest.approx(least, rel=1e-8)


def test_the_same_motion_elsewhere_is_the_same_motion():
    one = motion(5)
    moved = (turned(one[0], -2.1) + (3.0, -4.0, 0.0), turned(one[1], -2.1))
    joints_m, joints_mps, (row,) = as_index(moved)
    square, yaw, x, y = difference(*one, joints_m, joints_mps, row, SHARE, VELOCITY_S)
    assert square < 1e-12
    assert yaw == pytest.approx(2.1, abs=1e-9)
    np.testing.assert_allclose(turned(moved[0], yaw) + (x, y, 0.0), one[0], atol=1e-9)


def test_another_height_is_another_motion():
    one = motion(5)
    joints_m, joints_mps, (row,) = as_index((one[0] + (0.0, 0.0, 0.3), one[1]))
    assert difference(*one, joints_m, joints_mps, row, SHARE, VELOCITY_S)[0] == pytest.approx(0.09, rel=1e-9)


def test_of_equals_the_first_is_nearest():
    one, other = motion(1), motion(2)
    joints_m, joints_mps, rows = as_index(other, one, one)
    row, square, *_ = nearest_of(np.array(rows), *one, joints_m, joints_mps, SHARE, VELOCITY_S)
    assert row == rows[1]
    assert square < 1e-12


@pytest.mark.parametrize("seed", range(5))
def test_features_never_differ_more_than_the_poses_as_the_figures_see_them(seed):
    poses = [motion(seed + k, 1) for k in (0, 20)]
    features, seen = np.empty((2, FEATURES)), []
    for (joints_m, joints_mps), feature in zip(poses, features, strict=True):
        features_into(joints_m[0], joints_mps[0], SHARE, VELOCITY_S, feature)
        yaw = math.atan2(*facing(joints_m[0])[::-1])
        middle = (SHARE[:, None] * joints_m[0]).sum(axis=0) * (1.0, 1.0, 0.0)
        seen.append((turned(joints_m - middle, -yaw), turned(joints_mps, -yaw)))
    assert ((features[0] - features[1]) ** 2).sum() <= by_definition(*seen, 0.0, 0.0, 0.0)


def test_features_do_not_care_where_somebody_is_or_faces():
    joints_m, joints_mps = motion(3, 1)
    one, other = np.empty((2, FEATURES))
    features_into(joints_m[0], joints_mps[0], SHARE, VELOCITY_S, one)
    features_into(turned(joints_m[0], 1.2) + (5.0, 6.0, 0.0), turned(joints_mps[0], 1.2), SHARE, VELOCITY_S, other)
    np.testing.assert_allclose(one, other, atol=1e-9)


def test_a_joint_speaks_for_half_of_what_hangs_on_it_and_half_of_what_it_ends():
    body = standard_body()
    assert SHARE.sum() == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(SHARE, SHARE[MIRRORED], atol=1e-12)
    thigh, shank = (body.part_mass_kg[body.part_joint == joint].sum() for joint in (LEFT_HIP, LEFT_KNEE))
    assert SHARE[LEFT_KNEE] * body.part_mass_kg.sum() == pytest.approx(0.5 * (thigh + shank), rel=1e-12)
