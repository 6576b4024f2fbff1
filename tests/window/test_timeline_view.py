"""Ticks to places on the timeline and back."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from demos.window.timeline_view import LEAST_S, MOST_S, TimelineView

TICKS = st.integers(0, 70000)


@given(first=TICKS, span=st.floats(240, 14400), share=st.floats(0, 1), width=st.floats(100, 4000))
def test_a_place_is_the_place_of_its_tick(first, span, share, width):
    view = TimelineView(first, span)
    tick = view.tick_at(share * width, width)
    assert view.x_of(tick, width) == pytest.approx(share * width, abs=0.51 * width / span)


@given(first=TICKS, share=st.floats(0, 1), steps=st.integers(-60, 60))
def test_zooming_keeps_what_is_under_the_cursor_and_stays_within_bounds(first, share, steps):
    view = TimelineView(first, 1200.0)
    under = view.first + share * view.span
    view.zoom(steps, share)
    assert LEAST_S * 120 <= view.span <= MOST_S * 120
    assert view.first == pytest.approx(max(0.0, under - share * view.span))


@given(tick=TICKS, more=st.integers(0, 5000), first=TICKS)
def test_the_moment_that_is_shown_is_always_in_sight(tick, more, first):
    view = TimelineView(first)
    view.keep_up(tick, tick + more)
    assert view.first >= 0.0
    assert view.first <= tick <= view.first + view.span


def test_a_short_run_is_shown_from_its_start():
    view = TimelineView()
    view.keep_up(300, 400)
    assert view.first == 0.0


@given(first=TICKS, span=st.floats(240, 14400))
def test_written_moments_lie_in_sight_and_are_few(first, span):
    view = TimelineView(first, span)
    marks = view.seconds_marks()
    assert 1 <= len(marks) <= 14
    assert all(-1e-6 <= view.x_of(120 * mark, 1.0) <= 1.0 + 1e-6 for mark in marks)
