"""Where two states differ, in words: what a digest cannot say."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from engine.core.snapshot import Snapshot
from engine.core.world import World


def first_difference(world: World, here: Snapshot, there: Snapshot) -> str | None:
    """The first component, field and row in which two snapshots of worlds like this one differ; None if nowhere."""
    if here == there:
        return None
    left, right = _world_at(world, here), _world_at(world, there)
    if left.tick != right.tick:
        return f"tick {left.tick} here, {right.tick} there"
    for component in world.components:
        if found := _first_in(left, right, component):
            return f"{component.__name__}{found}"
    return _first_event(here, there) or "entities, their generations, or random streams"


def assert_rewinds(world: World, step: Callable[[World], Any]) -> None:
    """Step, go back, step again: the world must end up with the same bits, or AssertionError says where it did not."""
    before = world.snapshot()
    step(world)
    once = world.snapshot()
    world.restore(before)
    step(world)
    if found := first_difference(world, once, world.snapshot()):
        raise AssertionError(f"tick {before.tick} run twice differs: {found}")


def _world_at(like: World, snapshot: Snapshot) -> World:
    world = World(like.components, like.seed)
    world.restore(snapshot)
    return world


def _first_in(left: World, right: World, component: Any) -> str | None:
    rows = left.rows(component)
    if not np.array_equal(rows, right.rows(component)):
        return f" is on rows {rows.tolist()} here, {right.rows(component).tolist()} there"
    for field in component.columns:
        here, there = getattr(left[component], field)[rows], getattr(right[component], field)[rows]
        for row, mine, other in zip(rows, here, there, strict=True):
            if mine.tobytes() != other.tobytes():
                return f".{field} of row {row}: {mine.tolist()} here, {other.tolist()} there"
    return None


def _first_event(here: Snapshot, there: Snapshot) -> str | None:
    for mine, other in zip(here.events, there.events, strict=False):
        if mine != other:
            return f"events: {mine} here, {other} there"
    if len(here.events) != len(there.events):
        return f"{len(here.events)} events here, {len(there.events)} there"
    return None
