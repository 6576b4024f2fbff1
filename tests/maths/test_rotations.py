"""Arrays of quaternions against SciPy, and against the one-at-a-time kernels they are the twin of."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from engine.maths import quaternion, rotations

CASES = 500


@pytest.fixture
def rng():
    return np.random.default_rng(11)


def random_rotations(rng, count=CASES):
    return rotations.normalise(rng.normal(size=(count, 4)))


def oracle(q):
    return Rotation.from_quat(q, scalar_first=True)


def same_rotation(a, b, tolerance=1e-12):
    """Equal up to the sign that a quaternion may carry."""
    assert np.abs(np.abs(np.sum(a * b, axis=-1)) - 1.0).max() < tolerance


def test_product_and_turned_vectors_agree_with_scipy(rng):
    a, b, v = random_rotations(rng), random_rotations(rng), rng.normal(size=(CASES, 3))
    same_rotation(rotations.multiply(a, b), (oracle(a) * oracle(b)).as_quat(scalar_first=True))
    np.testing.assert_allclose(rotations.rotate(a, v), oracle(a).apply(v), atol=1e-12)
    np.testing.assert_allclose(rotations.unrotate(a, v), oracle(a).inv().apply(v), atol=1e-12)


@pytest.mark.parametrize("order", ["XYZ", "ZYX", "ZXY", "YXZ", "XZY", "YZX", "ZXZ", "X", "ZY"])
def test_euler_orders_agree_with_scipy(rng, order):
    angles = rng.uniform(-7, 7, size=(CASES, len(order)))
    same_rotation(rotations.from_euler(order, angles), Rotation.from_euler(order, angles).as_quat(scalar_first=True))


def test_matrices_agree_with_scipy_both_ways(rng):
    q = np.concatenate([random_rotations(rng), rotations.from_euler("XYZ", np.eye(3) * np.pi), [[1, 0, 0, 0]]])
    matrices = oracle(q).as_matrix()
    np.testing.assert_allclose(rotations.to_matrix(q), matrices, atol=1e-12)
    same_rotation(rotations.from_matrix(matrices), q)


def test_logarithm_and_exponential_agree_with_scipy(rng):
    q = np.concatenate([random_rotations(rng), [[1.0, 0, 0, 0], [-1.0, 0, 0, 0], [1.0, 1e-14, 0, 0], [0, 1.0, 0, 0]]])
    np.testing.assert_allclose(rotations.to_rotation_vector(q), oracle(q).as_rotvec(), atol=1e-9)
    r = np.concatenate([rng.normal(size=(CASES, 3)) * 2, np.zeros((1, 3)), [[1e-13, 0, 0]]])
    same_rotation(rotations.from_rotation_vector(r), Rotation.from_rotvec(r).as_quat(scalar_first=True))


def test_slerp_agrees_with_scipy_and_takes_the_shorter_arc(rng):
    a, b = random_rotations(rng, 40), random_rotations(rng, 40)
    for k in range(40):
        expected = Slerp([0.0, 1.0], Rotation.concatenate([oracle(a[k]), oracle(b[k])]))(0.3).as_quat(scalar_first=True)
        same_rotation(rotations.slerp(a[k], b[k], 0.3), expected)
        same_rotation(rotations.slerp(a[k], -b[k], 0.3), expected)


def test_slerp_moves_at_constant_speed(rng):
    a, b = random_rotations(rng), random_rotations(rng)
    quarter, half = rotations.slerp(a, b, 0.25), rotations.slerp(a, b, 0.5)
    np.testing.assert_allclose(rotations.angle_between(a, quarter) * 2, rotations.angle_between(a, half), atol=1e-9)


def test_between_takes_u_to_v_by_the_least_turn(rng):
    u, v = rng.normal(size=(2, CASES, 3))
    u, v = u / np.linalg.norm(u, axis=-1, keepdims=True), v / np.linalg.norm(v, axis=-1, keepdims=True)
    u[0], v[0], u[1], v[1] = [0, 0, 1], [0, 0, -1], [1, 0, 0], [-1, 0, 0]
    q = rotations.between(u, v)
    np.testing.assert_allclose(rotations.rotate(q, u), v, atol=1e-9)
    least = np.arccos(np.clip(np.sum(u * v, axis=-1), -1, 1))
    np.testing.assert_allclose(rotations.angle_between(np.array([1.0, 0, 0, 0]), q), least, atol=1e-6)


def test_continuity_keeps_the_rotation_and_never_jumps_hemisphere(rng):
    smooth = rotations.from_euler("XYZ", np.linspace(0, 9, CASES)[:, None] * np.array([1.0, 0.4, -0.7]))
    flipped = smooth * rng.choice([-1.0, 1.0], size=(CASES, 1))
    mended = rotations.continuity(flipped)
    assert np.sum(mended[1:] * mended[:-1], axis=-1).min() > 0.9
    same_rotation(mended, flipped)


def test_the_scalar_kernels_say_the_same(rng):
    a, b, v = random_rotations(rng, 20), random_rotations(rng, 20), rng.normal(size=(20, 3))
    for k in range(20):
        same_rotation(rotations.multiply(a[k], b[k]), np.array(quaternion.multiply(a[k], b[k])))
        same_rotation(rotations.slerp(a[k], b[k], 0.7), np.array(quaternion.slerp(a[k], b[k], 0.7)))
        np.testing.assert_allclose(rotations.rotate(a[k], v[k]), quaternion.rotate(a[k], v[k]), atol=1e-12)
        assert rotations.heading(a[k]) == pytest.approx(quaternion.heading(a[k]), abs=1e-12)
        assert rotations.angle_between(a[k], b[k]) == pytest.approx(quaternion.angle_between(a[k], b[k]), abs=1e-9)


def test_axis_angle_yaw_and_zero_quaternions():
    same_rotation(rotations.from_axis_angle(np.array([0, 0, 1.0]), 0.4), rotations.about_z(0.4))
    assert rotations.heading(rotations.about_z(np.array([0.4, -2.0]))) == pytest.approx([0.4, -2.0])
    np.testing.assert_array_equal(rotations.normalise(np.zeros(4)), [1, 0, 0, 0])
    pitched_up = rotations.from_euler("Y", np.array([-np.pi / 2]))
    assert rotations.heading(pitched_up) == pytest.approx(float(quaternion.heading(pitched_up)))
