"""The support polygon against SciPy's hull and shapes whose answer is known; feet on the ground."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from engine.body import footing, kinematics, limb_ik, support
from engine.body.anthropometry import standard_body
from engine.body.skeleton import ANKLES, HIPS, TOES, Pose
from engine.maths import quaternion
from tests.body.poses import identity_pose, random_pose, unpacked

BODY = standard_body()
BOTH, LEFT, NONE = np.array([True, True]), np.array([True, False]), np.array([False, False])


def standing():
    pose = identity_pose()
    positions, orientations = kinematics.joints_of(BODY, pose)
    return Pose(pose.root_m - [0, 0, footing.lowest_sole_m(BODY, positions, orientations)], pose.rotations)


@given(st.integers(0, 2**32 - 1), st.integers(3, 12))
def test_hull_is_scipys(seed, n):
    points = np.random.default_rng(seed).normal(size=(n, 2))
    ours = support.hull(points)
    theirs = points[ConvexHull(points).vertices]
    first = int(np.argmin(np.abs(theirs - ours[0]).sum(1)))
    np.testing.assert_array_equal(ours, np.roll(theirs, -first, axis=0))


def test_hull_drops_points_that_repeat_or_lie_on_an_edge():
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0], [0.5, 0.5], [1, 1], [0, 0]], float)
    np.testing.assert_array_equal(support.hull(square), [[0, 0], [1, 0], [1, 1], [0, 1]])


@pytest.mark.parametrize(
    ("points", "m"), [([], 0), ([[1, 2]], 1), ([[1, 2], [1, 2]], 1), ([[0, 0], [2, 2], [1, 1]], 2)]
)
def test_hull_of_a_point_or_a_line(points, m):
    polygon = support.hull(np.array(points, float).reshape(-1, 2))
    assert len(polygon) == m
    assert not support.inside(polygon, (1.0, 1.0))


def test_margin_is_the_signed_distance_to_the_edge():
    square = support.hull(np.array([[0, 0], [2, 0], [2, 1], [0, 1]], float))
    assert support.margin_m(square, (1.0, 0.4)) == pytest.approx(0.4)
    assert support.margin_m(square, (1.9, 0.5)) == pytest.approx(0.1)
    assert support.margin_m(square, (3.0, 0.5)) == pytest.approx(-1.0)
    assert support.margin_m(square, (3.0, 2.0)) == pytest.approx(-math.sqrt(2))
    assert support.margin_m(square, (2.0, 0.5)) == 0.0
    line = support.hull(np.array([[0, 0], [2, 0]], float))
    assert support.margin_m(line, (1.0, 0.3)) == pytest.approx(-0.3)
    assert support.margin_m(support.hull(np.empty((0, 2))), (0.0, 0.0)) == -math.inf


@given(st.integers(0, 2**32 - 1))
def test_the_nearest_edge_point_is_on_the_edge_and_none_is_nearer(seed):
    rng = np.random.default_rng(seed)
    polygon = support.hull(rng.normal(size=(8, 2)))
    point = rng.normal(size=2) * 1.5
    margin = support.margin_m(polygon, point)
    t = np.linspace(0, 1, 400)[:, None]
    edge = np.concatenate([polygon[k - 1] + t * (polygon[k] - polygon[k - 1]) for k in range(len(polygon))])
    assert abs(margin) <= np.linalg.norm(edge - point, axis=1).min() + 1e-12
    assert abs(margin) >= np.linalg.norm(edge - point, axis=1).min() - 0.02


def test_standing_upright_is_balanced_on_two_feet_and_not_on_one():
    pose = standing()
    _, positions, orientations = unpacked(BODY, pose)
    com = kinematics.com_of(BODY, pose)
    both = support.polygon_of(BODY, positions, orientations, BOTH)
    assert support.margin_m(both, com[:2]) > 0.02
    assert support.margin_m(support.polygon_of(BODY, positions, orientations, LEFT), com[:2]) < 0.0
    assert len(support.polygon_of(BODY, positions, orientations, NONE)) == 0
    # as long as a foot from heel contact to toe contact, as wide as the outer edges of the balls
    assert np.ptp(both[:, 0]) == pytest.approx(0.2 + 0.02, abs=0.03)
    assert np.ptp(both[:, 1]) > 0.2


def test_on_tiptoe_only_the_front_of_the_foot_bears():
    pose = standing()
    pose.rotations[ANKLES[0]] = quaternion.about_y(0.5)
    pose.rotations[TOES[0]] = quaternion.about_y(-0.5)
    _, positions, orientations = unpacked(BODY, pose)
    polygon = support.polygon_of(BODY, positions, orientations, LEFT)
    assert polygon[:, 0].min() > positions[ANKLES[0], 0] + 0.05


@given(st.integers(0, 2**32 - 1), st.integers(0, 1))
def test_a_foot_that_is_put_down_lies_flat_where_it_was_sent(seed, side):
    pose = random_pose(np.random.default_rng(seed), 0.4)
    rotations, positions, orientations = unpacked(BODY, pose)
    ground = positions[HIPS[side], 2] - 0.75
    target, foot, reachable = footing.nearest_footing(BODY, positions, orientations, side, ground, 0.01)
    assert reachable
    before = positions[ANKLES[side], :2].copy()
    heading = footing.foot_heading(orientations, side)
    limb_ik.apply_leg(BODY, rotations, positions, orientations, side, target, foot, limb_ik.KEEP)
    rotations[TOES[side]] = quaternion.IDENTITY
    positions, orientations = kinematics.joints_of(BODY, Pose(pose.root_m, rotations))
    points = support.sole_points(BODY, positions, orientations)[side]
    np.testing.assert_allclose(points[:, 2], ground, atol=1e-9)
    assert abs(math.remainder(footing.foot_heading(orientations, side) - heading, 2 * math.pi)) < 1e-9
    # straight below, or as near as the leg lets it
    hip = positions[HIPS[side]]
    if math.dist(before, target[:2]) > 1e-9:
        assert math.dist(target, hip) == pytest.approx(footing.leg_length_m(BODY, side) - 0.01)


def test_a_foot_that_hangs_past_the_vertical_still_points_ahead():
    _, _, orientations = unpacked(BODY, identity_pose())
    for pitch in (0.0, 1.2, 1.57, 2.2):
        orientations[ANKLES[0]] = quaternion.multiply(quaternion.about_z(0.4), quaternion.about_y(pitch))
        assert footing.foot_heading(orientations, 0) == pytest.approx(0.4, abs=1e-12)


def test_a_hip_too_high_over_the_ground_is_said():
    _, positions, orientations = unpacked(BODY, identity_pose(2.0))
    target, _, reachable = footing.nearest_footing(BODY, positions, orientations, 0, 0.0, 0.01)
    assert not reachable
    assert target[:2] == tuple(positions[HIPS[0], :2])


def test_a_step_leaves_and_meets_the_ground_at_rest():
    share = np.linspace(0, 1, 1001)
    path = np.array([footing.stepped((0.0, 0.0, 0.1), (0.3, 0.1, 0.1), s, 0.05) for s in share])
    np.testing.assert_allclose(path[[0, -1]], [[0, 0, 0.1], [0.3, 0.1, 0.1]], atol=1e-15)
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1) * 1000
    assert speed[0] < 0.01
    assert speed[-1] < 0.01
    assert path[:, 2].max() == pytest.approx(0.15)
