"""The elbow of a reaching arm: where it is wanted, out of the limits' way, and never jumping."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from behaviours.stance import arms, elbows
from behaviours.stance.shape import shape
from behaviours.stance.solve import solve_shape, solve_stance
from engine.body.skeleton import SHOULDERS
from engine.maths import quaternion


def arrays(result):
    return result.pose.rotations.copy(), result.joints_m.copy(), result.orientations.copy()


@pytest.mark.parametrize("side", [0, 1])
def test_zero_is_down_for_an_arm_ahead_and_never_turns_over_in_reach(body, side):
    """Over all directions but a cone straight back, a small turn of the arm turns the zero by a few times it."""
    orientations = np.tile(quaternion.IDENTITY, (21, 1))
    assert np.allclose(arms.elbow_zero(orientations, side, (1.0, 0.0, 0.0)), (0, 0, -1))
    rng, step = np.random.default_rng(2), 1e-3
    for _ in range(400):
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        if n[0] < -0.75:
            continue
        m = n + step * np.cross(n, rng.normal(size=3))
        m /= np.linalg.norm(m)
        zeros = [np.array(arms.elbow_zero(orientations, side, tuple(v))) for v in (n, m)]
        assert abs(zeros[0] @ n) < 1e-12
        assert np.linalg.norm(zeros[1] - zeros[0]) <= 4.5 * np.linalg.norm(m - n) + 1e-12


def test_an_easy_target_leaves_the_swivel_as_wanted(body):
    result = solve_shape(body, shape(swivel_right_rad=0.2), reach_m=(None, (0.4, -0.25, 1.2)))
    assert result.swivel_rad[1] == pytest.approx(0.2 + arms.NEUTRAL_SWIVEL)


def test_the_swivel_is_the_least_of_its_cost(body):
    """Against SciPy's bounded search over the same cost, for targets that crowd the shoulder."""
    standing, crowded = solve_shape(body, shape()), 0
    for back in np.linspace(0.5, 0.95, 9):
        target = standing.joints_m[SHOULDERS[0]] + 0.4 * np.array([0.4 - back, 0.3, 0.8])
        rotations, positions, orientations = arrays(standing)
        wanted = arms.NEUTRAL_SWIVEL
        _, taken, strain = elbows.reach_within_limits(
            body, rotations, positions, orientations, 0, target, wanted, wanted
        )

        def cost(swivel, target=target, wanted=wanted):
            r, p, o = arrays(standing)
            arms.reach(body, r, p, o, 0, target, swivel)
            return elbows.crowding(body, r, 0) + (swivel - wanted) ** 2

        best = minimize_scalar(cost, bounds=(wanted - 1.5, wanted + 1.5), method="bounded", options={"xatol": 1e-6})
        crowded += abs(taken - wanted) > 1e-3
        if strain == 0.0:
            assert cost(taken) <= best.fun + 1e-6
    assert crowded > 1


def test_no_joint_jumps_where_an_arm_meets_its_limits_at_a_graze(body, turned_deg):
    """Two hands up behind a back that bows: the nearest allowed swivel would leap by forty degrees here."""
    points = {
        "object_m": (0.289, -0.437, 0.857),
        "reach_left_m": (0.455, 0.383, 1.590),
        "reach_right_m": (0.248, -0.407, 1.663),
    }
    poses = [solve_stance(body, "straight-spine", a, **points).pose.rotations for a in np.linspace(0.85, 1.0, 16)]
    assert max(turned_deg(a, b).max() for a, b in pairwise(poses)) < 2.0


def test_a_target_in_the_armpit_is_drawn_back_from(body):
    """An arm is not folded to its end where the torso can make room."""
    plain = solve_shape(body, shape())
    target = plain.joints_m[SHOULDERS[1]] + (0.05, -0.05, -0.02)
    result = solve_stance(body, "reach", 1.0, reach_right_m=tuple(target))
    away = np.linalg.norm(result.joints_m[SHOULDERS[1]] - target)
    assert away > 2.0 * np.linalg.norm(plain.joints_m[SHOULDERS[1]] - target)
    assert result.wrist_error_m[1] < 1e-3
