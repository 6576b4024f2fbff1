"""Stances whole: other bodies, other feet, limits of the legs, the same bits again."""

import numpy as np
import pytest

from behaviours.stance import footprints
from behaviours.stance.measures import measures
from behaviours.stance.shape import shape
from behaviours.stance.solve import solve_shape, solve_stance
from engine.body.anthropometry import standard_body
from engine.body.skeleton import ANKLES, MIRRORED
from engine.core.errors import BadInput


@pytest.mark.parametrize("someone", [(1.55, "female"), (1.92, "male"), (1.2, "male")])
@pytest.mark.parametrize("name", ["posture", "beauty-line", "recoil-strong", "reach-eager"])
def test_any_body_stands_on_its_feet(someone, name):
    height, sex = someone
    body = standard_body(height, sex=sex)
    scale = height / 1.75
    points = {
        "object_m": (1.2 * scale, 0.4 * scale, 1.2 * scale),
        "reach_right_m": (0.45 * scale, -0.2 * scale, 1.2 * scale),
    }
    result = solve_stance(body, name, 0.9, **points)
    found = measures(body, result)
    assert found.foot_error_m.max() < 1e-7
    assert found.balance_error_m < 1e-4
    assert found.limit_excess_rad < 1e-9
    assert found.wrist_error_m.max() < 1e-3


def test_a_turned_and_shifted_stance_is_the_same_stance(body):
    """Feet and object turned together about the vertical: so is the pose."""
    turn, shift = 1.1, np.array([3.0, -2.0, 0.0])
    c, s = np.cos(turn), np.sin(turn)
    world = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
    place = np.array([1.0, 0.4, 1.2])
    here = solve_stance(body, "recoil-strong", 0.8, object_m=place)
    feet = footprints.stand(body, heading_rad=turn, place_m=shift[:2])
    there = solve_stance(body, "recoil-strong", 0.8, object_m=world @ place + shift, feet=feet)
    assert there.joints_m == pytest.approx(here.joints_m @ world.T + shift, abs=1e-6)


def test_the_same_bits_again(body):
    points = {"object_m": (1.0, 0.2, 1.1), "reach_left_m": (0.6, 0.3, 1.2)}
    a, b = (solve_stance(body, "recoil-mild", 0.77, **points) for _ in range(2))
    assert a.pose.rotations.tobytes() == b.pose.rotations.tobytes()
    assert a.pose.root_m.tobytes() == b.pose.root_m.tobytes()


def test_the_mirrored_reach(body):
    target = np.array((0.6, 0.25, 1.1))
    left = solve_stance(body, "reach", 1.0, reach_left_m=target)
    right = solve_stance(body, "reach", 1.0, reach_right_m=target * [1, -1, 1])
    assert left.joints_m == pytest.approx(right.joints_m[MIRRORED] * [1, -1, 1], abs=2e-3)


def test_legs_keep_their_limits_by_taking_less_of_the_wish(body):
    """A crouch with a twist that no hip allows: as much of it as they do, reported."""
    result = solve_shape(
        body, shape(knee_left_rad=1.9, knee_right_rad=0.1, pelvis_y_rad=0.7, balance_x=1.2, balance_z=1.0)
    )
    found = measures(body, result)
    assert 0.0 < result.kept < 1.0
    assert found.limit_excess_rad < 1e-9
    assert found.foot_error_m.max() < 1e-7


def test_stance_width_is_a_number_of_the_shape(body):
    narrow, wide = (solve_shape(body, shape(width_m=w)).joints_m[list(ANKLES), 1] for w in (-0.1, 0.4))
    assert wide[0] - wide[1] == pytest.approx(narrow[0] - narrow[1] + 0.5)


@pytest.mark.parametrize("bad", [{"object_m": (1, 2)}, {"reach_left_m": (1, 2, float("inf"))}])
def test_bad_points_are_refused(body, bad):
    with pytest.raises(BadInput, match="expected three finite numbers"):
        solve_stance(body, "posture", 0.5, **bad)


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_bad_intensity_is_refused(body, bad):
    with pytest.raises(BadInput, match="finite"):
        solve_stance(body, "posture", bad)
