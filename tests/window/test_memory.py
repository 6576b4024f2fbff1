"""The user's settings: kept whole, and never in the way."""

import json
from dataclasses import dataclass

import pytest

from demos.play import play_of
from demos.running import open_scenario
from demos.window.memory import kept_size, load_memory, memory_path, save_memory, taken_over


@dataclass
class Things:
    on: bool = True
    share: float = 0.5
    count: int = 3
    word: str = "a"


def test_where_they_are(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    assert memory_path() == tmp_path / "brace" / "window.json"
    for unusable in ("", "relative/folder"):
        monkeypatch.setenv("XDG_CONFIG_HOME", unusable)
        monkeypatch.setenv("HOME", str(tmp_path / "home"))
        assert memory_path() == tmp_path / "home" / ".config" / "brace" / "window.json"


def test_what_is_kept_comes_back(tmp_path):
    path = tmp_path / "new" / "brace" / "window.json"
    assert load_memory(path) == ({}, None)
    assert save_memory(path, {"tab": "View", "view": {"com": False}}) is None
    kept, trouble = load_memory(path)
    assert trouble is None
    assert kept["view"] == {"com": False}


@pytest.mark.parametrize("content", [b"{", b"\xff\xfe\x00", b"[]", b'{"version": 99}', b"null", b"[" * 100000])
def test_a_damaged_file_is_one_line_and_a_fresh_start(tmp_path, content):
    path = tmp_path / "window.json"
    path.write_bytes(content)
    kept, trouble = load_memory(path)
    assert kept == {}
    assert str(path) in trouble
    assert "\n" not in trouble


def test_a_folder_in_its_place_is_one_line_both_ways(tmp_path):
    (tmp_path / "window.json").mkdir()
    kept, trouble = load_memory(tmp_path / "window.json")
    assert (kept, "window.json" in trouble) == ({}, True)
    (tmp_path / "file").write_text("in the way")
    assert "not kept" in save_memory(tmp_path / "file" / "brace" / "window.json", {})


@pytest.mark.parametrize(
    "kept",
    [None, 3, {"on": 1, "share": True, "count": "x", "word": None}, {"share": 1e300, "nothing": 1, "__class__": "x"}],
)
def test_values_of_another_kind_are_passed_over(kept):
    things = Things()
    taken_over(things, kept)
    assert things == Things()


def test_values_of_the_same_kind_are_taken_over():
    things = Things()
    taken_over(things, {"on": False, "share": 1, "word": "b"})
    assert things == Things(on=False, share=1.0, word="b")


@pytest.mark.parametrize("size", [None, [0, 0], [1280], ["a", "b"], [1e9, 3], {"w": 1}, [1280, 90000]])
def test_a_size_that_is_none_is_passed_over(size):
    assert kept_size({"size": size}) is None
    assert kept_size({"size": [900, 700]}) == (900, 700)


def test_a_window_starts_as_the_last_one_ended(tmp_path):
    first = play_of(*open_scenario("sway"), tmp_path)
    first.session.view.ghost_rules, first.session.view.plots, first.tab = True, False, "Rules"
    first.session.slow_motion.enabled, first.session.auto_fire_s = False, 4.5
    kept = json.loads(json.dumps(first.memory()))
    second = play_of(*open_scenario("sway"), tmp_path)
    second.remember(kept)
    assert second.memory() == first.memory()
    assert second.session.auto_fire_s == 4.5


def test_panels_keep_what_is_theirs_even_if_they_were_not_opened(tmp_path, monkeypatch):
    class Note:
        title, word = "Note", "empty"

        def draw(self, ui, session): ...

        def memory(self):
            return {"word": self.word}

        def remember(self, kept):
            self.word = str(kept.get("word"))

    monkeypatch.setattr("demos.play.make_panels", lambda: [Note()])
    play = play_of(*open_scenario("sway"), tmp_path)
    play.remember({"panels": {"Note": {"word": "kept"}, "Gone": {"x": 1}}})
    assert play.memory()["panels"] == {"Note": {"word": "kept"}, "Gone": {"x": 1}}  # not opened
    assert play.panels[0].word == "kept"
    play.panels[0].word = "new"
    assert play.memory()["panels"]["Note"] == {"word": "new"}
    play.remember({"panels": ["damaged"]})
    assert play.memory()["panels"] == {"Note": {"word": "new"}}
