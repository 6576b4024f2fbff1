"""What is taken away from the window runs to the very same state."""

import json

import pytest

from behaviours.scenario import load_scenario
from demos.cli import main
from demos.running import open_scenario
from demos.window.saving import save_replay, save_scenario, scenario_text
from demos.window.session import Session
from engine.core.errors import BadInput
from engine.core.journal_file import load_journal


@pytest.fixture
def played(tmp_path) -> Session:
    """A run with a throw by hand, a threat, and rules and stance of its own."""
    session = Session(*open_scenario("sway"), tmp_path, lambda: 0.0)
    session.slow_motion.enabled = False
    for frame in range(80):
        if frame == 30:
            session.command({
                "do": "throw", "at": 0, "position_m": [4.0, 0.3, 1.7], "velocity_mps": [-20.0, -1.0, 1.0 / 3.0],
                "kind": "volleyball", "size": 0.5,
            })  # fmt: skip
        if frame == 50:
            session.threat.azimuth_deg = -37.5
            session.send()
        session.advance(1 / 60)
    session.change_setting("block.offset_m", 0.11)
    session.change_setting("lean_turn.neck_deg", [40.0, 50.0, 65.0])
    session.change_character(boldness=-0.5, stance={"set": "posture", "intensity": 0.4}, recover="same")
    session.advance(1 / 60)
    return session


def test_a_saved_scenario_reacts_to_the_same_digest(played, tmp_path, capsys):
    path = save_scenario(played.run, tmp_path, played.folder)
    assert main(["react", str(path), "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["ticks"] == played.run.last_tick
    assert report["digest"] == played.run.timeline.journal.digest_at(played.run.last_tick)
    assert report["digest"] in path.read_text()


def test_it_is_the_same_after_going_back(played, tmp_path):
    last = played.run.last_tick
    before = scenario_text(played.run, played.folder)
    played.seek(40)
    assert scenario_text(played.run, played.folder) == before
    assert load_scenario(save_scenario(played.run, tmp_path, played.folder)).duration_s * 120 == pytest.approx(last)


def test_a_saved_recording_replays(played, tmp_path, capsys):
    path = save_replay(played.run, tmp_path)
    assert main(["replay", str(path), "--check"]) == 0
    assert load_journal(path).last_tick == played.run.last_tick


def test_a_saved_scenario_opens_in_the_window_again(played, tmp_path):
    path = save_scenario(played.run, tmp_path, played.folder)
    again = Session(*open_scenario(str(path)), tmp_path, lambda: 0.0)
    assert again.run.inputs == played.run.inputs
    while again.tick < played.run.last_tick:
        again.run.advance()
    assert again.world.digest() == played.run.timeline.journal.digest_at(again.tick)


def test_nothing_is_saved_of_no_run(tmp_path):
    session = Session(*open_scenario("sway"), tmp_path, lambda: 0.0)
    with pytest.raises(BadInput, match="more than 0"):
        save_scenario(session.run, tmp_path, session.folder)
    assert list(tmp_path.iterdir()) == []
