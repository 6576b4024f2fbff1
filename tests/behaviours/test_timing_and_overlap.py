"""The clocks of the blends, and what of a body is inside itself, against closed forms and brute force."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.overlap import PAIRS, overlaps_m, pair_name
from behaviours.settings import Settings
from behaviours.timing import ease, overshoot, time_to_contact_s
from engine.body.anthropometry import standard_body
from engine.body.capsules import body_capsules, capsules_at
from engine.body.kinematics import joints_of
from engine.body.skeleton import JOINT_COUNT, Pose
from engine.maths.shapes import nearest_between


@pytest.mark.parametrize(
    ("speed", "facing", "wanted_s"), [(1, 1, 0.25), (0, 1, 1.0), (1, 0, 0.30), (0, -1, 1.4), (0.5, 1, 0.625)]
)
def test_time_to_contact_is_eq_4_1(speed, facing, wanted_s):
    assert time_to_contact_s(speed, facing, Settings().timing) == pytest.approx(wanted_s)


def test_the_text_says_the_opposite_of_the_equation():
    text = Settings().timing._replace(ttc_model="text")
    assert time_to_contact_s(1.0, 1.0, text) == pytest.approx(1.0)
    assert time_to_contact_s(0.0, -1.0, text) == pytest.approx(0.25 * 1.2)


def test_ease_and_overshoot_meet_without_a_kink():
    h = 1e-6
    assert ease(1.0) == 1.0
    assert (1.0 - ease(1.0 - h)) / h < 1e-4
    assert overshoot(0.0, 0.06, 0.5, 0.12) == 0.0
    assert overshoot(h, 0.06, 0.5, 0.12) / h < 1e-4
    swings = np.array([overshoot(t, 0.06, 0.5, 0.12) for t in np.linspace(0, 2, 400)])
    assert 0.02 < swings.max() <= 0.06
    assert swings.min() < 0.0
    assert abs(swings[-1]) < 1e-5


def test_nearest_places_of_two_segments_against_a_fine_grid():
    chance, grid = np.random.default_rng(3), np.linspace(0, 1, 201)
    for _ in range(60):
        a, b, c, d = chance.normal(size=(4, 3))
        s, t = nearest_between(a, b, c, d)
        found = np.linalg.norm(a + s * (b - a) - c - t * (d - c))
        p, q = a + grid[:, None] * (b - a), c + grid[:, None] * (d - c)
        least = np.linalg.norm(p[:, None] - q[None], axis=2).min()
        assert 0 <= s <= 1
        assert 0 <= t <= 1
        assert least - 0.02 < found <= least + 1e-9


def test_overlaps_of_a_body_against_points_along_its_capsules():
    body, chance, grid = standard_body(), np.random.default_rng(5), np.linspace(0, 1, 101)
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (3, JOINT_COUNT, 1)) + 0.4 * chance.normal(size=(3, JOINT_COUNT, 4))
    rotations /= np.linalg.norm(rotations, axis=-1, keepdims=True)
    pose, capsules = Pose(np.zeros((3, 3)), rotations), body_capsules(body)
    depths = overlaps_m(body, pose)
    for k in range(3):
        ends = capsules_at(capsules, *joints_of(body, Pose(pose.root_m[k], rotations[k])))
        for n, (a, b) in enumerate(PAIRS):
            p, q = (ends[c, 0] + grid[:, None] * (ends[c, 1] - ends[c, 0]) for c in (a, b))
            apart = np.linalg.norm(p[:, None] - q[None], axis=2).min()
            wanted = capsules.radius_m[a] + capsules.radius_m[b] - apart
            assert depths[k, n] == pytest.approx(wanted, abs=5e-4), pair_name(n)
