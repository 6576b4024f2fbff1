"""Turn away: sides, angles and shares. The limits mean that the goal is often not reached, so the goal is not what is
tested.
"""

import math

import numpy as np
import pytest

from behaviours.rules.turn import turn_angles, turn_away, turn_side, wanted_turn
from behaviours.settings import LeanTurn
from engine.body.kinematics import joints_of
from engine.body.skeleton import HEAD, Pose
from engine.maths import quaternion
from tests.behaviours.people import BODY, standing

BAND = math.radians(2)


def travel(azimuth_deg):
    a = math.radians(azimuth_deg)
    return (-math.cos(a), -math.sin(a), 0.0)


@pytest.mark.parametrize(("azimuth", "side"), [(30, -1), (150, -1), (-30, 1), (-150, 1), (3, -1), (-3, 1)])
def test_from_the_left_it_turns_right(azimuth, side):
    assert turn_side(travel(azimuth), BAND, -side) == side


@pytest.mark.parametrize("azimuth", [0.0, 1.5, -1.5])
def test_dead_ahead_keeps_the_side_last_chosen_else_right(azimuth):
    assert [turn_side(travel(azimuth), BAND, before) for before in (1.0, -1.0, 0.0)] == [1.0, -1.0, -1.0]


def test_a_waving_threat_dead_ahead_does_not_flicker():
    side, sides = 1.0, []
    for k in range(50):
        side = turn_side(travel(1.9 * math.sin(k)), BAND, side)
        sides.append(side)
    assert set(sides) == {1.0}


@pytest.mark.parametrize("azimuth", [10, 60, 120, 170, -10, -60, -120, -170])
@pytest.mark.parametrize("head_deg", [0, 25, -25])
def test_the_wanted_turn_brings_the_back_of_the_head_to_the_threat(azimuth, head_deg):
    side = turn_side(travel(azimuth), BAND, 0.0)
    face = math.radians(head_deg) + wanted_turn(math.radians(head_deg), travel(azimuth), side)
    assert math.cos(face) == pytest.approx(-math.cos(math.radians(azimuth)), abs=1e-9)
    assert math.sin(face) == pytest.approx(-math.sin(math.radians(azimuth)), abs=1e-9)


def test_it_goes_round_by_its_side_even_when_that_is_the_longer_way():
    # from 10 degrees left, the face 30 degrees left already: still to the right
    assert math.degrees(wanted_turn(math.radians(30), travel(10), -1.0)) == pytest.approx(-200)


def test_nothing_jumps_behind_the_back():
    left, right = (wanted_turn(0.1, travel(a), s) for a, s in ((179.99, -1.0), (-179.99, 1.0)))
    assert left == pytest.approx(right, abs=1e-3)


def test_neck_first_then_half_a_third_a_fifth_of_what_is_left():
    pelvis, waist, back, neck = (math.degrees(a) for a in turn_angles(math.radians(79), 1.0, LeanTurn()))
    assert (neck, back, waist, pelvis) == pytest.approx((65, 7.0, 4.2, 2.8))


def test_no_joint_beyond_its_greatest_and_all_scaled_by_the_control():
    full = np.degrees(turn_angles(math.radians(-180), 1.0, LeanTurn()))
    assert full == pytest.approx([-20, -12, -8, -65])
    assert np.degrees(turn_angles(math.radians(-180), 0.4, LeanTurn())) == pytest.approx(0.4 * full)


def test_a_small_turn_is_the_necks_alone():
    assert np.degrees(turn_angles(math.radians(40), 1.0, LeanTurn())) == pytest.approx([0, 0, 0, 40])


def test_the_head_really_turns():
    pose = standing()
    rotations = pose.rotations.copy()
    turn_away(rotations, math.radians(-180), 1.0, LeanTurn())
    _, orientations = joints_of(BODY, Pose(pose.root_m, rotations))
    assert math.degrees(quaternion.heading(orientations[HEAD])) == pytest.approx(-105)
