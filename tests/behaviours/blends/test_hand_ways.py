"""The ways of the hands in a blend: straight where that is a way for an arm; else round the body, smooth, in limits."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from behaviours.blends.arm_ways import (
    BEYOND_RAD,
    INTERPOLATED,
    SWUNG,
    HandWays,
    knot_weights,
    straight_ways,
    swing_arm,
    yielding,
)
from behaviours.blends.hand_ways import MOMENTS, choose_ways, let_be, moments_of
from behaviours.measure.measures import distance_from_line
from behaviours.timing import ease
from engine.body.kinematics import joints_of
from engine.body.limits import excess_rad
from engine.body.overlap import PAIRS, overlaps_m
from engine.body.skeleton import ELBOWS, SHOULDERS, WRISTS, Pose
from engine.clips.mirror import mirror_pose
from tests.behaviours.people import BODY, standing
from tests.behaviours.two_poses import SHAPE, at_ease, between, end_of, on_guard, with_arm

# the left hand from before the right shoulder to behind the left ear: straight, that leads through the head
ACROSS = with_arm(at_ease(), 0, (-60.0, -90.0, -30.0), 60.0)
BEHIND = with_arm(at_ease(), 0, (130.0, -80.0, 70.0), 120.0)
FINE = np.linspace(0.0, 1.0, 101)


@njit
def _weights(weight):
    return knot_weights(weight)


@njit
def _swing(body, first, last, weight, side, bends):
    return swing_arm(body, first, last, weight, side, bends)


def chosen(first: Pose, last: Pose) -> HandWays:
    """The ways from one pose to another."""
    start, end, ways = end_of(first), end_of(last), straight_ways()
    progress = np.linspace(0.0, 1.0, MOMENTS)
    poses = [between(first, last, ease(u)) for u in progress]
    choose_ways(BODY, SHAPE, start, end, moments_of(BODY, SHAPE, start, end, progress, poses), ways)
    return ways


def followed(first: Pose, last: Pose, ways: HandWays, weights=FINE) -> Pose:
    """All the way, one pose a weight."""
    poses = [between(first, last, weight, ways) for weight in weights]
    return Pose(np.array([pose.root_m for pose in poses]), np.array([pose.rotations for pose in poses]))


def too_deep_m(first: Pose, last: Pose, poses: Pose) -> float:
    """The most that an arm is inside head, trunk or the other arm, beyond what either end has."""
    both = Pose(*(np.array([a, b]) for a, b in zip(first, last, strict=True)))
    return float((overlaps_m(BODY, poses) - np.maximum(overlaps_m(BODY, both).max(axis=0), 0.0)).max())


@pytest.fixture(scope="module")
def round_the_head() -> HandWays:
    return chosen(ACROSS, BEHIND)


def test_hands_go_straight_where_nothing_is_in_the_way():
    ways = chosen(at_ease(), on_guard())
    assert list(ways.modes) == [INTERPOLATED, INTERPOLATED]
    assert not ways.bends.any()


def test_a_way_through_the_head_is_gone_round(round_the_head):
    straight = followed(ACROSS, BEHIND, straight_ways())
    assert too_deep_m(ACROSS, BEHIND, straight) > 0.02  # what it is there for
    assert round_the_head.modes[0] == SWUNG
    assert round_the_head.modes[1] == INTERPOLATED  # the other arm has nothing to go round
    assert too_deep_m(ACROSS, BEHIND, followed(ACROSS, BEHIND, round_the_head)) < 0.005


def test_a_way_has_no_pops(round_the_head):
    """No joint of the arm changes its velocity at once: the second difference falls with the square of the step."""
    arm = [SHOULDERS[0], ELBOWS[0], WRISTS[0]]
    joints_m = joints_of(BODY, followed(ACROSS, BEHIND, round_the_head))[0][:, arm]
    assert np.linalg.norm(np.diff(joints_m, 2, axis=0), axis=2).max() < 12.0 * (FINE[1] - FINE[0]) ** 2


@pytest.mark.parametrize("last_twist_deg", [33.0, 60.0, 90.0])
def test_no_arm_is_led_through_the_twist_that_a_shoulder_does_not_have(last_twist_deg):
    """Straight, the shoulder would turn past half a turn of twist, and its limits throw it to the other side there."""
    first = with_arm(at_ease(), 0, (95.0, 50.0, -126.0), 134.0)
    last = with_arm(at_ease(), 0, (100.0, -20.0, last_twist_deg), 110.0)
    wrist_m = joints_of(BODY, followed(first, last, chosen(first, last)))[0][:, WRISTS[0]]
    assert np.linalg.norm(np.diff(wrist_m, axis=0), axis=1).max() < 0.05  # in a hundredth of the way


def test_a_chosen_way_ends_where_the_blend_ends(round_the_head):
    poses = followed(ACROSS, BEHIND, round_the_head, [0.0, 1.0])
    for k, wanted in enumerate((ACROSS, BEHIND)):
        shown = joints_of(BODY, Pose(poses.root_m[k], poses.rotations[k]))[0]
        np.testing.assert_allclose(shown, joints_of(BODY, wanted)[0], atol=1e-6)


def test_the_mirrored_way_is_the_mirror_image(round_the_head):
    mirrored = chosen(mirror_pose(ACROSS), mirror_pose(BEHIND))
    assert list(mirrored.modes) == list(round_the_head.modes[::-1])
    np.testing.assert_allclose(mirrored.bends[1], round_the_head.bends[0], atol=1e-6)


def test_hands_that_would_meet_pass_each_other():
    """Both hands across the body and back: one of them has to give way."""
    left_high = with_arm(with_arm(standing(), 0, (-40.0, -60.0, 0.0), 90.0), 1, (-40.0, -35.0, 0.0), 90.0)
    right_high = mirror_pose(left_high)
    straight = followed(left_high, right_high, straight_ways())
    ways = chosen(left_high, right_high)
    assert too_deep_m(left_high, right_high, straight) > 0.02
    assert too_deep_m(left_high, right_high, followed(left_high, right_high, ways)) < 0.008


angles = st.floats(-2.0, 2.0)


@settings(max_examples=60)
@given(st.lists(angles, min_size=8, max_size=8), st.floats(0.0, 1.0), st.sampled_from((0, 1)))
def test_however_a_swung_arm_is_bent_it_stays_within_its_limits(bends, weight, side):
    first, last = on_guard(), with_arm(standing(), side, (60.0, -30.0, 20.0), 40.0)
    shoulder, elbow = _swing(BODY, first.rotations, last.rotations, weight, side, np.array(bends).reshape(2, 4))
    rotations = standing().rotations
    rotations[SHOULDERS[side]], rotations[ELBOWS[side]] = shoulder, elbow
    assert excess_rad(BODY, rotations).max() < BEYOND_RAD


def test_knots_are_the_inner_ones_of_a_cubic():
    """With the two outer Bernstein polynomials they add up to one; at the ends there is nothing of them."""
    for weight in FINE:
        early, late = _weights(weight)
        assert early + late + weight**3 + (1.0 - weight) ** 3 == pytest.approx(1.0)
    assert _weights(0.0) == (0.0, 0.0)
    assert _weights(1.0) == (0.0, 0.0)


@given(st.floats(-3.0, 3.0))
def test_a_limit_gives_a_little_and_begins_to_without_a_kink(excess):
    left = yielding(excess)
    assert abs(left) < BEYOND_RAD
    assert left * excess >= 0.0
    assert abs(left - excess) <= excess * excess / BEYOND_RAD + 1e-15


def test_arms_may_be_as_deep_as_their_ends_have_them_and_else_keep_off():
    first, last, out = np.full(len(PAIRS), 0.02), np.full(len(PAIRS), -0.5), np.empty(len(PAIRS))
    let_be(first, last, 0.25, out)
    np.testing.assert_allclose(out, 0.02 - 0.25 * 0.03)


def test_a_swung_hand_keeps_near_its_line_where_nothing_is_in_the_way(round_the_head):
    """It goes round the head, not round the world."""
    wrist = joints_of(BODY, followed(ACROSS, BEHIND, round_the_head))[0][:, WRISTS[0]]
    assert distance_from_line(wrist, wrist[0], wrist[-1]).max() < 0.2
