"""What of a body is inside itself, against points along its capsules."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.anthropometry import standard_body
from engine.body.capsules import body_capsules, capsules_at
from engine.body.kinematics import joints_of
from engine.body.overlap import PAIRS, overlaps_m, pair_name
from engine.body.skeleton import JOINT_COUNT, Pose


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
