"""Holding a system to its word: it touches what it declared, and leaves finite numbers behind.

Undeclared components are refused when asked for. Writes to components declared as read only are found by comparing them
before and after, not by read-only arrays, since Numba would compile every kernel a second time for those.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from engine.core.table import Table

if TYPE_CHECKING:
    from engine.core.component import Component
    from engine.core.schedule import Declaration, System
    from engine.core.world import World


class UndeclaredWrite(RuntimeError):
    """A system changed a component that it declared only to read."""


class NonFinite(ArithmeticError):
    """A system left a NaN or an infinity: `component`, `field`, `row`, `system`, `tick` say where."""

    def __init__(self, component: str, field: str, row: int, system: str, tick: int):
        super().__init__(f"{component}.{field} of row {row} is not finite after {system} at tick {tick}")
        self.component, self.field, self.row, self.system, self.tick = component, field, row, system, tick


def run_checked(function: System, declaration: Declaration, world: World) -> None:
    """Run one system under guard. UndeclaredAccess, UndeclaredWrite or NonFinite where it broke its word."""
    name, tick = getattr(function, "__name__", repr(function)), world.tick
    reads_only = [c for c in world.components if c in declaration.reads - declaration.writes]
    before = {component: _state(world.table(component)) for component in reads_only}
    world.permit(declaration.reads | declaration.writes, declaration.writes)
    try:
        function(world, tick)
    finally:
        world.permit(None, None)
    for component in reads_only:
        if _state(world.table(component)) != before[component]:
            raise UndeclaredWrite(f"{name} changed {component.__name__} at tick {tick}, which it declares only to read")
    for component in world.components:
        if component in declaration.writes and (found := first_non_finite(world, component)):
            raise NonFinite(component.__name__, *found, name, tick)


def first_non_finite(world: World, component: type[Component]) -> tuple[str, int] | None:
    """The field and row of the first NaN or infinity among a component's present rows; None if all is well."""
    table = world.table(component)
    for field, array in zip(component.columns, table.arrays(), strict=True):
        if array.dtype.kind == "f":
            finite = np.isfinite(array[table.rows])
            if not finite.all():
                return field, int(table.rows[np.argwhere(~finite)[0, 0]])
    return None


def _state(table: Table) -> bytes:
    parts: list[Any] = table.parts()
    return b"".join(parts)
