"""The account of a run: its phases leave no gap, its events are plain, its measures are there or None."""

from __future__ import annotations

import json
from itertools import pairwise

import pytest

from behaviours.components import Phase
from behaviours.measure.observing import Track
from behaviours.measure.report import phase_rows, recovered_to
from behaviours.scenario import check_scenario
from behaviours.simulation import Simulation
from demos.commands.react import report_lines
from engine.clips.library import find_clip
from tests.behaviours.people import BODY
from tests.behaviours.runs import AHEAD, run, simulation_of


def test_phases_follow_each_other_without_a_gap(blocked):
    rows = blocked.report()["phases"]
    assert rows[0]["from_s"] == 0.0
    assert rows[-1]["to_s"] == pytest.approx(blocked.ticks / 120)
    for before, after in pairwise(rows):
        assert before["to_s"] == after["from_s"]
        assert before["name"] != after["name"]


def test_phases_are_told_from_the_ticks():
    track = Track(BODY)
    track.tick, track.phase = [0, 1, 2, 3], [Phase.PLAY, Phase.PLAY, Phase.STARTLE, Phase.PLAY]
    assert phase_rows(track) == [
        {"name": "play", "from_s": 0.0, "to_s": 2 / 120},
        {"name": "startle", "from_s": 2 / 120, "to_s": 3 / 120},
        {"name": "play", "from_s": 3 / 120, "to_s": 4 / 120},
    ]


def test_a_report_is_plain_data(blocked):
    report = blocked.report()
    assert json.loads(json.dumps(report))["digest"] == blocked.world.digest()
    assert report["ticks"] == blocked.ticks
    kinds = [event["kind"] for event in report["events"]]
    assert kinds.index("launched") < kinds.index("perceived") < kinds.index("contact")
    times = [event["t_s"] for event in report["events"]]
    assert times == sorted(times)
    assert "characters" not in report


def test_what_did_not_happen_is_none():
    report = run([], duration_s=0.5).report()
    for name in (
        "ttc_s",
        "contact_error_s",
        "first_contact",
        "head_peak_g",
        "hic15",
        "recovered_to",
        "com_margin_min_m",
    ):
        assert report["metrics"][name] is None, name
    for name in ("foot_slide_max_m", "joint_limit_excess_max_rad", "overlap_max_m", "seam_position_jump_max_m"):
        assert report["metrics"][name] == 0.0, name
    assert report["metrics"]["overlap_between"] is None
    assert [row["name"] for row in report["phases"]] == ["play"]


def test_measures_of_a_blow_are_told(blocked):
    metrics = blocked.report()["metrics"]
    assert metrics["head_peak_g"] > 0.5
    assert 0.0 < metrics["hic15"] < metrics["head_peak_g"] ** 2.5 * 0.015 + 1e-9  # its greatest value, were it all peak
    assert metrics["recovered_to"] == "sway"
    assert metrics["stopped"] == 0


def test_who_is_not_back_yet_has_recovered_to_nothing():
    simulation = simulation_of([AHEAD], startle=False)
    for _ in range(60):
        simulation.step()
    assert simulation.report()["metrics"]["recovered_to"] is None


def test_who_lies_at_the_end_is_down():
    track = Track(BODY)
    track.phase, track.clip = [Phase.PLAY, Phase.RESPOND, Phase.DOWN], [0, 0, 0]
    assert recovered_to(track, ()) == "down"
    track.phase = [Phase.PLAY, Phase.PROTECT, Phase.RESPOND]
    assert recovered_to(track, ()) is None


def test_two_people_have_an_account_each():
    scenario = check_scenario({
        "duration_s": 1.0,
        "character": [{"clip": "sway"}, {"clip": "sway", "position_m": [0.0, 6.0]}],
        "threat": [AHEAD | {"at_character": 1}],
    })  # fmt: skip
    simulation = Simulation(scenario, lambda spec: find_clip(spec.clip), observe=True)
    for _ in range(simulation.ticks):
        simulation.step()
    report = simulation.report()
    first, second = report["characters"]
    assert first["metrics"] == report["metrics"]
    assert first["metrics"]["ttc_s"] is None
    assert second["metrics"]["ttc_s"] > 0.2
    whose = {event["kind"]: event["character"] for event in report["events"]}
    assert whose["launched"] == whose["perceived"] == 1
    lines = report_lines(report)
    told = [line.split() for line in lines if "perceived" in line]
    assert [words[2] for words in told] == ["1"]
    assert [line for line in lines if line.startswith("measures")] == [
        "measures of character 0", "measures of character 1",
    ]  # fmt: skip


def test_only_what_was_watched_can_be_told():
    with pytest.raises(ValueError, match="observe=True"):
        simulation_of([], observe=False).report()
