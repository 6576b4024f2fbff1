"""The capsules: as heavy as a person, in the place of a person, mirrored, and standing on the floor."""

import math

import numpy as np
import pytest

from engine.body import kinematics
from engine.body.anthropometry import standard_body
from engine.body.capsules import CAPSULES, FLESH_KGPM3, body_capsules, capsules_at
from engine.body.skeleton import JOINT_COUNT, MIRRORED
from tests.body.poses import identity_pose


@pytest.mark.parametrize("sex", ["male", "female"])
def test_they_hold_about_a_body_and_every_joint_has_one(sex):
    body = standard_body(1.7, sex)
    shapes = body_capsules(body)
    assert len(shapes.joint) == len(CAPSULES)
    assert set(shapes.joint) == set(range(JOINT_COUNT))
    lengths = np.linalg.norm(shapes.end_m - shapes.start_m, axis=1)
    volume = (math.pi * shapes.radius_m**2 * (lengths + 4 / 3 * shapes.radius_m)).sum()
    # capsules of one body overlap at every joint, so they hold more than it weighs
    assert 0.9 < volume * FLESH_KGPM3 / body.part_mass_kg.sum() < 1.6


def test_they_reach_from_sole_to_crown_and_are_their_own_mirror():
    body = standard_body()
    shapes = body_capsules(body)
    positions, orientations = kinematics.joints_of(body, identity_pose(0.0))
    ends = capsules_at(shapes, positions, orientations)
    top = (ends[..., 2] + shapes.radius_m[:, None]).max()
    bottom = (ends[..., 2] - shapes.radius_m[:, None]).min()
    assert top - bottom == pytest.approx(1.75, abs=0.01)
    other = [CAPSULES.index(_other_side(name)) for name in CAPSULES]
    np.testing.assert_array_equal(MIRRORED[shapes.joint], shapes.joint[other])
    np.testing.assert_allclose(shapes.radius_m[other], shapes.radius_m)
    middle = ends.mean(axis=1)
    np.testing.assert_allclose(middle[other] * [1, -1, 1], middle, atol=1e-12)
    # hands beside the thighs, not in them; thighs apart from each other at the knee
    hand, thigh = CAPSULES.index("left_hand"), CAPSULES.index("left_thigh")
    assert ends[hand, 0, 1] - shapes.radius_m[hand] > ends[thigh, 0, 1] + 0.0


def _other_side(name):
    if name.startswith("left_"):
        return "right_" + name.removeprefix("left_")
    return "left_" + name.removeprefix("right_") if name.startswith("right_") else name
