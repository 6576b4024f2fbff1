"""The shape sets: what the paper says of each, what any animator would refuse, and no jumps."""

from itertools import pairwise

import numpy as np
import pytest

from behaviours.stance import shape_sets
from behaviours.stance.around import Around
from behaviours.stance.measures import measures
from behaviours.stance.shape import RANGES
from behaviours.stance.shape_sets import SETS, posture
from behaviours.stance.solve import solve_stance
from engine.body.capsules import CAPSULES, body_capsules, capsules_at
from engine.body.skeleton import ANKLES, BACK, ELBOWS, HEAD, HIPS, KNEES, MIRRORED, NECK, PELVIS, SHOULDERS, WRISTS
from engine.core.errors import BadInput
from engine.maths import quaternion

OBJECTS = ((1.2, 0.5, 1.3), (1.1, 0.0, 0.6), (0.1, -1.0, 1.2), (-0.9, 0.4, 1.5), (0.8, -0.4, 0.1))
NAMES = tuple(SETS)


def everywhere(body, name, count=7):
    """Stances of a set over its range, with objects all around where it needs one."""
    entry = SETS[name]
    for intensity in np.linspace(entry.low, entry.high, count):
        for place in OBJECTS if entry.needs_object else (None,):
            yield solve_stance(body, name, intensity, object_m=place)


@pytest.mark.parametrize("name", NAMES)
def test_intensity_zero_is_neutral(body, name):
    neutral = solve_stance(body, "posture", 0.0)
    assert solve_stance(body, name, 0.0, object_m=(1.0, 0.3, 1.2)).joints_m == pytest.approx(neutral.joints_m, abs=1e-6)


@pytest.mark.parametrize("name", NAMES)
def test_balanced_rooted_and_within_limits_all_over_its_range(body, name):
    for result in everywhere(body, name):
        found = measures(body, result)
        assert found.foot_error_m.max() < 1e-7
        assert found.balance_error_m < 1e-4
        assert found.limit_excess_rad < 1e-9
        assert result.kept == 1.0


@pytest.mark.parametrize("name", NAMES)
def test_knees_and_elbows_bend_the_right_way(body, name):
    for result in everywhere(body, name):
        q = result.pose.rotations
        for side in range(2):
            assert 2 * np.arctan2(q[KNEES[side], 2], q[KNEES[side], 0]) > 0.0
            assert np.arctan2(-q[ELBOWS[side], 2], q[ELBOWS[side], 0]) >= 0.0
            hip, knee, ankle = (result.joints_m[j[side]] for j in (HIPS, KNEES, ANKLES))
            toes = quaternion.rotate(result.orientations[ANKLES[side]], (1.0, 0.0, 0.0))
            assert (2 * knee - hip - ankle) @ toes > 0.0


PAIRS = [
    (f"{side}_{part}", other)
    for side, across in (("left", "right"), ("right", "left"))
    for part in ("forearm", "hand")
    for other in (
        "pelvis",
        "belly",
        "chest",
        "upper_chest",
        "neck",
        "head",
        f"{side}_thigh",
        f"{across}_thigh",
        f"{across}_forearm",
    )
] + [
    ("left_shank", "right_shank"),
    ("left_foot", "right_foot"),
    ("left_thigh", "right_thigh"),
    ("left_thigh", "right_shank"),
]


def gap_m(a, b, radius_a, radius_b):
    """Between two capsules (segments (2, 3)), by dense sampling."""
    t = np.linspace(0.0, 1.0, 25)[:, None]
    p, q = a[0] + t * (a[1] - a[0]), b[0] + t * (b[1] - b[0])
    return np.linalg.norm(p[:, None] - q[None], axis=-1).min() - radius_a - radius_b


@pytest.mark.parametrize("name", NAMES)
def test_nothing_passes_through_the_body(body, name):
    """Flesh may touch: two centimetres, as much as thighs give way to each other."""
    shapes = body_capsules(body)
    for result in everywhere(body, name, 5):
        ends = capsules_at(shapes, result.joints_m, result.orientations)
        for pair in PAIRS:
            i, j = (CAPSULES.index(part) for part in pair)
            assert gap_m(ends[i], ends[j], shapes.radius_m[i], shapes.radius_m[j]) > -0.02, (pair, result.shape)


@pytest.mark.parametrize("name", NAMES)
def test_no_joint_jumps_as_intensity_goes_up(body, name, turned_deg):
    """At most 2 degrees for 0.01 of intensity; no set states a switch that shows without a wrist target."""
    entry = SETS[name]
    grid = np.arange(entry.low, entry.high + 0.005, 0.01)
    for place in OBJECTS[::2] if entry.needs_object else (None,):
        poses = [solve_stance(body, name, a, object_m=place).pose.rotations for a in grid]
        assert max(turned_deg(a, b).max() for a, b in pairwise(poses)) < 2.0


@pytest.mark.parametrize("name", [n for n in NAMES if SETS[n].needs_object])
def test_an_object_on_the_other_side_is_met_in_the_mirror(body, name):
    for x, y, z in OBJECTS:
        if y == 0.0:
            continue
        ours, theirs = (solve_stance(body, name, 0.8, object_m=(x, s * y, z)).joints_m for s in (1, -1))
        assert ours == pytest.approx(theirs[MIRRORED] * [1, -1, 1], abs=1e-5)


def distance_to(result, place, joint=HEAD):
    return np.linalg.norm(result.joints_m[joint] - place)


@pytest.mark.parametrize("name", ["recoil-mild", "recoil-strong"])
@pytest.mark.parametrize("place", OBJECTS)
def test_recoil_takes_the_head_away_from_the_object_wherever_it_is(body, name, place):
    heads = [solve_stance(body, name, a, object_m=place).joints_m[HEAD] for a in (0.0, 0.5, 1.0)]
    away = [np.hypot(*(head[:2] - place[:2])) for head in heads]
    assert away[0] < away[1] < away[2]


@pytest.mark.parametrize("name", ["interest", "interest-curious"])
@pytest.mark.parametrize("place", [o for o in OBJECTS if o[0] > 0.0])
def test_interest_brings_the_head_nearer(body, name, place):
    away = [distance_to(solve_stance(body, name, a, object_m=place), place) for a in (0.0, 0.5, 1.0)]
    assert away[0] > away[1] > away[2]


def test_recoil_strong_shifts_and_twists_more_than_mild(body):
    mild, strong = (shape_sets.shape_of(f"recoil-{k}", 1.0, Around(0.4, 0.0)) for k in ("mild", "strong"))
    for name in ("balance_x", "pelvis_y_rad"):
        assert abs(getattr(strong.numbers, name)) > abs(getattr(mild.numbers, name))


STATES = {
    "recoil-mild": {
        "coronal_class": "LargeC",
        "sagittal_class": "LargeC",
        "collar_y": "opposed",
        "collar_z": "opposed",
    },
    "recoil-strong": {
        "coronal_class": "LargeS",
        "sagittal_class": "SmallC",
        "collar_y": "opposed",
        "collar_z": "aligned",
    },
    "interest": {"coronal_class": "LargeS", "sagittal_class": "LargeS", "collar_y": "aligned", "collar_z": "aligned"},
    "interest-curious": {
        "coronal_class": "LargeC",
        "sagittal_class": "LargeC",
        "collar_y": "aligned",
        "collar_z": "aligned",
    },
}


@pytest.mark.parametrize("name", STATES)
def test_state_sets_are_the_papers(name):
    states = shape_sets.shape_of(name, 0.7, Around(0.3, 0.0)).states._asdict()
    assert STATES[name].items() <= states.items()


def test_reaches_differ_in_their_states(body):
    around = Around(0.2, 0.0, (False, True))
    seen = {shape_sets.shape_of(name, 1.0, around).states for name in NAMES if name.startswith("reach")}
    assert len(seen) == 4
    target = (0.52, -0.2, 1.25)
    poses = [solve_stance(body, name, 1.0, reach_right_m=target) for name in NAMES if name.startswith("reach")]
    for pose in poses:
        assert pose.joints_m[WRISTS[1]] == pytest.approx(target, abs=1e-3)
    heads = [pose.joints_m[HEAD, 0] for pose in poses]
    assert max(heads) - min(heads) > 0.1  # figure 1: the same constraint, different people


def test_posture_below_zero_hunches_forward_above_it_arches():
    low, high = (shape_sets.shape_of("posture", a, Around()) for a in (-0.5, 0.5))
    assert (low.states.sagittal_class, high.states.sagittal_class) == ("LargeC", "SmallS")
    assert low.numbers.sagittal > 0.0 < high.numbers.sagittal
    assert low.numbers.collar_y_rad < 0.0 < high.numbers.collar_y_rad
    assert low.numbers.collar_z_rad < 0.0


def test_knees_bend_only_towards_the_hunched_end():
    knees = [shape_sets.shape_of("posture", a, Around()).numbers.knee_left_rad for a in (-1.0, -0.6, -0.3, 0.0, 1.0)]
    assert knees[0] > 0.5
    assert knees[1] < 0.35 * knees[0]
    assert knees[2:] == [0.0, 0.0, 0.0]


def test_albertss_words_stand_in_order(body):
    words = list(posture.WORDS)
    assert words[0] == "hunched"
    assert words[-1] == "over-erect"
    assert list(posture.WORDS.values()) == sorted(posture.WORDS.values())
    heights = [solve_stance(body, word, 1.0).joints_m[HEAD, 2] for word in words[:8]]
    assert np.all(np.diff(heights) > 0.0)
    assert solve_stance(body, "hunched", 0.5).joints_m == pytest.approx(solve_stance(body, "posture", -0.5).joints_m)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_beauty_line_bends_the_knee_of_its_sign_in_a_large_s(body, sign):
    result = solve_stance(body, "beauty-line", sign)
    bent, straight = (0, 1) if sign > 0 else (1, 0)
    q = result.pose.rotations
    flexion = [2 * np.arctan2(q[k, 2], q[k, 0]) for k in KNEES]
    assert flexion[bent] > flexion[straight] + 0.4
    assert result.joints_m[HIPS[bent], 2] < result.joints_m[HIPS[straight], 2] - 0.01  # that hip drops
    side = 1.0 if straight == 0 else -1.0  # towards the standing leg
    pelvis, chest = result.joints_m[PELVIS, 1] * side, result.joints_m[NECK, 1] * side
    assert pelvis > chest + 0.03  # the hip out, the torso back over the foot
    up = [quaternion.rotate(result.orientations[j], (0, 0, 1))[1] * side for j in (PELVIS, BACK, HEAD)]
    assert up[1] < up[2] - 0.05  # and the head against the torso: an S, not a C
    tilt = result.joints_m[SHOULDERS[straight], 2] - result.joints_m[SHOULDERS[bent], 2]
    assert abs(tilt) < 0.12


def test_slovenly_thrusts_the_pelvis_forward(body):
    neutral, result = solve_stance(body, "posture", 0.0), solve_stance(body, "slovenly", 1.0)
    ahead = [r.joints_m[PELVIS, 0] - r.joints_m[BACK, 0] for r in (neutral, result)]
    assert ahead[1] > ahead[0] + 0.04
    assert result.joints_m[PELVIS, 0] > neutral.joints_m[PELVIS, 0] + 0.04


def test_straight_spine_bends_at_the_abdomen_alone(body):
    for intensity in (-1.0, 1.0):
        q = solve_stance(body, "straight-spine", intensity).pose.rotations
        assert q[[BACK, NECK, HEAD], 0] == pytest.approx(1.0, abs=1e-9)
    bows = [
        quaternion.rotate(solve_stance(body, "straight-spine", a).orientations[BACK], (0, 0, 1))[0] for a in (-1, 0, 1)
    ]
    assert bows[0] < bows[1] < bows[2]


def test_intensity_goes_past_one(body):
    strong = [solve_stance(body, "slovenly", a) for a in (1.0, 1.4)]
    assert strong[1].joints_m[PELVIS, 0] > strong[0].joints_m[PELVIS, 0]
    assert measures(body, strong[1]).limit_excess_rad < 1e-9


def test_an_unknown_set_lists_all_nearest_first():
    with pytest.raises(BadInput) as trouble:
        shape_sets.meaning_of("recoil-strog")
    words = trouble.value.message.split("expected one of ")[1].split(", ")
    assert words[0] == "recoil-strong"
    assert set(words) == {*SETS, *posture.WORDS}


@pytest.mark.parametrize("name", NAMES)
def test_numbers_stay_inside_the_sliders(name):
    for intensity in np.linspace(SETS[name].low, SETS[name].high, 9):
        for azimuth in np.linspace(-3.0, 3.0, 9):
            numbers = shape_sets.shape_of(name, intensity, Around(azimuth, 0.2, (True, False))).numbers
            assert all(RANGES[n].low <= v <= RANGES[n].high for n, v in numbers._asdict().items())


@pytest.mark.parametrize(("name", "intensity"), [(n, s) for n in NAMES for s in (SETS[n].low, SETS[n].high) if s])
def test_a_large_class_takes_the_lower_body_into_its_curve(name, intensity):
    """Large S and C include the lower body (5.2): pelvis, balance and a knee go along."""
    made = shape_sets.shape_of(name, intensity, Around(0.6, 0.1, (False, True)))
    n, large = made.numbers, ("LargeS", "LargeC")
    bends = (made.states.sagittal_class in large and n.sagittal) or (made.states.coronal_class in large and n.coronal)
    if bends:
        assert any((n.pelvis_x_rad, n.pelvis_z_rad))
        assert any((n.balance_x, n.balance_z))
        assert max(n.knee_left_rad, n.knee_right_rad) > 0.05
