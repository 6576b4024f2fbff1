"""The world: all the state there is, in columns. Systems read and write it and remember nothing themselves, so saving,
rewinding, comparing and replaying are written once, here, and hold for everything.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from engine.core.component import Component, column, schema_text
from engine.core.events import Event, EventLog
from engine.core.random import Stream, Streams
from engine.core.rows import ROW_MASK, DeadEntity, Rows
from engine.core.snapshot import Snapshot, pack, schema_key, state_digest, unpack
from engine.core.table import Columns, Table

# all that a declaration of components and a world need is imported from here
__all__ = ["Columns", "Component", "DeadEntity", "Event", "Snapshot", "UndeclaredAccess", "World", "column"]

FIRST_CAPACITY = 16


class UndeclaredAccess(LookupError):
    """A component that the world does not have, or that the running system did not declare."""


class World:
    """Entities with components, a tick, events and chance.

    `components`: every component class there can be; their order fixes the order in the digest and in files.
    `assets`: what never changes and is shared by all ticks (clips, bodies, settings, models): no state, in no snapshot.
    """

    __slots__ = ("_open", "_queries", "_rows", "_streams", "_tables", "_writable",
                 "assets", "components", "events", "schema", "seed", "tick")  # fmt: skip

    def __init__(self, components: Iterable[type[Component]], seed: int = 0, assets: Any = None):
        self.components = tuple(components)
        names = [component.__name__ for component in self.components]
        if len(set(names)) != len(names):
            raise ValueError(f"two components of one name in {', '.join(names)}")
        self.tick = 0
        self.seed = int(seed)
        self.assets: Any = {} if assets is None else assets
        self.events = EventLog()
        self.schema = schema_key(schema_text(self.components))
        self._rows = Rows(FIRST_CAPACITY)
        self._streams = Streams(self.seed)
        self._tables = {component: Table(component, FIRST_CAPACITY) for component in self.components}
        self._queries: dict[Any, np.ndarray] = {}
        self.permit(None, None)

    # --- columns and queries -------------------------------------------------------------------------------------

    def __getitem__(self, component: type[Component]) -> Columns:
        """The whole columns of a component, indexed by row number."""
        return self._open[component]

    def rows(self, *components: type[Component], without: tuple[type[Component], ...] = ()) -> np.ndarray:
        """Ascending row numbers (int64) of the entities that have all these components and none of those `without`."""
        key = (components, without)
        found = self._queries.get(key)
        if found is None:
            found = self._queries[key] = self._find(components, without)
        elif self._writable is not None:
            self._check_readable((*components, *without))
        return found.copy()  # the caller may do with it as he likes

    def _find(self, components: tuple[type[Component], ...], without: tuple[type[Component], ...]) -> np.ndarray:
        mask = self._rows.alive.copy()
        for component in components:
            mask &= self._open[component].present
        for component in without:
            mask &= ~self._open[component].present
        return np.flatnonzero(mask)

    # --- entities ------------------------------------------------------------------------------------------------

    def spawn(self, *components: Component) -> int:
        """A new entity with these components, in the lowest free row; its handle. Take columns anew afterwards."""
        kinds = [type(component) for component in components]
        if len(set(kinds)) != len(kinds):
            raise ValueError("an entity has at most one component of a kind")
        self._check_writable(kinds)
        row = self._rows.next_free()
        if row == self._rows.capacity:
            self._grow(2 * self._rows.capacity)
        handle = self._rows.occupy(row)
        for component in components:
            self._tables[type(component)].put(row, component)
        self._queries.clear()
        return handle

    def despawn(self, entity: int) -> None:
        """Take an entity with all it has out of the world. DeadEntity if it is not in it."""
        row = self.row(entity)
        owned = [component for component, table in self._tables.items() if table.has(row)]
        self._check_writable(owned)
        for component in owned:
            self._tables[component].clear(row)
        self._rows.free(row)
        self._queries.clear()

    def add(self, entity: int, component: Component) -> None:
        """Give an entity a component; ValueError if it has one of that kind already (write into its column instead)."""
        row, kind = self.row(entity), type(component)
        self._check_writable([kind])
        if self._tables[kind].has(row):
            raise ValueError(f"row {row} already has {kind.__name__}")
        self._tables[kind].put(row, component)
        self._queries.clear()

    def remove(self, entity: int, component: type[Component]) -> None:
        """Take a component from an entity; ValueError if it has none."""
        row = self.row(entity)
        self._check_writable([component])
        if not self._tables[component].has(row):
            raise ValueError(f"row {row} has no {component.__name__}")
        self._tables[component].clear(row)
        self._queries.clear()

    def has(self, entity: int, component: type[Component]) -> bool:
        return bool(self._open[component].present[self.row(entity)])

    def alive(self, entity: int) -> bool:
        return self._rows.is_alive(entity)

    def row(self, entity: int) -> int:
        """The row of a living entity. DeadEntity for any other."""
        if not self._rows.is_alive(entity):
            raise DeadEntity(
                f"entity {entity} (row {entity & ROW_MASK}, generation {entity >> 32}) is not in the world"
            )
        return entity & ROW_MASK

    def entity(self, row: int) -> int:
        """The handle of whoever lives in a row. DeadEntity if nobody does."""
        return self._rows.handle(int(row))

    def __len__(self) -> int:
        """How many entities live."""
        return int(self._rows.alive.sum())

    def table(self, component: type[Component]) -> Table:
        """The storage behind a component, for the tools of this package: comparing, checking, saving."""
        return self._tables[component]

    def _grow(self, capacity: int) -> None:
        self._rows.grow(capacity)
        for table in self._tables.values():
            table.grow(capacity)

    # --- events and chance ---------------------------------------------------------------------------------------

    def emit(self, kind: str, entity: int | None = None, **data: Any) -> Event:
        """Say that something happened now. `data`: text, finite numbers, tuples of them."""
        return self.events.append(self.tick, kind, entity, data)

    def random(self, name: str) -> Stream:
        """The stream of chance of this name. Opening it changes nothing; drawing from it does."""
        return self._streams.named(name)

    # --- the whole state -----------------------------------------------------------------------------------------

    def digest(self) -> str:
        """128 bits of SHA-256 over the whole state, as hex. Equal state gives equal digests, whatever way led to it."""
        return state_digest(pack(self))

    def snapshot(self) -> Snapshot:
        """All state, immutable, independent of this world's later life."""
        return Snapshot(pack(self), tuple(self.events))

    def restore(self, snapshot: Snapshot) -> None:
        """Be as at the snapshot, bit for bit. ValueError if it was taken from a world of other components or seed."""
        unpack(self, snapshot)

    # --- what the running system may touch -----------------------------------------------------------------------

    def permit(self, readable: frozenset[type[Component]] | None, writable: frozenset[type[Component]] | None) -> None:
        """Limit access to these components; None lifts the limit. The checked schedule calls this around a system."""
        seen = self._tables if readable is None else {c: self._tables[c] for c in self.components if c in readable}
        self._open = _Open({component: table.columns for component, table in seen.items()})
        self._writable = writable

    def _check_writable(self, components: Iterable[type[Component]]) -> None:
        for component in components:
            if component not in self._tables or (self._writable is not None and component not in self._writable):
                raise _refusal(component, "writes")

    def _check_readable(self, components: Iterable[type[Component]]) -> None:
        for component in components:
            self._open[component]


class _Open(dict):
    """Components that may be looked at; any other is refused with a reason."""

    def __missing__(self, component: Any) -> Columns:
        raise _refusal(component, "reads")


def _refusal(component: Any, verb: str) -> UndeclaredAccess:
    name = getattr(component, "__name__", component)
    return UndeclaredAccess(f"{name} is no component of this world, or not among the running system's {verb}")
