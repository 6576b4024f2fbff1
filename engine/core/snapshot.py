"""The whole state of a world as one canonical run of bytes: hashed it is the digest, kept a snapshot, stored a file.

Canonical: nothing in it depends on how the state came about, not on the order of dictionaries, the capacity of columns,
or what rows that nobody owns happen to hold.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, NamedTuple

from engine.core.events import CHAIN_BYTES, Event, chain_of, events_from_json, events_to_json
from engine.core.reader import Reader, block, integer

if TYPE_CHECKING:
    from engine.core.world import World

DIGEST_BYTES = 16
SCHEMA_BYTES = 16


class Snapshot(NamedTuple):
    """A state. Equal snapshots are equal states; `state` alone decides the digest, as it holds the events' hash."""

    state: bytes
    events: tuple[Event, ...]

    @property
    def digest(self) -> str:
        return state_digest(self.state)

    @property
    def tick(self) -> int:
        return int.from_bytes(self.state[SCHEMA_BYTES : SCHEMA_BYTES + 8], "little", signed=True)

    def to_bytes(self) -> bytes:
        return block(self.state) + block(events_to_json(self.events))

    @staticmethod
    def from_bytes(data: bytes) -> Snapshot:
        """ValueError where the bytes are no snapshot."""
        reader = Reader(data)
        state, events = reader.block(), events_from_json(reader.block())
        reader.finish()
        if state[-CHAIN_BYTES:] != chain_of(events):
            raise ValueError("the events are not those that the state was made with")
        return Snapshot(state, events)


def schema_key(text: str) -> bytes:
    return hashlib.sha256(text.encode()).digest()[:SCHEMA_BYTES]


def state_digest(state: bytes) -> str:
    # SHA-256 has its own instructions in today's processors: 20 KB in 11 us, where blake2b takes 26
    return hashlib.sha256(state).hexdigest()[: 2 * DIGEST_BYTES]


def pack(world: World) -> bytes:
    """Schema, tick, seed, the register of rows, every component in declared order, chance, events."""
    parts = [world.schema, integer(world.tick), integer(world.seed)]
    parts += world._rows.parts()
    for table in world._tables.values():
        parts += table.parts()
    parts += world._streams.parts()
    parts += world.events.parts()
    return b"".join(parts)


def unpack(world: World, snapshot: Snapshot) -> None:
    """The other way. ValueError, before anything was touched, if the snapshot belongs to another kind of world."""
    reader = Reader(snapshot.state)
    if reader.take(SCHEMA_BYTES) != world.schema:
        raise ValueError("the snapshot was taken from a world of other components")
    tick, seed = reader.integer(), reader.integer()
    if seed != world.seed:
        raise ValueError(f"the snapshot was taken with seed {seed}, this world has {world.seed}")
    world.tick = tick
    world._rows.read(reader)
    world._grow(world._rows.capacity)
    for table in world._tables.values():
        table.read(reader)
    world._streams.read(reader)
    world.events.read(reader, snapshot.events)
    reader.finish()
    world._queries.clear()
