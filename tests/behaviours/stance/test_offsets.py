"""What a stance adds to a pose: turns against neutral, nothing where nothing is asked."""

import numpy as np
import pytest

from behaviours.stance import shape_sets
from behaviours.stance.around import Around
from behaviours.stance.offsets import COLOURED, offsets_of
from behaviours.stance.shape import shape
from behaviours.stance.solve import solve_shape
from engine.body.skeleton import HIPS, JOINT_COUNT
from engine.maths import rotations


def test_the_neutral_stance_adds_nothing(body):
    offsets = offsets_of(body, shape())
    assert offsets.rotations == pytest.approx(np.tile([1.0, 0, 0, 0], (JOINT_COUNT, 1)), abs=1e-9)
    assert offsets.pelvis_drop_m == pytest.approx(0.0, abs=1e-9)
    assert offsets.knee_rad == pytest.approx([0, 0], abs=1e-9)


def test_under_the_neutral_pose_it_is_the_stance(body):
    coloured = shape_sets.shape_of("posture", -0.8, Around())
    neutral, stance = solve_shape(body, shape()), solve_shape(body, coloured)
    offsets = offsets_of(body, coloured)
    q = rotations.multiply(neutral.pose.rotations, offsets.rotations)
    assert q[COLOURED] == pytest.approx(stance.pose.rotations[COLOURED], abs=1e-9)
    assert np.array_equal(q[list(HIPS)], neutral.pose.rotations[list(HIPS)])
    assert offsets.pelvis_drop_m == pytest.approx(neutral.pose.root_m[2] - stance.pose.root_m[2], abs=1e-9)
    assert offsets.knee_rad == pytest.approx([coloured.numbers.knee_left_rad] * 2, abs=1e-6)
