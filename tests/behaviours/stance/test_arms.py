"""Arms: wrists on their targets, elbows out by their parameter, hanging arms that follow gravity, limits kept."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from behaviours.stance import arms
from behaviours.stance.measures import measures
from behaviours.stance.shape import shape
from behaviours.stance.solve import solve_shape
from engine.body.skeleton import BACK, ELBOWS, SHOULDERS, WRISTS
from engine.maths import quaternion

shares = st.floats(0.0, 1.0).map(lambda x: round(x, 6))


def elbow_out(result, side):
    """How far the elbow lies out from the line from shoulder to wrist, to its own side, metres."""
    s, e, w = (result.joints_m[j[side]] for j in (SHOULDERS, ELBOWS, WRISTS))
    n = (w - s) / np.linalg.norm(w - s)
    off = (e - s) - ((e - s) @ n) * n
    return off[1] * (1 - 2 * side)


@settings(max_examples=60)
@given(shares, shares, shares, st.integers(0, 1))
def test_a_comfortable_target_is_met_exactly(body, away, azimuth, elevation, side):
    standing = solve_shape(body, shape())
    turn, up = (azimuth - 0.2) * (1 - 2 * side), 1.6 * elevation - 0.9
    way = np.array([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)])
    target = standing.joints_m[SHOULDERS[side]] + way * (0.45 + 0.35 * away) * arms.arm_length_m(body, side)
    reach = (tuple(target), None) if side == 0 else (None, tuple(target))
    result = solve_shape(body, shape(), reach_m=reach)
    assert result.joints_m[WRISTS[side]] == pytest.approx(target, abs=1e-6)
    assert measures(body, result).limit_excess_rad < 1e-9


@pytest.mark.parametrize("side", [0, 1])
def test_the_swivel_takes_the_elbow_away_from_the_body(body, side):
    target = (0.35, 0.2 * (1 - 2 * side), 1.2)
    reach = (target, None) if side == 0 else (None, target)
    name = f"swivel_{('left', 'right')[side]}_rad"
    near, far = (solve_shape(body, shape(**{name: angle}), reach_m=reach) for angle in (-0.3, 0.6))
    assert elbow_out(far, side) > elbow_out(near, side) + 0.05


def test_elbow_and_lift_are_as_asked(body):
    plain = solve_shape(body, shape())
    lifted = solve_shape(body, shape(arm_out_left_rad=0.5, elbow_right_rad=0.6))
    bend = [2 * np.arctan2(-r.pose.rotations[ELBOWS[1], 2], r.pose.rotations[ELBOWS[1], 0]) for r in (plain, lifted)]
    assert bend[1] - bend[0] == pytest.approx(0.6)
    upper = [r.joints_m[ELBOWS[0]] - r.joints_m[SHOULDERS[0]] for r in (plain, lifted)]
    outward = [np.arctan2(u[1], -u[2]) for u in upper]
    assert outward[1] - outward[0] == pytest.approx(0.5, abs=0.02)


def test_a_bent_back_lets_the_arms_drop(body):
    """Bowed by 60 degrees, the arms hang down, not back along the trunk."""
    result = solve_shape(body, shape(sagittal_class="LargeC", sagittal=2.5, abdomen_x_rad=0.3))
    bow = np.degrees(np.arcsin(quaternion.rotate(result.orientations[BACK], (0, 0, 1))[0]))
    upper = result.joints_m[ELBOWS[0]] - result.joints_m[SHOULDERS[0]]
    off_plumb = np.degrees(np.arccos(-upper[2] / np.linalg.norm(upper)))
    assert bow > 45
    assert off_plumb < 20


@pytest.mark.parametrize("side", [0, 1])
def test_an_arm_lies_on_the_flank_that_leans_over_it_and_drops_off_the_other(body, side):
    """Leaning right (+), the left arm leans with the trunk and the right one hangs free of it."""
    lean = 1.0 if side == 0 else -1.0
    result = solve_shape(body, shape(coronal_class="LargeC", coronal=1.8 * lean))
    plumb = []
    for s in (side, 1 - side):
        upper = result.joints_m[ELBOWS[s]] - result.joints_m[SHOULDERS[s]]
        plumb.append(np.degrees(np.arctan2(upper[1] * (1 - 2 * s), -upper[2])))
    assert plumb[0] > plumb[1] + 10


def test_a_target_behind_the_back_is_reached_as_far_as_the_shoulder_goes(body):
    result = solve_shape(body, shape(), reach_m=((-0.45, 0.1, 1.7), None))
    found = measures(body, result)
    assert found.limit_excess_rad < 1e-9
    miss = np.linalg.norm(result.joints_m[WRISTS[0]] - (-0.45, 0.1, 1.7))
    assert result.wrist_error_m[0] == pytest.approx(miss, abs=1e-9)
