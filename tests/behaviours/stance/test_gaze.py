"""Gaze: full weight looks there, none leaves the head alone, limits and what is behind are respected."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from behaviours.stance import gaze
from behaviours.stance.measures import measures
from behaviours.stance.shape import shape
from behaviours.stance.solve import solve_shape
from engine.body.skeleton import HEAD
from engine.maths import quaternion

yaws = st.floats(-1.2, 1.2).map(lambda x: round(x, 6))
pitches = st.floats(-0.5, 0.4).map(lambda x: round(x, 6))


def looking(body, yaw, pitch, weight, **numbers):
    eyes = np.array([0.1, 0.0, 1.66])
    target = eyes + 2.0 * np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])
    return solve_shape(body, shape(gaze=weight, **numbers), look_at_m=tuple(target))


@settings(max_examples=60)
@given(yaws, pitches)
def test_full_weight_looks_at_the_point(body, yaw, pitch):
    found = measures(body, looking(body, yaw, pitch, 1.0))
    assert np.degrees(found.gaze_error_rad) < 1.0
    assert found.limit_excess_rad < 1e-9


def test_no_weight_leaves_the_head_alone(body):
    assert np.array_equal(looking(body, 1.0, 0.2, 0.0).pose.rotations, solve_shape(body, shape()).pose.rotations)


@given(yaws, st.floats(0.1, 0.9).map(lambda x: round(x, 6)))
@settings(max_examples=40)
def test_the_weight_is_the_share_of_the_way(body, yaw, weight):
    ways = [quaternion.rotate(looking(body, yaw, 0.0, w).orientations[HEAD], (1, 0, 0)) for w in (0.0, weight, 1.0)]
    rest, part, full = (np.arctan2(way[1], way[0]) for way in ways)
    assert part - rest == pytest.approx(weight * (full - rest), abs=0.02)


def test_a_turned_head_keeps_its_eyes_level(body):
    """People turn and nod; a shortest turn to something low at the side would tilt the head."""
    result = looking(body, 0.9, -0.4, 1.0)
    left = quaternion.rotate(result.orientations[HEAD], (0, 1, 0))
    assert abs(np.degrees(np.arcsin(left[2]))) < 3


def test_what_is_straight_behind_turns_the_head_neither_way(body):
    result = looking(body, np.pi, 0.0, 1.0)
    face = quaternion.rotate(result.orientations[HEAD], (1, 0, 0))
    assert abs(np.degrees(np.arctan2(face[1], face[0]))) < 5


def test_walking_round_behind_never_jerks_the_head(body, turned_deg):
    poses = [looking(body, yaw, 0.0, 1.0).pose.rotations for yaw in np.linspace(0.0, 2 * np.pi, 181)]
    assert max(turned_deg(a, b).max() for a, b in pairwise(poses)) < 12


def test_beyond_the_neck_it_turns_as_far_as_it_goes_and_says_by_how_much_it_fails(body):
    result = looking(body, 2.1, 0.0, 1.0)
    found = measures(body, result)
    assert found.limit_excess_rad < 1e-9
    eyes = np.array(gaze.eyes_m(body, result.joints_m, result.orientations))
    line = result.plan.look_at_m - eyes
    face = np.array(quaternion.rotate(result.orientations[HEAD], (1, 0, 0)))
    error = np.arccos(face @ line / np.linalg.norm(line))
    assert found.gaze_error_rad == pytest.approx(error, abs=1e-6)
    assert np.degrees(error) > 5
