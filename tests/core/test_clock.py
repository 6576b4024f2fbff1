"""Real time in, whole ticks out: nothing lost, nothing doubled, and never more than 250 ms at once."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.core.clock import TICK_RATE_HZ, Clock, seconds, ticks

FRAMES_S = st.lists(st.floats(0.0, 0.24), max_size=200)


@given(FRAMES_S)
def test_ticks_are_the_real_time_that_has_passed(frames_s):
    clock = Clock()
    total = 0
    for frame_s in frames_s:
        total += clock.ticks_due(frame_s)
        assert 0.0 <= clock.alpha < 1.0
    passed = math.fsum(frames_s) * TICK_RATE_HZ
    assert math.isclose(total + clock.alpha, passed, abs_tol=1e-6)
    assert clock.dropped_s == 0.0


@pytest.mark.parametrize("hertz", [24, 30, 60, 120])
def test_frames_of_whole_ticks_give_the_same_number_each(hertz):
    clock = Clock()
    assert {clock.ticks_due(1.0 / hertz) for _ in range(10_000)} == {TICK_RATE_HZ // hertz}


def test_a_144_hz_screen_gets_no_tick_now_and_then():
    clock = Clock()
    due = [clock.ticks_due(1.0 / 144.0) for _ in range(1440)]
    assert set(due) == {0, 1}
    assert sum(due) == 1200


def test_after_a_hitch_it_catches_up_250_ms_and_then_slows_down():
    clock = Clock()
    assert clock.ticks_due(3.0) == 30
    assert clock.dropped_s == pytest.approx(2.75)
    assert clock.ticks_due(1.0 / 60.0) == 2  # and owes nothing from before
    assert clock.ticks_due(0.25) == 30


def test_slow_motion_gives_fewer_ticks_and_alpha_in_between():
    clock = Clock(rate=0.25)
    alphas = []
    due = []
    for _ in range(4):
        due.append(clock.ticks_due(1.0 / 120.0))
        alphas.append(clock.alpha)
    assert due == [0, 0, 0, 1]
    assert alphas == pytest.approx([0.25, 0.5, 0.75, 0.0], abs=1e-9)


def test_paused_no_time_passes_but_single_steps_do():
    clock = Clock(paused=True)
    assert clock.ticks_due(10.0) == 0
    clock.step()
    clock.step(2)
    assert clock.ticks_due(0.1) == 3
    assert clock.alpha == 0.0
    assert clock.ticks_due(0.1) == 0
    clock.paused = False
    assert clock.ticks_due(1.0 / 120.0) == 1
    assert clock.dropped_s == 0.0


@pytest.mark.parametrize("nonsense_s", [-1.0, math.nan, math.inf, -math.inf])
def test_a_clock_that_was_set_back_is_no_time(nonsense_s):
    clock = Clock()
    clock.ticks_due(0.004)
    before = clock.alpha
    assert clock.ticks_due(nonsense_s) == 0
    assert clock.alpha == before


@given(st.integers(0, 10_000_000))
def test_seconds_and_ticks_are_inverse(tick):
    assert ticks(seconds(tick)) == tick
