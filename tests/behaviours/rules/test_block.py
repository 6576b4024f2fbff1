"""Where palms go: on the line, at their reach, the nearer of two points, clear of the target, each to its own side."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from behaviours.rules.block import distance_on_line, hand_facing, palm_target, reach_m, smooth_max, swivel_rad
from engine.maths import quaternion

TANGENT = (-1.0, 0.0, 0.0)  # straight from the front
LEFTWARD = (0.0, 1.0, 0.0)


def palm(side=0, shoulder=(0.0, 0.2, 1.4), reach=0.5, target=(0.0, 0.0, 1.5), line=(0.0, 0.0, 1.5),
         torso=(1.0, 0.0, 0.0), clearance=0.2, offset=0.08):  # fmt: skip
    return np.array(palm_target(side, shoulder, reach, target, line, TANGENT, LEFTWARD, torso, clearance, offset, 0.02))


def test_far_reach_is_limited_by_the_arm_before_it_is_interpolated():
    assert reach_m(0.0, 0.9, 0.3, 0.58, 0.97) == pytest.approx(0.5626)
    assert reach_m(1.0, 0.9, 0.3, 0.58, 0.97) == pytest.approx(0.3)
    assert reach_m(0.5, 0.9, 0.3, 0.58, 0.97) == pytest.approx(0.5 * (0.5626 + 0.3))
    assert reach_m(0.0, 0.9, 0.3, 2.0, 0.97) == pytest.approx(0.9)


def test_an_arm_shorter_than_the_near_reach_never_reaches_farther_for_a_larger_threat():
    assert reach_m(1.0, 0.9, 0.3, 0.2, 0.97) <= reach_m(0.0, 0.9, 0.3, 0.2, 0.97)


def test_at_its_reach_the_point_nearer_the_threat():
    shoulder, line = np.array([0.0, 0.2, 1.4]), np.array([0.0, 0.0, 1.5])
    before = distance_on_line(tuple(shoulder), tuple(line), TANGENT, 0.5)
    assert before > 0.0  # ahead of the shoulder, not behind it
    assert np.linalg.norm(line + [before, 0, 0] - shoulder) == pytest.approx(0.5, abs=1e-4)


def test_a_line_out_of_reach_is_met_at_its_nearest_point():
    before = distance_on_line((0.3, 0.9, 1.5), (0.0, 0.0, 1.5), TANGENT, 0.5)
    assert before == pytest.approx(0.3, abs=5e-3)


def test_the_hand_on_the_threats_side_is_nearer_to_it():
    tangent = (-math.cos(0.7), -math.sin(0.7), 0.0)  # from the left
    left, right = (distance_on_line((0.0, y, 1.4), (0.0, 0.0, 1.5), tangent, 0.5) for y in (0.2, -0.2))
    assert left > right


def test_clearance_overrides_the_reach():
    assert palm(reach=0.25, shoulder=(-0.1, 0.1, 1.45))[0] >= 0.2 - 1e-9
    assert palm(reach=0.25, shoulder=(-0.1, 0.1, 1.45), clearance=0.35)[0] >= 0.35 - 1e-9


def test_clearance_is_from_where_the_target_is_now():
    assert palm(reach=0.3, target=(0.15, 0.0, 1.5))[0] >= 0.35 - 1e-9


def test_each_palm_to_its_own_side():
    assert palm(0)[1] == pytest.approx(0.08)
    assert palm(1, shoulder=(0.0, -0.2, 1.4))[1] == pytest.approx(-0.08)


def test_no_palm_behind_its_shoulder_plane():
    aside = palm(reach=0.3, torso=(0.0, -1.0, 0.0), shoulder=(0.0, -0.2, 1.4))
    assert aside[1] <= -0.2 + 1e-9


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("azimuth", [0.0, 0.8, -2.1])
def test_palm_faces_the_threat_fingers_up(side, azimuth):
    normal, up = (math.cos(azimuth), math.sin(azimuth), 0.0), (0.0, 0.0, 1.0)
    hand = hand_facing(side, normal, up)
    palm_normal = (0.0, -1.0, 0.0) if side == 0 else (0.0, 1.0, 0.0)  # of a hanging hand
    assert quaternion.rotate(hand, palm_normal) == pytest.approx(normal, abs=1e-12)
    assert quaternion.rotate(hand, (0.0, 0.0, -1.0)) == pytest.approx(up, abs=1e-12)


def test_swivel_runs_from_seventy_to_ten_degrees():
    small, large = math.radians(70), math.radians(10)
    assert [math.degrees(swivel_rad(c, small, large)) for c in (0.0, 0.5, 1.0)] == pytest.approx([70, 40, 10])


@given(st.floats(-3, 3), st.floats(-3, 3), st.floats(1e-3, 1.0))
def test_smooth_max_is_never_below_and_exact_away_from_the_seam(a, b, width):
    value = smooth_max(a, b, width)
    assert max(a, b) - 1e-12 <= value <= max(a, b) + width / 4 + 1e-12
    if abs(a - b) >= width:
        assert value == max(a, b)
