"""Scenarios that say what cannot be: one line that names the place and what was expected, and exit code 2."""

import pytest

from behaviours.perceive.threats import KINDS
from behaviours.scenario import check_scenario
from demos.cli import main

HEAD = "version = 1\nduration_s = 0.1\n"
CHARACTER = '[[character]]\nclip = "sway"\n'
THREAT = '[[threat]]\ntarget = "head"\n'

# what is wrong: (the file, words that the line must have)
WRONG = {
    "a key that is not one": (HEAD + "durations_s = 3\n" + CHARACTER, ["x.toml:3", "'durations_s'", "duration_s"]),
    "a character's key": (HEAD + CHARACTER + "boldnes = 1\n", ["x.toml:5", "'character.0.boldnes'", "boldness"]),
    "a threat's key": (HEAD + CHARACTER + THREAT + "azimut_deg = 3\n", ["x.toml:7", "azimuth_deg"]),
    "a stance's key": (HEAD + CHARACTER + "stance = { sett = 'tired' }\n", ["'character.0.stance.sett'", "intensity"]),
    "a word for a number": (HEAD + CHARACTER + THREAT + 'speed_mps = "fast"\n', ["x.toml:7", "number", "'fast'"]),
    "a number that is none": (HEAD + CHARACTER + THREAT + "speed_mps = nan\n", ["threat.0.speed_mps", "finite"]),
    "a size beyond one": (HEAD + CHARACTER + THREAT + "size = 1.5\n", ["x.toml:7", "1.5", "less than or equal to 1"]),
    "no time at all": ("duration_s = 0\n" + CHARACTER, ["x.toml:1", "duration_s", "greater than 0"]),
    "a version to come": ("version = 2\n" + CHARACTER, ["x.toml:1", "version"]),
    "an unknown kind": (HEAD + CHARACTER + THREAT + 'kind = "voleyball"\n', ["x.toml:7", "expected one of volleyball"]),
    "an unknown target": (HEAD + CHARACTER + '[[threat]]\ntarget = "hed"\n', ["x.toml:6", "expected one of head"]),
    "an unknown way back": (HEAD + CHARACTER + 'recover = "newer"\n', ["x.toml:5", "'same', 'new' or 'auto'"]),
    "an unknown clip": (HEAD + '[[character]]\nclip = "wolk"\n', ["found no clip or file 'wolk'", "expected walk"]),
    "nobody there": (HEAD + CHARACTER + THREAT + "at_character = 3\n", ["threat.0.at_character is 3", "1 character"]),
    "both times": (HEAD + CHARACTER + THREAT + "perceived_s = 1\ncontact_s = 2\n", ["perceived_s or contact_s"]),
    "scripted from a place": (HEAD + CHARACTER + THREAT + "position_m = [1, 2, 3]\n", ["position_m needs free = true"]),
    "free from nowhere": (HEAD + CHARACTER + THREAT + "free = true\n", ["needs position_m"]),
    "a start after the end": (
        HEAD + '[[character]]\nclip = "hop"\nstart_s = 900\n', ["character.0.start_s is 900", "lasts"]
    ),
    "an unknown setting": (HEAD + CHARACTER + "[settings.block]\nofset_m = 1\n", ["'block.ofset_m'", "block.offset_m"]),
    "an unknown group": (HEAD + CHARACTER + "[settings.blok]\noffset_m = 1\n", ["'blok.offset_m'"]),
    "a setting that is no group": (HEAD + CHARACTER + "[settings]\nblock = 3\n", ["settings.block", "table"]),
    "a choice that is none": (
        HEAD + CHARACTER + '[settings.timing]\nttc_model = "guess"\n', ["ttc_model is 'guess'", "equation | text"]
    ),
    "three numbers short": (HEAD + CHARACTER + "[settings.lean_turn]\nneck_deg = [1, 2]\n", ["expected 3 numbers"]),
    "no TOML": ("duration_s = = 3\n", ["error[toml]", "x.toml:1"]),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_one_line_and_exit_code_2(case, tmp_path, capsys, library_clip):
    if "hop" in WRONG[case][0]:
        library_clip("hop")
    text, words = WRONG[case]
    path = tmp_path / "x.toml"
    path.write_text(text, encoding="utf-8")
    assert main(["react", str(path)]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error[")
    assert captured.err.count("\n") == 1
    for word in words:
        assert word in captured.err, captured.err


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("threat.0.speed_mph=3", "unknown key 'threat.0.speed_mph'"),
        ("threat.7.speed_mps=3", "no entry '7'"),
        ("threat.0.speed_mps", "not of the form key=value"),
        ("duration_s.x=3", "'duration_s' holds a value"),
        ("settings.timing.angle_free=maybe", "expected true or false"),
        ("character.0.response_s=0", "--set character.0.response_s=0: character.0.response_s: Input should be greater"),
        ("threat.0.azimuth_deg=1e300", "less than or equal to 360"),
        ("character.0.position_m=[1e300, 0]", "less than or equal to 1000"),
        ("seed=99999999999999999999999999", "less than 9223372036854775808"),
        ("character=[]", "character: expected at least one"),
        ("threat=3", "threat: expected a list"),
    ],
)
def test_so_does_an_override(override, words, capsys):
    assert main(["react", "sway", "--set", override]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert words in err


def test_two_troubles_are_counted(tmp_path, capsys):
    path = tmp_path / "x.toml"
    path.write_text("durations_s = 3\nsede = 1\n" + CHARACTER, encoding="utf-8")
    assert main(["react", str(path)]) == 2
    assert "(and 1 more)" in capsys.readouterr().err


def test_a_file_that_cannot_be_read_is_named(tmp_path, capsys):
    assert main(["react", str(tmp_path / "none.toml")]) == 2
    assert "none.toml" in capsys.readouterr().err
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00\x01")
    assert main(["react", str(tmp_path / "binary.toml")]) == 2
    assert "is not text" in capsys.readouterr().err


def test_a_kind_that_is_added_may_be_thrown_as_well(monkeypatch):
    monkeypatch.setitem(KINDS, "medicine_ball", KINDS["custom"]._replace(mass_kg=3.0))
    throw = {"kind": "medicine_ball", "position_m": [4, 0, 1], "velocity_mps": [-8, 0, 2]}
    scenario = check_scenario({"command": [{"at_s": 1, "throw": throw}], "threat": [{"kind": "medicine_ball"}]})
    assert scenario.command[0].throw.kind == scenario.threat[0].kind == "medicine_ball"
