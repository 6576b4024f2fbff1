"""`brace clips`, on the clip that needs no fetching and on files that are wrong."""

import json

import pytest

from demos.cli import main
from engine.body.skeleton import JOINTS
from tests.clips.people import swing_arms, write_person

REPORTED = {
    "name", "format", "frames", "fps", "duration_s", "source_joints", "scale_to_m", "up_axis", "leg_length_m",
    "height_m", "floor_m", "facing_deg", "rest_frames_dropped", "planted", "missing_joints", "joints_m",
}  # fmt: skip

BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 3 Zrotation Xrotation Yrotation
  End Site
  {
    OFFSET 0 1 0
  }
}
MOTION
Frames: 2
Frame Time: 0.03333
0 0 0
0 0
"""


@pytest.fixture
def empty_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "cache"))


def one_line(capsys):
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    return err


def test_the_list_names_what_is_here_and_what_is_not(empty_cache, capsys):
    assert main(["clips", "list", "--json"]) == 0
    ready = {clip["name"]: clip["ready"] for clip in json.loads(capsys.readouterr().out)["clips"]}
    assert {"walk", "run", "dance", "hop", "stand", "kneel", "getup_faceup"} < ready.keys()
    assert [name for name, here in ready.items() if here] == ["sway"]
    assert main(["clips"]) == 0
    assert capsys.readouterr().out.count("brace clips fetch") == len(ready) - 1


def test_show_gives_every_promised_field(empty_cache, capsys):
    assert main(["clips", "show", "sway", "--json", "--at", "1.0"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert set(report) >= REPORTED
    assert set(report["joints_m"]) == set(JOINTS)


def test_show_gives_the_joints_of_that_moment(empty_cache, capsys):
    """Somebody who sways keeps the feet and moves the pelvis."""
    at = {}
    for moment in ("0.0", "1.0"):
        main(["clips", "show", "sway", "--json", "--at", moment])
        at[moment] = json.loads(capsys.readouterr().out)["joints_m"]
    assert at["0.0"]["left_ankle"] == pytest.approx(at["1.0"]["left_ankle"], abs=1e-3)
    assert at["0.0"]["pelvis"] != pytest.approx(at["1.0"]["pelvis"], abs=1e-3)


def test_words_for_people(empty_cache, capsys):
    assert main(["clips", "show", "sway"]) == 0
    out = capsys.readouterr().out
    assert "left foot stands in frames" in out
    assert out.count(" m\n") >= len(JOINTS)


def test_one_line_says_which_frames_were_bridged_and_of_what(empty_cache, capsys, tmp_path):
    poses = swing_arms(40)
    plain, glitched = tmp_path / "plain.bvh", tmp_path / "glitched.bvh"
    write_person(plain, poses, fps=120)
    poses[20] = {**poses[20], "Head": (0.0, 25.0, 0.0)}
    write_person(glitched, poses, fps=120)
    said = {}
    for words in ([str(plain)], [str(glitched)], [str(glitched), "--as-captured"]):
        assert main(["clips", "show", *words]) == 0
        said[" ".join(words)] = [line for line in capsys.readouterr().out.splitlines() if "bridged" in line]
    line = "1 frame bridged, in which joints were astray and straight back: 20 (head 1); --as-captured leaves them"
    assert list(said.values()) == [[], [line], []]


def test_a_moment_outside_the_clip_is_refused(empty_cache, capsys):
    assert main(["clips", "show", "sway", "--at", "1e6"]) == 2
    assert one_line(capsys).startswith("error[usage]: --at 1e+06: expected 0 to ")


def test_a_broken_bvh_is_one_line_with_its_place(empty_cache, capsys, tmp_path):
    path = tmp_path / "broken.bvh"
    path.write_text(BVH)
    assert main(["clips", "show", str(path)]) == 2
    line = one_line(capsys)
    assert f"{path}:15" in line
    assert line.startswith("error[")


@pytest.mark.parametrize("name", ["swya", "nowhere.bvh", "notes.txt"])
def test_a_clip_that_is_not_there_is_one_line(empty_cache, capsys, name):
    assert main(["clips", "show", name]) == 2
    assert one_line(capsys).startswith("error[clip")


def test_a_clip_never_fetched_says_how(empty_cache, capsys):
    assert main(["clips", "show", "walk"]) == 3
    assert "brace clips fetch" in one_line(capsys)


def test_a_fetch_without_an_index_is_one_line(empty_cache, capsys, monkeypatch):
    """pip told to look nowhere: nothing is brought, nothing is left behind."""
    for name, value in {"PIP_NO_INDEX": "1", "PIP_CONFIG_FILE": "/dev/null", "PIP_FIND_LINKS": ""}.items():
        monkeypatch.setenv(name, value)
    assert main(["clips", "fetch"]) == 3
    assert one_line(capsys).startswith("error[")
