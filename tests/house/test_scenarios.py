"""The scenarios that come with Brace, and what becomes of names that do not exist."""

import pytest

from behaviours.scenario import load_scenario
from demos.scenarios import find_scenario, names
from engine.core.errors import BadInput


@pytest.mark.parametrize("name", names())
def test_each_is_whole_and_says_what_it_shows(name):
    path = find_scenario(name)
    scenario = load_scenario(path)
    assert scenario.character
    assert scenario.threat
    assert path.read_text(encoding="utf-8").startswith("# ")


def test_one_needs_nothing_that_must_be_fetched():
    assert load_scenario(find_scenario("sway")).character[0].clip == "sway"


def test_a_path_is_taken_as_it_is(tmp_path):
    assert find_scenario(str(tmp_path / "mine.toml")) == tmp_path / "mine.toml"


def test_an_unknown_name_lists_all_nearest_first():
    with pytest.raises(BadInput) as trouble:
        find_scenario("voleyball")
    assert "expected one of volleyball, " in trouble.value.line()
    assert all(name in trouble.value.message for name in names())
