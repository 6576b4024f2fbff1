"""When slow motion begins and ends."""

import pytest

from behaviours.scenario import check_scenario
from demos.window.run import ClipBox, Run
from demos.window.slow_motion import AFTER_S, LEAD_S, SLOWEST, SlowMotion, is_near_contact


def near_ticks(threat, tmp_path, ticks=260):
    raw = {"character": [{"clip": "sway"}], "threat": [{"perceived_s": 0.25, **threat}]}
    run = Run(check_scenario(raw), ClipBox(tmp_path), tmp_path, {})
    near = []
    for _ in range(ticks):
        run.advance()
        near.append(is_near_contact(run.world))
    return run, [tick + 1 for tick, here in enumerate(near) if here]


def test_it_is_just_before_the_blow_and_just_after(tmp_path):
    run, near = near_ticks({"azimuth_deg": 10.0, "speed_mps": 26.0}, tmp_path)
    contact = next(mark.tick for mark in run.history.marks if mark.kind == "contact")
    assert near == list(range(near[0], near[-1] + 1))
    assert contact - near[0] == pytest.approx(120 * LEAD_S, abs=3)
    assert 5 <= near[-1] - contact <= 120 * AFTER_S + 2


def test_it_is_the_same_when_the_moment_is_come_to_again(tmp_path):
    run, near = near_ticks({"azimuth_deg": 10.0, "speed_mps": 26.0}, tmp_path)
    for tick in (near[0] - 1, near[0], near[-1], near[-1] + 1):
        run.seek(tick)
        assert is_near_contact(run.world) == (near[0] <= tick <= near[-1])


def test_nobody_is_slowed_where_nothing_comes(tmp_path):
    run = Run(check_scenario({"character": [{"clip": "sway"}]}), ClipBox(tmp_path), tmp_path, {})
    for _ in range(100):
        run.advance()
        assert not is_near_contact(run.world)


def test_speed_changes_gently_and_reaches_both_ends(monkeypatch):
    slow, near = SlowMotion(), True
    monkeypatch.setattr("demos.window.slow_motion.is_near_contact", lambda world: near)
    shares = [slow.ease(None, 1 / 60) for _ in range(60)]
    assert shares == sorted(shares, reverse=True)
    assert shares[0] > 0.5
    assert shares[-1] == SLOWEST
    near = False
    assert [slow.ease(None, 1 / 60) for _ in range(60)][-1] == 1.0
    near, slow.enabled = True, False
    assert slow.ease(None, 1 / 60) == 1.0
