"""Any tick of a run is in reach, with the bits that it had; the past can be given another future."""

from __future__ import annotations

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from engine.core.compare import assert_rewinds, first_difference
from engine.core.errors import ReplayDiverged
from engine.core.keyframes import Keyframes
from engine.core.recorder import new_journal
from engine.core.timeline import Timeline
from tests.core.toy_world import Flight, throw, toy

THROW = {"height_m": 1.0, "speed_mps": [1.0, 0.0, 0.5]}


def _timeline(ticks=0, throws=(), **options):
    world, step = toy()
    timeline = Timeline(world, step, throw, new_journal({}, world), **options)
    for tick in range(ticks):
        if tick in throws:
            timeline.command(THROW)
        timeline.advance()
    return timeline


def test_every_tick_is_reached_in_any_order_with_its_bits():
    straight = _timeline()
    digests = [straight.world.digest()]
    for tick in range(130):
        if tick in (0, 60, 100):
            straight.command(THROW)
        straight.advance()
        digests.append(straight.world.digest())
    timeline = _timeline(130, throws=(0, 60, 100))
    for tick in [0, 130, 60, 61, 59, 30, 29, 31, 1, 129, *range(130, -1, -7)]:
        timeline.seek(tick)
        assert timeline.world.tick == tick
        assert timeline.world.digest() == digests[tick]


def test_stepping_back_stops_at_the_start_and_seeking_at_the_end():
    timeline = _timeline(10)
    timeline.step_back()
    assert timeline.world.tick == 9
    timeline.step_back(50)
    assert timeline.world.tick == 0
    timeline.seek(99)
    assert timeline.world.tick == 10
    assert timeline.at_end


def test_going_on_after_going_back_replays_with_the_commands():
    timeline = _timeline(90, throws=(70,))
    end = timeline.world.snapshot()
    timeline.seek(20)
    while not timeline.at_end:
        timeline.advance()
    assert timeline.world.snapshot() == end


def test_a_seek_simulates_no_further_than_from_the_nearest_keyframe():
    timeline = _timeline(200)
    steps = []
    step, timeline._step = timeline._step, lambda world: (steps.append(world.tick), step(world))
    for tick, simulated in ((7, 7), (199, 19), (199, 0), (185, 5), (187, 2), (180, 0), (0, 0)):
        steps.clear()
        timeline.seek(tick)
        assert len(steps) == simulated


def test_playing_again_keeps_no_keyframe_twice():
    timeline = _timeline(100)
    timeline.seek(0)
    while not timeline.at_end:
        timeline.advance()
    assert timeline.keyframes.ticks == [0, 30, 60, 90]


def test_a_command_in_the_past_starts_another_future():
    timeline = _timeline(90, throws=(10, 70))
    timeline.seek(40)
    timeline.command(THROW)
    assert timeline.last_tick == 40
    assert timeline.keyframes.ticks == [0, 30]
    for _ in range(60):
        timeline.advance()
    other = _timeline(100, throws=(10, 40))
    assert timeline.world.snapshot() == other.world.snapshot()
    assert timeline.journal == other.journal
    timeline.seek(0)
    timeline.seek(100)
    assert timeline.world.snapshot() == other.world.snapshot()


def test_a_state_touched_from_outside_is_caught_on_the_way():
    timeline = _timeline(20)
    timeline.seek(5)
    timeline.world[Flight].position_m[0, 0] += 1.0
    with pytest.raises(ReplayDiverged, match="tick 6"):
        timeline.seek(10)


# --- keyframes -------------------------------------------------------------------------------------------------------


def test_keyframes_stay_within_their_memory_and_keep_the_start():
    one_bytes = len(_timeline().world.snapshot().state)
    timeline = _timeline(300, keyframe_ticks=1, memory_bytes=12 * one_bytes)
    frames = timeline.keyframes
    assert frames.used_bytes <= 12 * one_bytes
    assert frames.ticks[0] == 0
    assert frames.spacing in (32, 64)
    assert frames.ticks == list(range(0, 301, frames.spacing))
    digest = timeline.world.digest()
    timeline.seek(1)
    timeline.seek(300)
    assert timeline.world.digest() == digest


def test_a_bound_too_small_for_anything_keeps_the_start_alone():
    timeline = _timeline(100, keyframe_ticks=10, memory_bytes=1)
    assert timeline.keyframes.ticks == [0]
    timeline.seek(50)
    assert timeline.world.tick == 50


def test_keyframes_lie_on_a_grid_from_wherever_the_run_begins():
    world, step = toy()
    for _ in range(7):
        step(world)
    frames = Keyframes(world.snapshot(), spacing=5, memory_bytes=1 << 20)
    for _ in range(12):
        step(world)
        if frames.wants(world.tick):
            frames.keep(world.snapshot())
    assert frames.ticks == [7, 12, 17]
    assert [frames.latest_until(tick).tick for tick in (7, 11, 12, 40)] == [7, 7, 12, 17]


class TimelineMachine(RuleBasedStateMachine):
    """Running on, going anywhere and throwing at any time equals one straight run with the throws that remain."""

    def __init__(self):
        super().__init__()
        self.timeline = _timeline(keyframe_ticks=7)
        self.throws = []  # ticks

    @rule(ticks=st.integers(1, 25))
    def run_on(self, ticks):
        for _ in range(ticks):
            self.timeline.advance()

    @rule(tick=st.integers(-5, 200))
    def seek(self, tick):
        self.timeline.seek(tick)

    @rule()
    def throw(self):
        now = self.timeline.world.tick
        self.timeline.command(THROW)
        self.throws = [tick for tick in self.throws if tick <= now] + [now]

    @invariant()
    def it_is_a_straight_run(self):
        world, step = toy()
        while world.tick < self.timeline.world.tick:
            for _ in range(self.throws.count(world.tick)):
                throw(world, THROW)
            step(world)
        assert world.snapshot() == self.timeline.world.snapshot()


TestTimelineMachine = TimelineMachine.TestCase
TestTimelineMachine.settings = settings(max_examples=40, stateful_step_count=12, deadline=None)


# --- where states differ ---------------------------------------------------------------------------------------------


def test_the_place_of_a_difference_is_named():
    world, step = toy()
    before = world.snapshot()
    assert first_difference(world, before, world.snapshot()) is None
    world[Flight].velocity_mps[1, 2] = -0.0
    assert first_difference(world, before, world.snapshot()) == (
        "Flight.velocity_mps of row 1: [0.0, 0.0, 0.0] here, [0.0, 0.0, -0.0] there"
    )
    world.restore(before)
    world.emit("clap")
    assert first_difference(world, before, world.snapshot()) == "0 events here, 1 there"
    world.restore(before)
    world.remove(world.entity(2), Flight)
    assert first_difference(world, before, world.snapshot()) == "Flight is on rows [0, 1, 2] here, [0, 1] there"
    world.restore(before)
    world.random("wind").word()
    assert first_difference(world, before, world.snapshot()) == "entities, their generations, or random streams"
    world.restore(before)
    step(world)
    assert first_difference(world, before, world.snapshot()) == "tick 0 here, 1 there"


def test_a_step_that_remembers_something_itself_is_found():
    world, step = toy()
    for _ in range(60):
        assert_rewinds(world, step)
    memory = []

    def forgetful(world):
        memory.append(1)
        world[Flight].position_m[1, 0] += len(memory)
        world.tick += 1

    with pytest.raises(AssertionError, match=r"tick 60 run twice differs: Flight\.position_m of row 1"):
        assert_rewinds(world, forgetful)
