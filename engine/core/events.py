"""What happened, in order: the account that reports, plots and sounds are made from.

An event says things in plain values (text, numbers, tuples of them), so that it can be printed, saved and compared.
Events are part of the state: the log keeps a chain of hashes, each event's over all before it, so that the digest of a
long history costs nothing.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator
from typing import Any, NamedTuple, overload

import numpy as np

from engine.core.reader import Reader, integer

CHAIN_BYTES = 32  # SHA-256
NO_HISTORY = bytes(CHAIN_BYTES)


class Event(NamedTuple):
    """At this tick, this happened, to this entity (None: to nobody in particular)."""

    tick: int
    kind: str
    entity: int | None
    data: dict[str, Any]


class EventLog:
    """Append-only. Reads like a list: length, index, slice, iteration."""

    __slots__ = ("_chain", "_events")

    def __init__(self) -> None:
        self._events: list[Event] = []
        self._chain = NO_HISTORY

    def append(self, tick: int, kind: str, entity: int | None, data: dict[str, Any]) -> Event:
        """Keep an event. TypeError or ValueError where its data are no plain finite values."""
        plain_data = {name: plain(data[name]) for name in sorted(data)}
        event = Event(tick, kind, None if entity is None else int(entity), plain_data)
        self._chain = hashlib.sha256(self._chain + _encode(event)).digest()
        self._events.append(event)
        return event

    @overload
    def __getitem__(self, index: int) -> Event: ...
    @overload
    def __getitem__(self, index: slice) -> list[Event]: ...
    def __getitem__(self, index: int | slice) -> Event | list[Event]:
        return self._events[index]

    def __len__(self) -> int:
        return len(self._events)

    def __iter__(self) -> Iterator[Event]:
        return iter(self._events)

    def parts(self) -> list[bytes]:
        """What the digest needs: how many, and the chain."""
        return [integer(len(self._events)), self._chain]

    def read(self, reader: Reader, events: tuple[Event, ...]) -> None:
        """Become a log of these events, whose count and chain the reader holds. ValueError: another number of them."""
        count, chain = reader.integer(), reader.take(CHAIN_BYTES)
        if count != len(events):
            raise ValueError(f"{len(events)} events where the state counts {count}")
        self._events = list(events)
        self._chain = chain


def plain(value: Any) -> Any:
    """Text, truth, whole and finite numbers and None as they are; NumPy's as Python's; lists and arrays as tuples."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return tuple(plain(item) for item in value)
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(f"an event cannot hold {value}")
        return float(value)
    if value is None or isinstance(value, str | bool):
        return value
    if isinstance(value, int):
        return int(value)
    raise TypeError(f"an event holds text, numbers and tuples of them, not {type(value).__name__}")


def events_to_json(events: tuple[Event, ...] | list[Event]) -> bytes:
    return json.dumps(events, separators=(",", ":"), allow_nan=False).encode()


def events_from_json(data: bytes) -> tuple[Event, ...]:
    """ValueError where the text holds anything else than events."""
    try:
        rows = json.loads(data)
        return tuple(
            Event(tick, kind, entity, {name: plain(value) for name, value in facts.items()})
            for tick, kind, entity, facts in rows
        )
    except (TypeError, AttributeError) as trouble:
        raise ValueError(f"no list of events: {trouble}") from trouble


def chain_of(events: tuple[Event, ...]) -> bytes:
    """The chain that a log of exactly these events has."""
    chain = NO_HISTORY
    for event in events:
        chain = hashlib.sha256(chain + _encode(event)).digest()
    return chain


def _encode(event: Event) -> bytes:
    return json.dumps(event, separators=(",", ":"), allow_nan=False).encode()
