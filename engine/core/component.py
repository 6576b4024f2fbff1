"""How a component, one kind of fact about an entity, is declared: a class whose fields are typed columns.

    class Flight(Component):
        '''A body in free flight.'''
        position_m = column(3)                # float64, one row of three per entity
        orientation = column(4, fill=(1, 0, 0, 0))
        struck = column(dtype=bool)

An instance is one row on its way into a world: `Flight(position_m=(0, 0, 1))`. Fields left out take their `fill`.
"""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple

import numpy as np

# names that the view of a component's columns needs for itself
RESERVED = frozenset({"present"})


class Column(NamedTuple):
    """The declaration of one field: the shape and type of a single row's value, and what it is when left out."""

    shape: tuple[int, ...]
    dtype: np.dtype
    fill: np.ndarray  # of `shape`


def column(*shape: int, dtype: Any = np.float64, fill: Any = 0) -> Any:
    """Declare a field whose value for one row has this shape (none: a scalar). Booleans, integers and floats only."""
    kind = np.dtype(dtype)
    if kind.kind not in "biuf":
        raise TypeError(f"a column holds booleans, integers or floats, not {kind}: keep other things in world.assets")
    return Column(shape, kind, np.broadcast_to(np.asarray(fill).astype(kind), shape).copy())


class Component:
    """Base of every declared row type. `columns` maps field names to declarations, in the order written."""

    columns: ClassVar[dict[str, Column]] = {}

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Column)}
        if wrong := RESERVED & own.keys():
            raise TypeError(f"{cls.__name__}: a column cannot be called {', '.join(sorted(wrong))}")
        cls.columns = {**cls.columns, **own}

    def __init__(self, **values: Any) -> None:
        unknown = [name for name in values if name not in self.columns]
        if unknown:
            known = ", ".join(self.columns) or "none"
            raise TypeError(f"{type(self).__name__} has no column {', '.join(unknown)}; its columns are {known}")
        for name, declared in self.columns.items():
            given = values.get(name, declared.fill)
            setattr(self, name, _as_declared(given, declared, f"{type(self).__name__}.{name}"))

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={getattr(self, name).tolist()}" for name in self.columns)
        return f"{type(self).__name__}({inside})"


def _as_declared(given: Any, declared: Column, name: str) -> np.ndarray:
    """A value as an array of the declared shape and type. TypeError: another shape, or meaning would be lost."""
    value = np.asarray(given)
    if value.shape != declared.shape:
        raise TypeError(f"{name} has shape {value.shape}, expected {declared.shape}")
    converted = value.astype(declared.dtype)
    if not np.can_cast(value.dtype, declared.dtype, "same_kind") and not np.array_equal(converted, value):
        raise TypeError(f"{name} = {given!r} does not fit a column of {declared.dtype}")
    return converted


def schema_text(components: tuple[type[Component], ...]) -> str:
    """Every component, field, shape and type in declared order: two worlds with the same text hold the same state."""
    lines = []
    for component in components:
        fields = (f"{name}:{declared.dtype.str}{declared.shape}" for name, declared in component.columns.items())
        lines.append(f"{component.__name__}({' '.join(fields)})")
    return "\n".join(lines)
