"""Legs that an old motion would carry straight: slowed down before, from a seam on that is continuous."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from behaviours.blends.held_feet import LEG_SPARE_M, kept_bent, lengths_left
from engine.body.skeleton import ANKLES, KNEES
from tests.behaviours.people import BODY

FULL_M = float(np.linalg.norm(BODY.offset_m[KNEES[0]]) + np.linalg.norm(BODY.offset_m[ANKLES[0]]))
HALF_LIFE_S = 0.07
shorts_m, speeds_mps = st.floats(0.0005, 0.04), st.floats(-1.5, 1.5)


def left_m(source_short_m, shown_short_m, mps, elapsed_s) -> float:
    """The left leg's length in a source that is still; both short of a straight leg by so much."""
    stretch = np.array([[source_short_m - shown_short_m] * 2, [mps] * 2])
    source_m = (FULL_M - source_short_m, FULL_M - source_short_m)
    return lengths_left(BODY, source_m, stretch, elapsed_s, HALF_LIFE_S)[0]


@given(shorts_m, shorts_m, speeds_mps, st.floats(0.0, 0.5))
def test_no_old_motion_carries_a_leg_straighter_than_it_was_or_may_be(source_m, shown_m, mps, elapsed_s):
    least_m = 0.5 * min(source_m, shown_m, LEG_SPARE_M)
    assert FULL_M - left_m(source_m, shown_m, mps, elapsed_s) >= least_m - 1e-12


@given(shorts_m, shorts_m, speeds_mps)
def test_a_seam_keeps_the_length_and_its_velocity(source_m, shown_m, mps):
    assert FULL_M - left_m(source_m, shown_m, mps, 0.0) == pytest.approx(shown_m, abs=1e-12)
    moment_s = 1e-7
    change_m = left_m(source_m, shown_m, mps, moment_s) - left_m(source_m, shown_m, mps, 0.0)
    assert change_m / moment_s == pytest.approx(mps, abs=2e-3)


@given(shorts_m, shorts_m, speeds_mps)
def test_nothing_is_left_of_it_in_the_end(source_m, shown_m, mps):
    assert FULL_M - left_m(source_m, shown_m, mps, 3.0) == pytest.approx(source_m, abs=1e-6)


def test_a_leg_that_is_to_stand_is_never_dead_straight():
    """A bent leg keeps its length to the bit; a straight one gives up LEG_SPARE_M of it."""
    full_m = np.linalg.norm(BODY.offset_m[list(KNEES)], axis=1) + np.linalg.norm(BODY.offset_m[list(ANKLES)], axis=1)
    assert kept_bent(BODY, (0.7, full_m[1])) == (0.7, pytest.approx(full_m[1] - LEG_SPARE_M, abs=1e-12))
