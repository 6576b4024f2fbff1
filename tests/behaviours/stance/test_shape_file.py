"""Shapes as files: whole there and back, wrong ones refused in one line, the same stance by file, by hand and worn."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from behaviours.components import Posture
from behaviours.scenario import check_scenario
from behaviours.simulation import Simulation
from behaviours.stance.shape import ALLOWED, RANGES, evenly, shape
from behaviours.stance.shape_file import SavedShape, parse_shape, read_shape, shape_text
from behaviours.stance.shape_sets import SETS
from behaviours.stance.solve import solve_saved, solve_shape, solve_stance
from engine.clips.library import find_clip
from engine.core.errors import BadInput

states = st.fixed_dictionaries({name: st.sampled_from(allowed) for name, allowed in ALLOWED.items()})
numbers = st.fixed_dictionaries(
    {}, optional={name: st.floats(span.low, span.high) for name, span in RANGES.items()}
)  # fmt: skip
places = st.tuples(*[st.floats(-3.0, 3.0)] * 3)


@settings(max_examples=60)
@given(states, numbers, st.dictionaries(st.sampled_from(("object_m", "reach_left_m")), places))
def test_what_is_written_is_read_to_the_last_bit(chosen, values, points):
    saved = SavedShape(shape(wishes={"coronal": evenly(0.5, 4.0, weight=2.0)}, **chosen, **values), points)
    text = shape_text(saved)
    assert parse_shape(text) == saved
    assert tomllib.loads(text)["version"] == 1


@pytest.mark.parametrize("name", SETS)
def test_a_set_saved_as_a_shape_is_the_same_stance(body, name):
    """Wishes are kept, too: a reach from a file is the reach of its set."""
    points = {"object_m": (0.9, 0.4, 1.2)}
    if name.startswith("reach"):
        points = {"reach_right_m": (0.45, -0.3, 1.35)}
    result = solve_stance(body, name, 0.8, **points)
    again = parse_shape(shape_text(SavedShape(result.shape, points)))
    assert np.array_equal(
        solve_saved(body, again.shape, **again.points).pose.rotations, result.pose.rotations
    )  # fmt: skip


def test_the_intensity_of_a_shape_goes_from_neutral_to_it(body):
    own = shape(sagittal_class="LargeC", sagittal=2.0, knee_left_rad=0.4)
    half = solve_shape(body, shape(sagittal_class="LargeC", sagittal=1.0, knee_left_rad=0.2))
    assert np.array_equal(solve_saved(body, own, 0.5).pose.rotations, half.pose.rotations)
    assert np.array_equal(solve_saved(body, own, 0.0).pose.rotations, solve_shape(body, shape()).pose.rotations)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("version = 2", "version is 2, expected 1"),
        ("version = 1\nnumber = 3", "unknown key 'number'"),
        ("version = 1\n[numbers]\nsagital = 1", "unknown shape parameter 'sagital', expected one of sagittal"),
        ("version = 1\n[numbers]\nsagittal = true", "sagittal is True, expected a number"),
        ("version = 1\n[numbers]\nsagittal = nan", "expected a number"),
        ('version = 1\n[states]\ncollar_y = "both"', "collar_y is 'both', expected one of aligned, opposed"),
        ("version = 1\n[points]\nobject_m = [1, 2]", "expected three numbers"),
        ("version = 1\n[points]\nthing_m = [1, 2, 3]", "unknown point 'thing_m'"),
        ("version = 1\n[wishes.coronal]\nlow = [2, 0, 1, 1]", "expected 0 < basin < far"),
        ("version = 1\n[wishes.coronel]\nweight = 1", "unknown wish 'coronel'"),
        ("version = 1\n[wishes.coronal]\nweight = 0", "expected more than 0"),
        ("version = = 1", "no TOML"),
        ("version = 1\nnumbers = 3", "numbers is 3, expected a table"),
    ],
)
def test_a_wrong_file_is_refused_in_one_line(tmp_path, text, told):
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(BadInput) as caught:
        read_shape(path)
    assert told in caught.value.line()
    assert str(path) in caught.value.line()
    assert "\n" not in caught.value.line()


def test_no_file_is_one_line_too(tmp_path):
    with pytest.raises(BadInput, match="cannot be read"):
        read_shape(tmp_path / "none.toml")


def standing(stance) -> np.ndarray:
    """The first pose of somebody who wears it."""
    character = {"clip": "sway", "stance": stance}
    scenario = check_scenario({"version": 1, "duration_s": 0.1, "character": [character]})
    return Simulation(scenario, lambda spec: find_clip(spec.clip)).world[Posture].rotations[0].copy()


def test_a_shape_of_ones_own_is_worn_as_its_set_is():
    """`hunched` by its name, and by the very numbers of its shape."""
    from behaviours.stance.around import Around
    from behaviours.stance.shape_sets import shape_of

    made = shape_of("hunched", 1.0, Around())
    own = {**made.states._asdict(), **made.numbers._asdict()}
    by_name = standing({"set": "hunched", "intensity": 1.0})
    assert np.array_equal(standing({"intensity": 1.0, "shape": own}), by_name)
    assert np.abs(by_name - standing({"intensity": 0.0, "shape": own})).max() > 0.05


@pytest.mark.parametrize("own", [{"sagital": 1.0}, {"sagittal": "much"}, {"sagittal_class": "HugeC"}])
def test_a_shape_that_cannot_be_is_refused_with_the_scenario(own):
    with pytest.raises(BadInput) as caught:
        check_scenario({"character": [{"clip": "sway", "stance": {"intensity": 1.0, "shape": own}}]})
    assert "character.0.stance.shape" in caught.value.line()
