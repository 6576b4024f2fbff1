"""The paper's frame in the project's: meanings of the signs, and nothing lost on the way."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from behaviours.stance import frame
from engine.maths import quaternion

UP, AHEAD, LEFT = (0, 0, 1), (1, 0, 0), (0, 1, 0)


def test_plus_x_bends_forward_plus_z_to_the_right_plus_y_turns_left():
    assert quaternion.rotate(frame.rotation(0.3, 0.0, 0.0), UP) == pytest.approx((np.sin(0.3), 0, np.cos(0.3)))
    assert quaternion.rotate(frame.rotation(0.0, 0.0, 0.3), UP) == pytest.approx((0, -np.sin(0.3), np.cos(0.3)))
    assert quaternion.rotate(frame.rotation(0.0, 0.3, 0.0), AHEAD) == pytest.approx((np.cos(0.3), np.sin(0.3), 0))


def test_axes_go_over_and_stay_right_handed():
    x, y, z = (np.array(frame.point(axis)) for axis in np.eye(3))
    assert (tuple(x), tuple(y), tuple(z)) == (LEFT, UP, AHEAD)
    assert np.cross(x, y) == pytest.approx(z)


@given(*[st.floats(-1.2, 1.2).map(lambda x: round(x, 6))] * 3)
def test_angles_come_back(x, y, z):
    assert frame.angles(frame.rotation(x, y, z)) == pytest.approx((x, y, z), abs=1e-9)


@given(st.floats(-1.0, 1.0).map(lambda x: round(x, 6)), st.sampled_from("xyz"))
def test_one_angle_is_the_turn_about_the_axis_that_it_becomes(angle, axis):
    """The turn of a point about a paper axis, worked out in the paper's frame, carried over."""
    k = "xyz".index(axis)
    vector = np.array([0.3, -0.2, 0.9])
    e = np.eye(3)[k]
    turned = vector * np.cos(angle) + np.cross(e, vector) * np.sin(angle) + e * (e @ vector) * (1 - np.cos(angle))
    q = frame.rotation(*(angle if i == k else 0.0 for i in range(3)))
    assert quaternion.rotate(q, frame.point(vector)) == pytest.approx(frame.point(turned), abs=1e-12)
