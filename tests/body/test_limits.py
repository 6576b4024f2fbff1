"""Joint limits: taken apart and put together, clamped without tears, a clip's own excess kept."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.body import limits
from engine.body.anthropometry import standard_body
from engine.body.skeleton import ELBOWS, JOINT_COUNT, KNEES, MIRRORED, NECK, PELVIS, SHOULDERS, WAIST
from engine.maths import quaternion
from tests.body.poses import mirrored, random_pose

BODY = standard_body()
LOW, HIGH = BODY.limit_low_rad, BODY.limit_high_rad
angles = st.integers(-1200, 1200).map(lambda a: a / 1000)


@given(angles, angles, angles)
def test_components_are_what_the_rotation_was_made_of(x, y, z):
    np.testing.assert_allclose(limits.components(limits.from_components(x, y, z)), (x, y, z), atol=1e-12)


@given(st.integers(0, 2**32 - 1), st.integers(1, JOINT_COUNT - 1))
def test_a_clamped_rotation_is_inside_and_one_inside_is_not_touched(seed, joint):
    q = quaternion.normalise(np.random.default_rng(seed).normal(size=4))
    clamped = limits.clamp_rotation(LOW[joint], HIGH[joint], q)
    inside = np.array(limits.components(clamped))
    assert (inside >= LOW[joint] - 1e-9).all()
    assert (inside <= HIGH[joint] + 1e-9).all()
    if limits.joint_excess_rad(LOW[joint], HIGH[joint], quaternion.IDENTITY, q) == 0.0:
        assert clamped == q
    assert np.dot(clamped, q) >= 0.0


@given(st.integers(0, 2**32 - 1), st.integers(1, JOINT_COUNT - 1))
def test_clamping_is_continuous(seed, joint):
    """A small change in makes a small change out, all over the range that people and their mocap come near."""
    rng = np.random.default_rng(seed)
    a = rng.uniform(-2.4, 2.4, 3) / [1.5, 1.5, 1.0]
    q = limits.from_components(*a)
    nearby = quaternion.multiply(q, quaternion.from_rotation_vector(1e-5 * rng.normal(size=3)))
    one, other = (limits.clamp_rotation(LOW[joint], HIGH[joint], r) for r in (q, nearby))
    assert quaternion.angle_between(one, other) < 1e-3


def test_an_elbow_mixed_from_one_twist_to_another_stays_a_hinge_and_inside_its_limits():
    low, high = LOW[ELBOWS[0]], HIGH[ELBOWS[0]]
    a, b = limits.from_components(0.0, -0.3, 1.4), limits.from_components(0.0, -2.4, -1.0)
    assert quaternion.angle_between(limits.mix(a, b, 0.0), a) < 1e-9
    assert quaternion.angle_between(limits.mix(a, b, 1.0), b) < 1e-9
    slerped = 0.0
    for weight in np.linspace(0, 1, 21):
        between = limits.mix(a, b, weight)
        assert abs(limits.components(between)[0]) < 1e-12
        assert limits.joint_excess_rad(low, high, quaternion.IDENTITY, between) == 0.0
        slerp = quaternion.slerp(a, b, weight)
        slerped = max(slerped, limits.joint_excess_rad(low, high, quaternion.IDENTITY, slerp))
    assert slerped > 0.2  # what it is for


def test_an_excess_of_the_reference_is_kept_and_never_added_to():
    low, high = LOW[KNEES[0]], HIGH[KNEES[0]]
    overstretched = quaternion.about_y(-0.1)
    assert limits.clamp_keeping(low, high, overstretched, overstretched) == overstretched
    further = limits.clamp_keeping(low, high, overstretched, quaternion.about_y(-0.3))
    np.testing.assert_allclose(further, overstretched, atol=1e-12)
    np.testing.assert_allclose(limits.clamp_rotation(low, high, overstretched), quaternion.IDENTITY, atol=1e-12)
    bent = quaternion.about_y(0.7)
    assert limits.clamp_keeping(low, high, overstretched, bent) == bent


def test_excess_is_counted_in_radians_per_joint_and_pose():
    rotations = np.tile(quaternion.IDENTITY, (2, JOINT_COUNT, 1))
    rotations[1, KNEES[1]] = quaternion.about_y(-0.25)
    rotations[1, NECK] = quaternion.about_z(HIGH[NECK, 2] + 0.1)
    rotations[1, PELVIS] = quaternion.about_x(3.0)
    excess = limits.excess_rad(BODY, rotations)
    assert excess.shape == (2, JOINT_COUNT)
    assert excess[0].max() == 0.0
    assert excess[1, KNEES[1]] == pytest.approx(0.25)
    assert excess[1, NECK] == pytest.approx(0.1)
    assert excess[1, PELVIS] == 0.0
    reference = rotations[1].copy()
    assert limits.excess_beyond_rad(BODY, rotations, reference).max() < 1e-12
    reference[KNEES[1]] = quaternion.about_y(-0.2)
    assert limits.excess_beyond_rad(BODY, rotations, reference)[1, KNEES[1]] == pytest.approx(0.05)


def test_a_whole_pose_is_clamped_in_place_as_its_mirror_image_is():
    pose = random_pose(np.random.default_rng(4), 1.6)
    other = mirrored(pose)
    still = np.tile(quaternion.IDENTITY, (JOINT_COUNT, 1))
    for p in (pose, other):
        limits.clamp_pose(BODY, still, p.rotations)
        assert limits.excess_rad(BODY, p.rotations).max() < 1e-9
    np.testing.assert_allclose(np.abs((mirrored(other).rotations * pose.rotations).sum(-1)), 1.0, atol=1e-12)


def test_the_ranges_let_the_thesis_have_its_greatest_rotations_and_forbid_the_impossible():
    """Table 3.2's rotations are possible; elbows and knees do not go backwards; left is the mirror of right."""
    for joint, x, y, z in ((NECK, 50, 50, 65), (2, 25, 25, 8), (WAIST, 10, 10, 12)):
        for sign in (-1, 1):
            for part in np.diag([x, y, z]):
                q = limits.from_components(*np.radians(sign * part))
                assert limits.joint_excess_rad(LOW[joint], HIGH[joint], quaternion.IDENTITY, q) < 1e-9
    assert limits.excess_rad(BODY, np.tile(quaternion.IDENTITY, (JOINT_COUNT, 1))).max() == 0.0
    assert HIGH[ELBOWS[0], 1] == 0.0
    assert LOW[KNEES[0], 1] == 0.0
    for j in range(JOINT_COUNT):
        m = MIRRORED[j]
        np.testing.assert_array_equal(LOW[m], [-HIGH[j, 0], LOW[j, 1], -HIGH[j, 2]])
    # an arm held straight forward and 45 degrees across the chest: horizontal adduction of 135 degrees
    across = quaternion.between((0.0, 0.0, -1.0), (math.sqrt(0.5), -math.sqrt(0.5), 0.0))
    assert limits.joint_excess_rad(LOW[SHOULDERS[0]], HIGH[SHOULDERS[0]], quaternion.IDENTITY, across) == 0.0
