"""What panels act on, without a window: changed scenarios, going back, sending and auto-fire."""

import itertools
from types import SimpleNamespace

import numpy as np
import pytest

from behaviours.components import Flight, Phase, Threat
from behaviours.scenario import check_scenario
from demos.running import open_scenario
from demos.window.session import Session
from demos.window.status import states

FRAME_S = 1.0 / 60.0
THREAT = {"azimuth_deg": 20.0, "speed_mps": 25.0, "perceived_s": 0.3}


def session_of(raw, tmp_path, stopwatch=lambda: 0.0) -> Session:
    session = Session(check_scenario({"character": [{"clip": "sway"}], **raw}), tmp_path, tmp_path, stopwatch)
    session.slow_motion.enabled = False
    return session


@pytest.fixture
def session(tmp_path):
    return session_of({"threat": [THREAT]}, tmp_path)


def pass_time(session, frames):
    for _ in range(frames):
        session.advance(FRAME_S)


def fresh_digest(session, ticks):
    """Of the same scenario, run by itself from the start, with what came in."""
    other = Session(session.scenario, session.folder, session.save_in, lambda: 0.0)
    other.begin(session.scenario, session.run.inputs)
    for _ in range(ticks):
        other.run.advance()
    return other.world.digest()


def test_a_changed_constant_gives_the_run_that_has_it_from_the_start(session):
    pass_time(session, 40)
    before = session.world.digest()
    session.pause()
    session.change_setting("block.offset_m", 0.2)
    pass_time(session, 1)
    assert session.tick == 80
    assert session.world.digest() != before
    assert session.world.digest() == fresh_digest(session, 80)
    session.forget_settings("block")
    pass_time(session, 1)
    assert session.world.digest() == before


def test_it_is_told_how_far_a_changed_run_has_come(tmp_path):
    clock = itertools.count()
    session = session_of({}, tmp_path, lambda: 0.005 * next(clock))
    for _ in range(40):
        session.run.advance()
    session.pause()
    session.change_setting("block.offset_m", 0.2)
    told = []
    session.advance(0.0)
    while session.busy:
        told += [word for word in states(SimpleNamespace(session=session, held_s=None)) if "re-running" in word]
        assert told[-1] == f"re-running {session.rerun_share:.0%}"
        session.advance(0.0)
    shares = [int(word.split()[1][:-1]) for word in told]
    assert len(shares) > 5
    assert shares == sorted(shares)
    assert 0 <= shares[0] < 20
    assert 80 < shares[-1] <= 100


def test_throws_happen_again_under_changed_rules(session):
    pass_time(session, 10)
    session.send()
    pass_time(session, 30)
    session.pause()
    session.change_character(boldness=0.8)
    pass_time(session, 1)
    assert list(session.run.inputs) == [20]
    assert session.world.digest() == fresh_digest(session, 80)


def test_an_impossible_change_is_said_and_changes_nothing(session):
    pass_time(session, 5)
    before = session.world.digest()
    session.change_character(boldness=7.0)
    session.pause()
    session.change_setting("block.offset_m", "wide")
    pass_time(session, 1)
    assert session.world.digest() == before
    assert sum(line.alarm for line in session.toasts.lines) == 2


def test_going_back_and_forth_changes_nothing(session):
    pass_time(session, 70)
    session.pause()
    digest, history = session.world.digest(), session.run.history
    margins = list(history.pasts[0].margin_m)
    for tick in (10, 90, 3, 140):
        session.seek(tick)
        assert session.tick == tick
    assert session.world.digest() == digest
    assert history.pasts[0].margin_m == margins


def test_the_last_threat_is_changed_while_paused(session):
    pass_time(session, 45)
    session.pause()
    session.threat.azimuth_deg = -40.0
    session.alter_last_threat()
    pass_time(session, 1)
    assert session.scenario.threat[0].azimuth_deg == -40.0
    assert session.scenario.threat[0].perceived_s == 0.3
    (ball,) = session.world.rows(Flight, Threat)
    assert session.world[Flight].position_m[ball, 1] < 0.0  # from its right now
    session.clock.paused = False
    session.send()
    pass_time(session, 10)
    session.pause()
    session.threat.azimuth_deg = 60.0
    session.alter_last_threat()
    (commands,) = session._inputs().values()
    assert commands[0]["threat"]["azimuth_deg"] == 60.0
    assert session.scenario.threat[0].azimuth_deg == -40.0


def test_auto_fire_waits_for_the_clip_and_only_fires_into_the_unknown(tmp_path):
    session = session_of({}, tmp_path)
    session.auto_fire, session.auto_fire_s = True, 1.0
    pass_time(session, 240)
    fired = list(session.run.inputs)
    assert len(fired) >= 2
    phases = session.run.history.pasts[0].spans
    for tick in fired:
        assert any(span.phase == Phase.PLAY and span.first - 1 <= tick <= span.last for span in phases)
    digest = session.world.digest()
    session.seek(0)
    pass_time(session, 240)
    assert list(session.run.inputs) == fired
    assert session.world.digest() == digest


def test_another_clip_begins_afresh_and_a_missing_one_changes_nothing(session):
    pass_time(session, 30)
    session.send()
    pass_time(session, 5)
    assert not session.play_clip("nowhere.bvh")
    assert session.tick == 70
    assert session.play_clip("sway")
    assert session.tick == 0
    assert [command["do"] for commands in session.run.inputs.values() for command in commands] == ["threaten"]


def test_the_rehearsal_is_not_seen(tmp_path):
    raw = {"threat": [THREAT]}
    alone = session_of(raw, tmp_path)
    alone._rehearsal.left = 0
    seen = session_of(raw, tmp_path)
    for session in (alone, seen):
        pass_time(session, 40)
    assert seen._rehearsal.left == 0
    assert alone.world.digest() == seen.world.digest()


def test_ticks_that_do_not_fit_into_a_frame_slow_the_show_and_not_the_window(tmp_path):
    now_s = iter(np.arange(0.0, 1e4, 0.010))  # every look at the watch is ten milliseconds later: a slow machine
    session = Session(check_scenario({"character": [{"clip": "sway"}]}), tmp_path, tmp_path, lambda: float(next(now_s)))
    session._rehearsal.left = 0
    session.advance(0.2)
    assert 1 <= session.tick <= 4  # of 24 that were due
    assert session.clock.dropped_s > 0.15


def test_commands_of_a_scenario_are_inputs_of_the_window(tmp_path):
    session = session_of({"command": [{"at_s": 0.5, "threat": {"azimuth_deg": 10.0}}]}, tmp_path)
    assert list(session.run.inputs) == [60]
    pass_time(session, 40)
    assert session.phase != Phase.PLAY
    session.seek(20)
    session.send()  # another future: what was to come is gone
    assert list(session.run.inputs) == [20]


def test_everybody_of_a_crowd_has_a_history(tmp_path):
    scenario, folder = open_scenario("crowd")
    raw = scenario.model_dump(mode="json")
    raw["character"] = [{**who, "clip": "sway"} for who in raw["character"]]
    session = Session(check_scenario(raw), folder, tmp_path, lambda: 0.0)
    pass_time(session, 3)
    assert {len(past.margin_m) for past in session.run.history.pasts.values()} == {session.tick + 1}
    session.selected = 3
    assert session.row == 3
