"""Limb IK: reaches, keeps, mirrors, saturates; checked against the cosine law and forward kinematics."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.body import kinematics, limb_ik, two_bones
from engine.body.anthropometry import standard_body
from engine.body.skeleton import ANKLES, ELBOWS, HIPS, KNEES, SHOULDERS, TOES, WRISTS, Pose
from engine.maths import quaternion
from tests.body.poses import mirrored, random_pose, unpacked

BODY = standard_body()
seeds = st.integers(0, 2**32 - 1)
sides = st.integers(0, 1)


def lengths(side, leg=False):
    mid, end = (KNEES, ANKLES) if leg else (ELBOWS, WRISTS)
    return [float(np.linalg.norm(BODY.offset_m[j[side]])) for j in (mid, end)]


def direction(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def solve(rng, side, leg, distance_m, swivel=None, pose=None, soft_m=limb_ik.SOFT_REACH_M, towards=None):
    """One random pose, one target at a distance from the limb's root. Returns what the tests look at."""
    pose = pose or random_pose(rng)
    rotations, positions, orientations = unpacked(BODY, pose)
    root = positions[(HIPS if leg else SHOULDERS)[side]].copy()
    target = root + distance_m * (direction(rng) if towards is None else towards)
    if leg:
        foot = orientations[ANKLES[side]].copy()
        swivel = limb_ik.KEEP if swivel is None else swivel
        miss = limb_ik.apply_leg(BODY, rotations, positions, orientations, side, target, foot, swivel, soft_m)
    else:
        swivel = limb_ik.KEEP if swivel is None else swivel
        pose_arrays = (rotations, positions, orientations)
        miss = limb_ik.apply_arm(BODY, *pose_arrays, side, target, swivel, limb_ik.CARRIED, soft_m)
    return pose, rotations, positions, orientations, target, miss


@settings(max_examples=80, deadline=None)
@given(seeds, sides, st.booleans(), st.floats(0.3, 0.97), st.floats(-3.0, 3.0))
def test_reaches_target_and_swivel_and_agrees_with_forward_kinematics(seed, side, leg, share, swivel):
    rng = np.random.default_rng(seed)
    full = sum(lengths(side, leg))
    distance = min(share * full, full - limb_ik.SOFT_REACH_M)
    pose, rotations, positions, orientations, target, miss = solve(rng, side, leg, distance, swivel)
    end = (ANKLES if leg else WRISTS)[side]
    assert np.linalg.norm(positions[end] - target) < 1e-9
    assert miss < 1e-9
    again, turned = kinematics.joints_of(BODY, Pose(pose.root_m, rotations))
    np.testing.assert_allclose(again, positions, atol=1e-12)
    np.testing.assert_allclose(np.abs((turned * orientations).sum(-1)), 1.0, atol=1e-12)
    measured = (
        limb_ik.leg_swivel(positions, orientations, side)
        if leg
        else limb_ik.arm_swivel(positions, orientations, side, limb_ik.CARRIED)
    )
    assert abs(math.remainder(measured - swivel, 2 * math.pi)) < 1e-7


@settings(max_examples=40, deadline=None)
@given(seeds, sides, st.floats(0.4, 0.95))
def test_elbow_angle_by_the_cosine_law(seed, side, share):
    rng = np.random.default_rng(seed)
    a, b = lengths(side)
    distance = share * (a + b)
    _, rotations, positions, _, _, _ = solve(rng, side, False, distance)
    u = positions[ELBOWS[side]] - positions[SHOULDERS[side]]
    v = positions[WRISTS[side]] - positions[ELBOWS[side]]
    inner_angle = math.pi - math.acos(np.dot(u, v) / (a * b))
    expected = math.acos((a * a + b * b - distance * distance) / (2 * a * b))
    assert inner_angle == pytest.approx(expected, abs=1e-7)
    # and it is the elbow's own flexion (negative Y), not some other turn
    local = quaternion.to_rotation_vector(quaternion.swing_twist(rotations[ELBOWS[side]])[0])
    assert local[1] == pytest.approx(-(math.pi - expected), abs=1e-7)
    assert abs(local[0]) < 1e-7


@settings(max_examples=60, deadline=None)
@given(seeds, sides, st.booleans(), st.sampled_from([0.0, 0.02, 0.3, -0.06]))
def test_asking_for_nothing_changes_nothing_even_for_imperfect_hinges(seed, side, leg, flexion):
    """Bent sideways by some degrees, straight, and overstretched: the limb that is where it should be stays."""
    rng = np.random.default_rng(seed)
    pose = random_pose(rng)
    mid = (KNEES if leg else ELBOWS)[side]
    sign = 1.0 if leg else -1.0
    askew, twist = rng.uniform(-0.2, 0.2), rng.uniform(-0.5, 0.5)
    pose.rotations[mid] = quaternion.from_rotation_vector((askew, sign * flexion, twist))
    rotations, positions, orientations = unpacked(BODY, pose)
    before = [a.copy() for a in (rotations, positions, orientations)]
    end = (ANKLES if leg else WRISTS)[side]
    target, turned = positions[end].copy(), orientations[end].copy()
    if leg:
        swivel = limb_ik.leg_swivel(positions, orientations, side)
        miss = limb_ik.apply_leg(BODY, rotations, positions, orientations, side, target, turned, swivel)
    else:
        swivel = limb_ik.arm_swivel(positions, orientations, side)
        miss = limb_ik.apply_arm(BODY, rotations, positions, orientations, side, target, swivel)
    assert miss < 1e-12
    for was, now in zip(before, (rotations, positions, orientations), strict=True):
        np.testing.assert_allclose(now, was, atol=1e-12)


@settings(max_examples=60, deadline=None)
@given(seeds, sides, st.booleans(), st.floats(0.2, 1.2), st.floats(-2.0, 2.0))
def test_left_mirrored_is_right(seed, side, leg, share, swivel):
    rng = np.random.default_rng(seed)
    pose = random_pose(rng)
    towards = direction(rng)
    distance = share * sum(lengths(side, leg))
    one = solve(rng, side, leg, distance, swivel, pose, towards=towards)
    other = solve(rng, 1 - side, leg, distance, swivel, mirrored(pose), towards=towards * [1, -1, 1])
    back = mirrored(Pose(other[0].root_m, other[1])).rotations
    np.testing.assert_allclose(np.abs((one[1] * back).sum(-1)), 1.0, atol=1e-12)
    np.testing.assert_allclose(one[1], back * np.sign((one[1] * back).sum(-1))[:, None], atol=1e-12)
    assert one[5] == pytest.approx(other[5], abs=1e-12)


@settings(max_examples=60, deadline=None)
@given(st.floats(0.0, 0.02))
def test_reach_saturates_smoothly_and_keeps_the_present_length(below_m):
    """By finite differences no kink; never longer than the limb; the present length stays."""
    full, soft = 0.56, 0.01
    present = full - below_m
    wanted = np.linspace(full - 0.03, full + 0.03, 6001)
    reach = np.array([two_bones.soft_reach(w, present, full, soft) for w in wanted])
    step = wanted[1] - wanted[0]
    slopes = np.diff(reach) / step
    assert reach.max() <= full + 1e-12
    assert (slopes > -1e-9).all()
    assert np.abs(np.diff(slopes)).max() < 900 * step  # curvature bounded: no kink (a kink would be 0.5 or more)
    assert two_bones.soft_reach(present, present, full, soft) == pytest.approx(present, abs=1e-12)
    assert (reach[wanted < full - soft] == wanted[wanted < full - soft]).all()
    assert (reach - wanted).max() < 0.15 * soft


def test_hard_reach_is_exact_up_to_the_full_length():
    rng = np.random.default_rng(5)
    full = sum(lengths(0, leg=True))
    miss = solve(rng, 0, True, full - 1e-6, soft_m=0.0)[-1]
    assert miss < 1e-9
    miss = solve(rng, 0, True, full + 0.1, soft_m=0.0)[-1]
    assert miss == pytest.approx(0.1, abs=1e-9)


@pytest.mark.parametrize("leg", [False, True])
def test_the_end_moves_continuously_while_the_target_passes_through_full_reach(leg):
    """The limb's end, along a straight path of the target from inside to outside, makes no jump and no kink."""
    rng = np.random.default_rng(3)
    pose, towards, full = random_pose(rng), direction(rng), sum(lengths(0, leg))
    distances = np.linspace(full - 0.04, full + 0.04, 801)
    end = (ANKLES if leg else WRISTS)[0]
    ends = np.array([solve(rng, 0, leg, d, 0.4, pose, towards=towards)[2][end] for d in distances])
    speeds = np.linalg.norm(np.diff(ends, axis=0), axis=1) / (distances[1] - distances[0])
    assert speeds.max() < 1.0 + 1e-6
    assert np.abs(np.diff(speeds)).max() < 0.05


@settings(max_examples=60, deadline=None)
@given(seeds, sides, st.booleans(), st.floats(0.01, 1.5))
def test_never_bends_backwards(seed, side, leg, share):
    rng = np.random.default_rng(seed)
    _, rotations, *_ = solve(rng, side, leg, share * sum(lengths(side, leg)), rng.uniform(-3, 3))
    mid = (KNEES if leg else ELBOWS)[side]
    flexion = quaternion.to_rotation_vector(quaternion.swing_twist(rotations[mid])[0])[1] * (1 if leg else -1)
    greatest = BODY.limit_high_rad[mid, 1] if leg else -BODY.limit_low_rad[mid, 1]
    assert -1e-7 <= flexion <= greatest + 1e-7


def test_an_overstretched_knee_goes_over_into_bending_forwards_without_a_jump():
    pose = random_pose(np.random.default_rng(8))
    pose.rotations[KNEES[0]] = quaternion.about_y(-0.05)
    _, positions, _ = unpacked(BODY, pose)
    away = positions[ANKLES[0]] - positions[HIPS[0]]
    present = np.linalg.norm(away)
    flexions, misses = [], []
    for distance in np.linspace(present, present - 0.05, 4001):
        solved = solve(None, 0, True, distance, None, pose, towards=away / present)
        flexions.append(quaternion.to_rotation_vector(solved[1][KNEES[0]])[1])
        misses.append(solved[5])
    assert flexions[0] == pytest.approx(-0.05, abs=1e-9)
    assert flexions[-1] > 0.4
    assert np.abs(np.diff(flexions)).max() < 0.03
    assert max(misses) < 0.002
    assert misses[-1] < 1e-9


@pytest.mark.parametrize("side", [0, 1])
def test_positive_swivel_points_away_from_the_body_and_zero_down(side):
    rotations, positions, orientations = unpacked(BODY, mirrored(random_pose(np.random.default_rng(0))))
    rotations[:] = [1, 0, 0, 0]
    kinematics.joints_into(BODY.offset_m, np.array([0.0, 0.0, 1.0]), rotations, positions, orientations)
    target = positions[SHOULDERS[side]] + [0.4, 0.0, 0.0]
    limb_ik.apply_arm(BODY, rotations, positions, orientations, side, target, 0.0)
    below = positions[ELBOWS[side]] - positions[SHOULDERS[side]]
    assert below[2] < -0.1
    assert abs(below[1]) < 1e-12
    limb_ik.apply_arm(BODY, rotations, positions, orientations, side, target, math.pi / 2)
    out = positions[ELBOWS[side]] - positions[SHOULDERS[side]]
    assert out[1] * (1 if side == 0 else -1) > 0.1
    assert abs(out[2]) < 1e-9


def test_swivel_references_agree_straight_ahead_and_never_turn_over_in_walking_or_kicking():
    """Where the fixed reference flips (an arm swinging through hanging), the carried one turns as little as the arm."""
    _, _, orientations = unpacked(BODY, random_pose(np.random.default_rng(0)))
    orientations[:] = [1, 0, 0, 0]
    for angle in np.linspace(0.1, 3.0, 30):  # from nearly hanging, forwards, to nearly straight up
        n = (math.sin(angle), 0.0, -math.cos(angle))
        down = np.array(limb_ik.arm_zero(orientations, 0, limb_ik.DOWN, n))
        down = down - np.dot(down, n) * np.array(n)
        carried = limb_ik.arm_zero(orientations, 0, limb_ik.CARRIED, n)
        np.testing.assert_allclose(down / np.linalg.norm(down), carried, atol=1e-9)
    swing = [(math.sin(a), 0.02, -math.cos(a)) for a in np.linspace(-0.9, 2.5, 400)]
    for reference in (
        lambda n: limb_ik.arm_zero(orientations, 0, limb_ik.CARRIED, n),
        lambda n: limb_ik.knee_zero(orientations, n),
    ):
        axes = np.array([reference(np.array(n) / np.linalg.norm(n)) for n in swing])
        assert np.linalg.norm(np.diff(axes, axis=0), axis=1).max() < 0.05


def test_a_leg_keeps_the_foot_as_asked_and_carries_the_toe():
    pose, _, positions, orientations, _, _ = solve(np.random.default_rng(11), 0, True, 0.7, 0.2)
    _, before = kinematics.joints_of(BODY, pose)
    np.testing.assert_allclose(orientations[ANKLES[0]], before[ANKLES[0]], atol=1e-12)
    toe = positions[ANKLES[0]] + quaternion.rotate(before[ANKLES[0]], BODY.offset_m[TOES[0]])
    np.testing.assert_allclose(positions[TOES[0]], toe, atol=1e-12)
