"""The storage of one component: a struct of arrays with one row per entity of the world, and who has a row."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from engine.core.component import Component
from engine.core.reader import Reader


class Columns:
    """What a system sees of a component: `.field` is the whole column, row axis first; `.present` tells which count.

    A column grows by being replaced: take it anew after anything was spawned.
    """

    if TYPE_CHECKING:

        def __getattr__(self, field: str) -> np.ndarray: ...

    def __setattr__(self, field: str, value: Any) -> None:
        # `columns.field += x` ends here too, having worked in place: nothing left to do
        if self.__dict__.get(field) is not value:
            raise AttributeError(f"write into the column, columns.{field}[rows] = ..., instead of replacing it")


class Table:
    """One component's columns. Rows without the component hold the fields' fill and are no part of the state."""

    __slots__ = ("_present", "_views", "columns", "component", "rows")

    def __init__(self, component: type[Component], capacity: int):
        self.component = component
        self._views: list[Any] | None = None  # what `parts` gives, while it need not be gathered
        self.columns = Columns()
        self._present = np.zeros(0, bool)
        self.grow(capacity)
        self._changed()

    def arrays(self) -> list[np.ndarray]:
        """The columns in declared order."""
        inside = vars(self.columns)
        return [inside[name] for name in self.component.columns]

    def grow(self, capacity: int) -> None:
        """Room for this many rows; what is there stays."""
        if capacity == len(self._present):
            return
        inside = vars(self.columns)
        for name, declared in self.component.columns.items():
            larger = np.empty((capacity, *declared.shape), declared.dtype)
            larger[:] = declared.fill
            if name in inside:
                larger[: len(inside[name])] = inside[name]
            inside[name] = larger
        present = np.zeros(capacity, bool)
        present[: len(self._present)] = self._present
        self._show_present(present)
        self._views = None

    def has(self, row: int) -> bool:
        return bool(self._present[row])

    def put(self, row: int, value: Component) -> None:
        """Give a row this component with these values."""
        for name, array in zip(self.component.columns, self.arrays(), strict=True):
            array[row] = getattr(value, name)
        self._present[row] = True
        self._changed()

    def clear(self, row: int) -> None:
        """Take the component away from a row, leaving nothing of it behind."""
        for declared, array in zip(self.component.columns.values(), self.arrays(), strict=True):
            array[row] = declared.fill
        self._present[row] = False
        self._changed()

    def parts(self) -> list[Any]:
        """Buffers that joined are this component's state: how many rows, which, and each column of those rows alone."""
        if self._views is None:
            self._views = self._contiguous_views()
        if self._views:
            return self._views
        rows = self.rows
        return [_count(rows), rows, *(array.take(rows, axis=0) for array in self.arrays())]

    def read(self, reader: Reader) -> None:
        """Become what `parts` said; columns keep their identity, absent rows their fill."""
        rows = reader.array(np.int64, (reader.integer(),))
        for declared, array in zip(self.component.columns.values(), self.arrays(), strict=True):
            array[:] = declared.fill
            array[rows] = reader.array(declared.dtype, (len(rows), *declared.shape))
        self._present[:] = False
        self._present[rows] = True
        self._changed()

    def _changed(self) -> None:
        self.rows = np.flatnonzero(self._present)
        self._views = None

    def _contiguous_views(self) -> list[Any]:
        """Live memory views if the present rows are neighbours, which most components' are; else an empty list."""
        rows = self.rows
        if not len(rows):
            return [_count(rows)]
        first, last = int(rows[0]), int(rows[-1])
        if last - first + 1 != len(rows):
            return []
        # the stubs of NumPy do not know its arrays for buffers before Python 3.12
        columns = (memoryview(array[first : last + 1]).cast("B") for array in self.arrays() if array.size)  # type: ignore
        return [_count(rows), rows.tobytes(), *columns]

    def _show_present(self, present: np.ndarray) -> None:
        self._present = present
        shown = present.view()
        shown.flags.writeable = False
        vars(self.columns)["present"] = shown


def _count(rows: np.ndarray) -> bytes:
    return len(rows).to_bytes(8, "little")
