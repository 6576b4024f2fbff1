"""Events are plain, ordered, and part of the state."""

from __future__ import annotations

import json

import numpy as np
import pytest

from engine.core.events import Event, EventLog, chain_of, events_from_json, events_to_json
from engine.core.world import World


def test_an_event_says_when_what_who_and_details():
    world = World(())
    somebody = world.spawn()
    world.tick = 12
    world.emit("contact", somebody, part="head", point_m=np.array([1.0, 2.0]), count=np.int64(3), hard=np.bool_(True))
    world.emit("clap")
    assert list(world.events) == [
        Event(12, "contact", somebody, {"count": 3, "hard": True, "part": "head", "point_m": (1.0, 2.0)}),
        Event(12, "clap", None, {}),
    ]
    assert world.events[-1].kind == "clap"
    kinds = [type(value) for value in world.events[0].data.values()]
    assert kinds == [int, bool, str, tuple]
    json.dumps(list(world.events))


@pytest.mark.parametrize("wrong", [np.nan, float("inf"), (1.0, -np.inf), np.array([np.nan])])
def test_a_number_that_is_none_is_refused(wrong):
    world = World(())
    with pytest.raises(ValueError, match="an event cannot hold"):
        world.emit("contact", speed_mps=wrong)
    assert len(world.events) == 0


@pytest.mark.parametrize("wrong", [{"a": 1}, object(), {1, 2}, b"bytes"])
def test_a_value_that_is_not_plain_is_refused(wrong):
    with pytest.raises(TypeError, match="an event holds text, numbers and tuples of them"):
        World(()).emit("contact", what=wrong)


def test_the_chain_sees_content_kind_order_and_whom():
    variants = [
        [(1, "a", None, {"x": 1.0})],
        [(1, "a", None, {"x": 1})],
        [(1, "a", None, {"x": "1.0"})],
        [(1, "a", None, {"x": True})],
        [(2, "a", None, {"x": 1.0})],
        [(1, "b", None, {"x": 1.0})],
        [(1, "a", 0, {"x": 1.0})],
        [(1, "a", None, {"y": 1.0})],
        [(1, "a", None, {}), (1, "b", None, {})],
        [(1, "b", None, {}), (1, "a", None, {})],
        [],
    ]
    chains = set()
    for variant in variants:
        log = EventLog()
        for event in variant:
            log.append(*event)
        chains.add(b"".join(log.parts()))
    assert len(chains) == len(variants)


def test_the_order_in_which_details_are_given_does_not_matter():
    one, two = EventLog(), EventLog()
    one.append(0, "a", None, {"x": 1, "y": 2})
    two.append(0, "a", None, {"y": 2, "x": 1})
    assert one.parts() == two.parts()


def test_events_go_through_json_bit_for_bit():
    log = EventLog()
    log.append(3, "contact", 1 << 32, {"point_m": (0.1, -0.0, 1e-300), "part": "left hand", "nested": ((1, 2), "é")})
    log.append(4, "clap", None, {"nobody": None})
    again = events_from_json(events_to_json(list(log)))
    assert again == tuple(log)
    assert chain_of(again) == log.parts()[1]


@pytest.mark.parametrize("bad", [b"{}x", b"[1]", b"[[1,2]]", b'[[1,"a",null,3]]', b"3", b"\xff"])
def test_text_that_is_no_events_is_refused(bad):
    with pytest.raises(ValueError):
        events_from_json(bad)
