"""Snapshots along a run, near enough to one another to get to any tick quickly, few enough to fit a bound of memory."""

from __future__ import annotations

from bisect import bisect_right

from engine.core.snapshot import Snapshot

POINTER_BYTES = 8


class Keyframes:
    """Keeps a snapshot every `spacing` ticks from the first; where they outgrow `memory_bytes`, every second one goes.

    The first is always kept: every tick of the run stays in reach.
    """

    def __init__(self, first: Snapshot, spacing: int, memory_bytes: int):
        self.spacing = spacing
        self.memory_bytes = memory_bytes
        self._kept = [first]

    @property
    def first_tick(self) -> int:
        return self._kept[0].tick

    @property
    def ticks(self) -> list[int]:
        return [snapshot.tick for snapshot in self._kept]

    @property
    def used_bytes(self) -> int:
        """Events are shared between snapshots: each costs a pointer."""
        return sum(len(snapshot.state) + POINTER_BYTES * len(snapshot.events) for snapshot in self._kept)

    def wants(self, tick: int) -> bool:
        """Whether a snapshot of this tick would be kept: it is on the grid, and new."""
        return tick > self._kept[-1].tick and (tick - self.first_tick) % self.spacing == 0

    def keep(self, snapshot: Snapshot) -> None:
        self._kept.append(snapshot)
        while self.used_bytes > self.memory_bytes and len(self._kept) > 1:
            self.spacing *= 2
            self._kept = [kept for kept in self._kept if (kept.tick - self.first_tick) % self.spacing == 0]

    def latest_until(self, tick: int) -> Snapshot:
        """The snapshot of this tick or the nearest before it."""
        return self._kept[bisect_right(self._kept, tick, key=lambda kept: kept.tick) - 1]

    def forget_after(self, tick: int) -> None:
        """The future has changed: what was kept of it no longer holds."""
        self._kept = [kept for kept in self._kept if kept.tick <= tick]
