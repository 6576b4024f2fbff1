"""A stance under a clip's pose: turns against neutral, limits with the clip's own excess, nothing where nothing is
asked.
"""

import numpy as np
import pytest

from behaviours.stance import shape_sets
from behaviours.stance.around import Around
from behaviours.stance.offsets import COLOURED, offsets_of, put_under
from behaviours.stance.shape import shape
from behaviours.stance.solve import solve_shape
from engine.body.limits import excess_beyond_rad
from engine.body.skeleton import HIPS, JOINT_COUNT, PELVIS
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
    q = put_under(body, neutral.pose.rotations, offsets.rotations)
    assert q[COLOURED] == pytest.approx(stance.pose.rotations[COLOURED], abs=1e-9)
    assert np.array_equal(q[list(HIPS)], neutral.pose.rotations[list(HIPS)])
    assert offsets.pelvis_drop_m == pytest.approx(neutral.pose.root_m[2] - stance.pose.root_m[2], abs=1e-9)
    assert offsets.knee_rad == pytest.approx([coloured.numbers.knee_left_rad] * 2, abs=1e-6)


def test_a_share_of_it(body):
    offsets = offsets_of(body, shape_sets.shape_of("slovenly", 1.0, Around()))
    clip = solve_shape(body, shape(transverse_rad=0.3)).pose.rotations
    none, part, full = (put_under(body, clip, offsets.rotations, w) for w in (0.0, 0.5, 1.0))
    assert none == pytest.approx(clip, abs=1e-12)
    for j in COLOURED:
        whole = rotations.multiply(rotations.conjugate(clip[j]), full[j])
        half = rotations.multiply(rotations.conjugate(clip[j]), part[j])
        assert 2 * np.arccos(np.clip(half[0], -1, 1)) == pytest.approx(np.arccos(np.clip(whole[0], -1, 1)), abs=1e-6)


def test_limits_are_kept_beyond_the_clips_own_excess(body):
    """A clip that bows to the limit already, under a hunched stance."""
    clip = solve_shape(body, shape(sagittal_class="LargeC", sagittal=2.6)).pose.rotations
    offsets = offsets_of(body, shape_sets.shape_of("posture", -1.0, Around()))
    excess = excess_beyond_rad(body, put_under(body, clip, offsets.rotations), clip)
    excess[PELVIS] = 0.0
    assert excess.max() < 1e-6
