"""The demos, each run as a newcomer runs it."""

import json
import re
import subprocess
import sys

import pytest

from behaviours.scenario import check_scenario
from behaviours.stance.shape_sets import SETS
from demos import crowd, gauntlet, own_loop, rewind, stances, volleyball
from demos.cli import main
from demos.running import open_scenario
from demos.scenarios import PROGRAMS, names
from tests.conftest import ROOT


@pytest.mark.parametrize("program", [gauntlet, crowd])
def test_dice_make_the_same_scenario_each_time(program):
    first, second = check_scenario(program.scenario()), check_scenario(program.scenario())
    assert first == second
    assert len({threat.azimuth_deg for threat in first.threat}) == len(first.threat)


def test_programs_have_names_of_their_own():
    assert not set(PROGRAMS) & set(names())
    for name in PROGRAMS:
        assert open_scenario(name, ("duration_s=1.0",))[0].duration_s == 1.0


def test_everyone_in_a_crowd_protects_themselves(capsys, library_clip):
    for clip in crowd.CLIPS:
        library_clip(clip)
    assert main(["react", "crowd", "--set", "duration_s=2.7", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    perceived = {event["entity"] for event in report["events"] if event["kind"] == "perceived"}
    struck = {event["entity"] for event in report["events"] if event["kind"] == "contact"}
    assert len(perceived) == crowd.PEOPLE
    assert len(struck) >= crowd.PEOPLE - 1  # somebody may step aside


def test_the_front_pages_program_runs_as_it_stands(library_clip):
    library_clip("walk")
    (program,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "'first_contact': 'left_hand'" in done.stdout


def test_the_walker_meets_every_ball_and_walks_on(capsys, library_clip):
    library_clip("walk")
    assert main(["react", "gauntlet", "--set", "duration_s=5.7", "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert [event["t_s"] for event in report["events"] if event["kind"] == "perceived"] == [0.6, 3.2]
    assert [phase["name"] for phase in report["phases"]].count("protect") == 2
    assert report["phases"][-1]["name"] == "play"


def test_volleyball_tells_what_happens_and_makes_a_page(tmp_path, capsys):
    page = tmp_path / "sway.html"
    volleyball.main("sway", str(page))
    said = capsys.readouterr().out
    assert [word for word in ("play", "protect", "respond") if word not in said] == []
    assert said.index("perceived") < said.index("contact")
    assert page.read_text().startswith("<!doctype html>")


def test_stances_shows_every_set(tmp_path, capsys):
    page = tmp_path / "stances.html"
    stances.main(str(page))
    said = capsys.readouterr().out
    assert all(f"\n{name} " in f"\n{said}" for name in SETS)
    assert page.read_text().startswith("<!doctype html>")


def test_rewind_comes_back_to_the_same_and_goes_elsewhere(capsys):
    rewind.main("sway")
    said = capsys.readouterr().out
    assert "the same to the last bit: True" in said
    once, otherwise = (
        [line for line in part.splitlines() if "contact" in line] for part in said.split("with another ball")
    )
    assert len(once) >= 1
    assert len(otherwise) > len(once)


def test_a_loop_of_ones_own_throws_a_ball_and_takes_it_back(capsys):
    own_loop.main()
    thrown, undone = capsys.readouterr().out.split("rewound")
    assert "respond" in thrown
    assert "startle" not in undone
    assert undone.count(" play ") == undone.count("frame ") > 0


@pytest.mark.parametrize(
    "words", [("demos.rewind", "nowhere"), ("demos.gauntlet", "--size", "x"), ("demos.crowd", "-z")]
)
def test_run_as_programs_they_complain_in_one_line(words, tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", *words], cwd=tmp_path, capture_output=True, text=True,
        env={"PYTHONPATH": str(ROOT), "PATH": ""},
    )  # fmt: skip
    assert done.returncode == 2
    assert done.stderr.startswith("error[")
    assert done.stderr.count("\n") == 1
