"""One figure of `brace bench --motion`: its greatest, share or median over all cases, and the case to look at."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from demos.benchmarks.motion_run import Row

Of = Callable[[Row], float | None]


class Figure(NamedTuple):
    """One figure over all cases: its greatest or other value, in the words of the bar, and where it was worst."""

    name: str
    value: float
    bar: str
    met: bool
    cases: int  # that are counted
    failing: int  # of them, those that miss the bar on their own
    worst: Row | None  # the case to look at
    counted: str = ""  # what is counted, what is left out, and why
    words: str = ""  # the worst, where it is no case

    @property
    def worst_words(self) -> str:
        return str(self.worst["case"]) if self.worst else self.words


def times(key: str, scale: float) -> Of:
    """A measure of a case in other units; None where the case has none."""
    return lambda row: None if row.get(key) is None else scale * row[key]


def greatest(rows: list[Row], name: str, limit: float | None, of: Of, counted: str = "") -> Figure:
    """The greatest value of all cases, to stay within a limit; limit None: a figure without a bar, to know.

    What is no number is over any limit.
    """
    kept, values = _values(rows, of)
    bar = "-" if limit is None else f"<= {limit:g}"
    if not kept:
        return Figure(name, float("nan"), bar, False, 0, 0, None, counted)
    over, at = (0 if limit is None else int((~(values <= limit)).sum())), int(values.argmax())
    return Figure(name, float(values[at]), bar, over == 0, len(kept), over, kept[at], counted)


def share(rows: list[Row], name: str, least: float | None, of: Of, counted: str) -> Figure:
    """Of how many cases something holds, percent; the first of which it does not is the worst. least None: no bar."""
    kept, values = _values(rows, of)
    percent = 100.0 * float(values.mean()) if kept else float("nan")
    worst = next((row for row, value in zip(kept, values, strict=True) if not value), None)
    bar, met = ("-", True) if least is None else (f">= {least:g}", percent >= least)
    return Figure(name, percent, bar, met, len(kept), int((values == 0.0).sum()), worst, counted)


def median(rows: list[Row], name: str, least: float | None, of: Of, counted: str) -> Figure:
    """The middle of all cases; the lowest is the worst. least None: no bar."""
    kept, values = _values(rows, of)
    middle = float(np.median(values)) if kept else float("nan")
    worst = kept[int(values.argmin())] if kept else None
    if least is None:
        return Figure(name, middle, "-", True, len(kept), 0, worst, counted)
    failing = int((values < least).sum())
    return Figure(name, middle, f">= {least:g}", middle >= least, len(kept), failing, worst, counted)


def _values(rows: list[Row], of: Of) -> tuple[list[Row], np.ndarray]:
    kept = [row for row in rows if of(row) is not None]
    return kept, np.array([of(row) for row in kept], float)
