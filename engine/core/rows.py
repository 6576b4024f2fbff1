"""Which rows of the world are somebody, and the handles by which others hold on to them.

A handle is `generation << 32 | row`. A row's generation rises each time it is reused, so that a handle to someone who
is gone never means a newcomer. Generations start at one: the handle 0 is nobody, and a fresh int64 column holds nobody.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.core.reader import Reader, integer

ROW_MASK = 0xFFFFFFFF


class DeadEntity(LookupError):
    """A handle to somebody who is not, or no longer, in the world."""


class Rows:
    """The register of entities. The lowest free row is used first, so no order of past deaths has to be remembered."""

    __slots__ = ("alive", "capacity", "count", "generation")

    def __init__(self, capacity: int):
        self.count = 0  # rows ever used
        self.capacity = capacity
        self.generation = np.zeros(capacity, np.int64)
        self.alive = np.zeros(capacity, bool)

    def next_free(self) -> int:
        """The row that the next entity gets; equals `capacity` when there is no room."""
        used = self.alive[: self.count]
        return self.count if used.all() else int(used.argmin())

    def grow(self, capacity: int) -> None:
        """Room for more."""
        self.generation = np.concatenate((self.generation, np.zeros(capacity - self.capacity, np.int64)))
        self.alive = np.concatenate((self.alive, np.zeros(capacity - self.capacity, bool)))
        self.capacity = capacity

    def occupy(self, row: int) -> int:
        """Somebody new moves in; returns the handle."""
        self.alive[row] = True
        self.generation[row] += 1
        self.count = max(self.count, row + 1)
        return self.handle(row)

    def free(self, row: int) -> None:
        self.alive[row] = False

    def handle(self, row: int) -> int:
        """The handle of whoever lives in a row now. DeadEntity if nobody does."""
        if not 0 <= row < self.count or not self.alive[row]:
            raise DeadEntity(f"nobody lives in row {row}")
        return int(self.generation[row]) << 32 | int(row)

    def is_alive(self, handle: int) -> bool:
        row = handle & ROW_MASK
        return row < self.count and bool(self.alive[row]) and int(self.generation[row]) == handle >> 32

    def parts(self) -> list[Any]:
        return [integer(self.count), self.generation[: self.count], self.alive[: self.count]]

    def read(self, reader: Reader) -> None:
        """Become what `parts` said. Rows never used there are as if never used here."""
        self.count = reader.integer()
        generation = reader.array(np.int64, (self.count,))
        if self.count > self.capacity:
            self.grow(2 * self.count)
        self.generation[:] = 0
        self.alive[:] = False
        self.generation[: self.count] = generation
        self.alive[: self.count] = reader.array(bool, (self.count,))
