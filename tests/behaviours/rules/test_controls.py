"""Table 3.1: lean from the speed, the other six from the size; normalised and clamped."""

import pytest

from behaviours.perceive.threats import normalised
from behaviours.rules.controls import CONTROLS, controls_from_threat


def test_lean_from_speed_all_others_from_size():
    values = dict(zip(CONTROLS, controls_from_threat(0.8, 0.3), strict=True))
    assert values.pop("lean") == 0.8
    assert set(values.values()) == {0.3}
    assert list(values) == ["turn", "recoil", "reach_left", "reach_right", "swivel_left", "swivel_right"]


def test_clamped_to_what_controls_may_be():
    assert controls_from_threat(1.7, -0.2).tolist() == [1.0, 0, 0, 0, 0, 0, 0]


@pytest.mark.parametrize(("value", "expected"), [(10, 0.0), (15, 0.5), (20, 1.0), (25, 1.0), (3, 0.0)])
def test_the_thesis_example(value, expected):
    """3.2.1: a range of 10 to 20, perceived at 15."""
    assert normalised(value, 10.0, 20.0) == expected
