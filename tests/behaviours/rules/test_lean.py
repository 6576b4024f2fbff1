"""Lean away, by what it does to a body: from the front back, from the left right, never beyond table 3.2."""

import math

import numpy as np
import pytest

from behaviours.rules.lean import lean_angles, lean_away
from behaviours.settings import LeanTurn
from engine.body.kinematics import joints_of
from engine.body.skeleton import HEAD, NECK, PELVIS, Pose
from engine.maths import quaternion
from tests.behaviours.people import BODY, standing

AHEAD, LEFT = (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0)  # travel of a threat from the front, from the left


def leaned(travel, lean=1.0, heading=0.0, weights=(1.0, 0.0), pose=None):
    pose = standing(heading_rad=heading) if pose is None else pose
    _, orientations = joints_of(BODY, pose)
    rotations = pose.rotations.copy()
    lean_away(rotations, orientations, heading, travel, lean, LeanTurn(), *weights, -1.0)
    return joints_of(BODY, Pose(pose.root_m, rotations))[0] - joints_of(BODY, pose)[0], rotations


def test_from_the_front_the_head_goes_back():
    moved, _ = leaned(AHEAD)
    assert moved[HEAD, 0] < -0.2
    assert abs(moved[HEAD, 1]) < 1e-12


def test_from_the_left_the_head_goes_right():
    moved, _ = leaned(LEFT)
    assert moved[HEAD, 1] < -0.2
    assert abs(moved[HEAD, 0]) < 1e-12


@pytest.mark.parametrize("heading", [0.7, -2.0, 3.1])
def test_it_leans_in_the_characters_own_heading(heading):
    moved, _ = leaned(AHEAD, heading=heading)
    back = -np.array([math.cos(heading), math.sin(heading)])
    assert moved[HEAD, :2] @ back == pytest.approx(np.hypot(*moved[HEAD, :2]))


def test_angles_are_those_of_the_table_scaled_by_the_control():
    for lean in (0.0, 0.3, 1.0):
        _, rotations = leaned(AHEAD, lean)
        for joint, degrees in zip(range(NECK + 1), (15, 10, 25, 50), strict=True):
            turned = 2 * math.atan2(np.hypot(*rotations[joint, 1:3]), rotations[joint, 0])
            assert math.degrees(turned) == pytest.approx(degrees * lean)


def test_a_slanting_threat_shares_its_direction():
    x, y = lean_angles((-0.6, -0.8, 0.0), (0.5, 0.4, 0.0), 1.0)
    assert (x, y) == pytest.approx((0.4, -0.24))


def test_a_threat_from_above_leans_nobody():
    moved, _ = leaned((0.0, 0.0, -1.0))
    assert np.abs(moved).max() == 0.0


def test_axes_are_the_headings_however_the_clip_has_the_joint():
    """A clip with a twisted back leans no less straight: clip-local axes would lean it aside."""
    pose = standing()
    pose.rotations[2] = quaternion.about_z(math.radians(40))
    moved, _ = leaned(AHEAD, pose=pose)
    assert abs(moved[HEAD, 1]) < 1e-12
    assert moved[HEAD, 0] < -0.2


def test_for_the_pelvis_the_pelvis_alone_leans_and_towards_the_threat():
    moved, rotations = leaned(AHEAD, weights=(0.0, 1.0))
    assert moved[HEAD, 0] > 0.1
    assert rotations[PELVIS, 2] > 0.0
    assert np.allclose(rotations[1:], standing().rotations[1:])
