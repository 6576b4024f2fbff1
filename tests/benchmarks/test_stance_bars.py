"""The figures of stances over a small sample: every error bar is met, and the table says which is not."""

import pytest

from demos.benchmarks import stance_bars
from engine.body.anthropometry import standard_body

# what a busy machine cannot promise
UNSURE = ("ms",)


@pytest.fixture(scope="module")
def found():
    return stance_bars.bars(48, seed=11)


def test_every_error_is_within_its_bar(found):
    assert [bar for bar in found if not bar.met and not any(word in bar.what for word in UNSURE)] == []


def test_the_table_marks_what_is_not_met(found):
    bad = found[0]._replace(met=False)
    ok, not_ok = stance_bars.table([found[0], bad])
    assert ok.startswith("ok")
    assert not_ok.startswith("NOT")


def test_cases_are_seeded_and_of_every_set():
    body = standard_body()
    cases = stance_bars.make_cases(body, 24, seed=3)
    assert cases == stance_bars.make_cases(body, 24, seed=3)
    assert {case.set_name for case in cases} == set(stance_bars.SETS)
    assert cases != stance_bars.make_cases(body, 24, seed=4)
