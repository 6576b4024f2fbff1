"""Every constant has a name, a default, a unit and a section, and can be overridden by its dotted name."""

import math

import pytest

from behaviours.overriding import constants, override
from behaviours.settings import CHOICES, Settings
from engine.core.errors import BadInput


def test_every_constant_says_unit_section_and_meaning():
    table = constants()
    groups = zip(Settings._fields, Settings(), strict=True)
    assert list(table) == [f"{name}.{field}" for name, group in groups for field in group._fields]
    assert all(c.unit and c.section and c.meaning for c in table.values())


def test_names_end_in_the_unit_they_are_in():
    endings = {"m": "_m", "rad": "_rad", "s": "_s"}
    for name, constant in constants().items():
        if constant.unit in endings:
            assert name.endswith(endings[constant.unit]), name


def test_defaults_are_the_thesis_numbers():
    s = Settings()
    assert [round(math.degrees(v)) for v in s.lean_turn.neck_rad + s.lean_turn.back_rad] == [50, 50, 65, 25, 25, 8]
    assert [round(math.degrees(v)) for v in s.lean_turn.waist_rad + s.lean_turn.pelvis_rad] == [10, 10, 12, 15, 15, 20]
    assert [round(math.degrees(v)) for v in s.recoil.clavicle_rad + s.recoil.elbow_rad] == [35, 25, 0, 0, 150, 0]
    assert (s.block.reach_near_m, s.block.reach_far_m, s.balance.brace_m) == (0.3, 0.9, 0.10)
    assert (s.solver.offset, s.solver.tolerance, s.solver.iterations) == (0.01, 1e-4, 60)


def test_override_by_dotted_name_keeps_types_and_the_original():
    before = Settings()
    after = override(before, {"block.reach_far_m": 1, "solver.iterations": 30.0, "objective.form": "literal"})
    assert after.block.reach_far_m == 1.0
    assert isinstance(after.block.reach_far_m, float)
    assert after.solver.iterations == 30
    assert isinstance(after.solver.iterations, int)
    assert after.objective.form == "literal"
    assert before == Settings()


def test_degrees_at_the_interface():
    after = override(Settings(), {"lean_turn.neck_deg": [40, 30, 60], "wrap.elbow_aside_deg": 90})
    assert after.lean_turn.neck_rad == pytest.approx((math.radians(40), math.radians(30), math.radians(60)))
    assert after.wrap.elbow_aside_rad == pytest.approx(math.pi / 2)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"block.reach_fra_m": 1.0}, "block.reach_far_m"),
        ({"blok.reach_far_m": 1.0}, "block.reach_far_m"),
        ({"block.reach_far_m": "far"}, "a finite number"),
        ({"block.reach_far_m": True}, "a finite number"),
        ({"block.reach_far_m": float("nan")}, "a finite number"),
        ({"block.reach_far_m": float("inf")}, "a finite number"),
        ({"block.reach_far_m": 10**400}, "a finite number"),
        ({"lean_turn.neck_deg": [1, float("nan"), 3]}, "3 numbers"),
        ({"timing.angle_free": "maybe"}, "true or false"),
        ({"solver.iterations": 2.5}, "a whole number"),
        ({"search.candidates": 0}, "a whole number from 1"),
        ({"search.candidates": 10**22}, "a whole number from 1"),
        ({"timing.sustained_ahead_s": -5}, "seconds, from 0"),
        ({"blend.seam_half_life_s": 0}, "seconds, above 0"),
        ({"lean_turn.neck_deg": [1, 2]}, "3 numbers"),
        ({"solver.method": "magic"}, "bfgs | least_squares"),
    ],
)
def test_a_wrong_override_says_what_was_expected(change, said):
    with pytest.raises(BadInput) as caught:
        override(Settings(), change)
    assert said in caught.value.line()


def test_every_choice_of_words_is_listed():
    groups = zip(Settings._fields, Settings(), strict=True)
    words = {f"{n}.{f}" for n, g in groups for f in g._fields if isinstance(getattr(g, f), str)}
    assert words == set(CHOICES)
