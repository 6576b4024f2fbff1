"""State sets and shape vectors: zeros are neutral, and what section 6 does with vectors."""

import numpy as np
import pytest

from behaviours.stance.shape import ALLOWED, RANGES, Numbers, changed, mirrored, mix, shape, varied, wind_up
from behaviours.stance.solve import solve_shape
from engine.body.skeleton import ELBOWS, HEAD, KNEES, MIRRORED, WRISTS
from engine.core.errors import BadInput
from engine.core.random import Stream


@pytest.mark.parametrize("sagittal", ALLOWED["sagittal_class"])
@pytest.mark.parametrize("collars", ALLOWED["collar_y"])
def test_zeros_are_neutral_for_any_state_set(body, sagittal, collars):
    neutral = solve_shape(body, shape())
    result = solve_shape(
        body, shape(sagittal_class=sagittal, coronal_class=sagittal, collar_y=collars, collar_z=collars)
    )
    assert result.joints_m == pytest.approx(neutral.joints_m, abs=1e-9)


def test_neutral_is_somebody_standing_at_ease(body):
    result = solve_shape(body, shape())
    flipped = result.joints_m[MIRRORED] * [1, -1, 1]
    assert result.joints_m == pytest.approx(flipped, abs=1e-6)
    assert 0.95 * 1.75 < result.joints_m[HEAD, 2] + body.head_top_m[2] < 1.75
    assert result.joints_m[list(WRISTS), 2].max() < result.joints_m[0, 2]  # arms at the sides


def test_every_number_has_a_range_and_a_meaning():
    assert tuple(RANGES) == Numbers._fields
    assert all(r.low <= 0.0 <= r.high and r.low < r.high and r.meaning for r in RANGES.values())


@pytest.mark.parametrize(
    "bad", [{"sagital": 1.0}, {"sagittal_class": "LargeX"}, {"sagittal": float("nan")}, {"wishes": {"x": None}}]
)
def test_bad_shapes_are_refused_by_name(bad):
    with pytest.raises(BadInput) as trouble:
        shape(**bad)
    assert next(iter(bad))[:4] in trouble.value.line()


def test_mixing_goes_between_and_beyond():
    a, b = shape(sagittal=1.0), shape(sagittal_class="LargeC", sagittal=3.0, knee_left_rad=0.4)
    assert mix(a, b, 0.25).numbers.sagittal == pytest.approx(1.5)
    assert mix(a, b, 1.5).numbers.knee_left_rad == pytest.approx(0.6)
    assert mix(a, b, 0.0).states == a.states
    assert mix(a, b, 0.5).states == b.states


def test_varied_is_consistent_and_never_identical(body):
    chance = Stream(3, "stance", {})
    base = shape(sagittal_class="LargeC", sagittal=1.5, knee_left_rad=0.3)
    shapes = [varied(base, chance, 0.03) for _ in range(20)]
    assert len({s.numbers for s in shapes}) == 20
    assert all(s.states == base.states for s in shapes)
    vectors = np.array([s.numbers for s in shapes])
    assert np.abs(vectors.mean(axis=0) - np.array(base.numbers)).max() < 0.2
    assert all(RANGES[n].low <= v <= RANGES[n].high for s in shapes for n, v in s.numbers._asdict().items())
    joints = np.array([solve_shape(body, s).joints_m for s in shapes])
    assert 0.002 < joints.std(axis=0).max() < 0.2


def test_a_wind_up_goes_the_other_way(body):
    base = shape(sagittal_class="LargeC", sagittal=2.0, balance_z=0.4, knee_left_rad=0.5)
    back = wind_up(base, 0.3)
    assert back.numbers.sagittal == pytest.approx(-0.6)
    assert back.numbers.knee_left_rad == 0.0  # knees do not bend backwards
    there, neutral, away = (solve_shape(body, s).joints_m[HEAD, 0] for s in (base, shape(), back))
    assert (there - neutral) * (away - neutral) < 0.0


def test_a_mirrored_shape_is_the_mirrored_pose(body):
    base = shape(
        sagittal_class="SmallC", coronal_class="LargeS", collar_y="opposed", dominant="right", sagittal=0.8,
        coronal=1.4, transverse_rad=0.3, collar_y_rad=0.2, collar_z_rad=0.1, balance_x=-0.4, knee_left_rad=0.5,
        pelvis_y_rad=0.2,
        arm_out_left_rad=0.3, elbow_right_rad=0.5, arm_turn_left_rad=0.2,
    )  # fmt: skip
    ours, theirs = solve_shape(body, base), solve_shape(body, mirrored(base))
    assert ours.joints_m == pytest.approx(theirs.joints_m[MIRRORED] * [1, -1, 1], abs=1e-6)
    assert mirrored(mirrored(base)) == base


def test_changed_replaces_and_keeps(body):
    base = shape(sagittal=1.0, knee_left_rad=0.3)
    assert changed(base, sagittal=2.0).numbers == shape(sagittal=2.0, knee_left_rad=0.3).numbers
    bent = solve_shape(body, changed(base, knee_right_rad=0.8)).pose.rotations
    assert 2 * np.arctan2(bent[KNEES[1], 2], bent[KNEES[1], 0]) == pytest.approx(0.8 + np.radians(4), abs=1e-6)
    assert bent[ELBOWS[0]] == pytest.approx(bent[ELBOWS[1]] * [1, -1, 1, -1], abs=1e-9)
