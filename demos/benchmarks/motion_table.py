"""The table of `brace bench --motion`: each figure, what came out, its bar, and the case that was worst."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from behaviours.timing import TICK_S

Row = dict[str, Any]


class Figure(NamedTuple):
    """One figure over all cases: its greatest or other value, in the words of the bar, and where it was worst."""

    name: str
    value: float
    bar: str
    met: bool
    worst: Row | None  # the case to look at
    cases: int
    failing: int = 0  # how many cases miss the bar on their own


def figures_of(rows: list[Row]) -> list[Figure]:
    """All figures, in the order of the table."""
    return [
        _greatest(rows, "contact off its plan, ticks", "<= 1", 1.0, _contact_ticks),
        _greatest(rows, "planted feet slide, mm", "<= 2", 2.0, _times("foot_slide_max_m", 1e3)),
        _greatest(rows, "hands off their straight lines, mm", "<= 3", 3.0, _times("hand_line_deviation_max_m", 1e3)),
        _greatest(rows, "COM off its line, mm", "<= 5", 5.0, _times("com_line_deviation_max_m", 1e3)),
        _greatest(rows, "jump of place at a seam, mm", "<= 0.5", 0.5, _times("seam_position_jump_max_m", 1e3)),
        _greatest(rows, "jump of velocity at a seam, m/s", "<= 0.05", 0.05, _times("seam_velocity_jump_max_mps", 1.0)),
        _greatest(
            rows, "beyond joint limits, degrees", "<= 0.5", 0.5, _times("joint_limit_excess_max_rad", 180 / np.pi)
        ),
        _greatest(rows, "arms inside head, trunk or each other, mm", "<= 5", 5.0, _times("overlap_max_m", 1e3)),
        _share(rows, "head threats from ahead met by hand or forearm, %", 95.0, _met_by_arm),
        _share(rows, "head is hit less hard than unprotected, %", 90.0, _spared),
        _median(rows, "median cut of the head's peak acceleration, %", ">= 40", 40.0, _cut),
        _greatest(rows, "mirrored run differs, m", "<= 1e-6", 1e-6, _times("asymmetry_m", 1.0)),
        _tick(rows),
    ]


def _times(key: str, scale: float) -> Callable[[Row], float | None]:
    return lambda row: None if row.get(key) is None else scale * row[key]


def _contact_ticks(row: Row) -> float | None:
    return None if row["contact_error_s"] is None else abs(row["contact_error_s"]) / TICK_S


def _met_by_arm(row: Row) -> float | None:
    if not row["case"].frontal_head:
        return None
    return float(row["first_contact"] is not None and row["first_contact"].endswith(("hand", "forearm")))


def _both(row: Row) -> tuple[float, float] | None:
    """Peaks with and without protection, where the ball meets the body in both runs."""
    own, bare = row.get("head_peak_g"), row.get("bare_head_peak_g")
    return None if own is None or bare is None else (own, bare)


def _spared(row: Row) -> float | None:
    return None if (pair := _both(row)) is None else float(pair[0] < pair[1])


def _cut(row: Row) -> float | None:
    return None if (pair := _both(row)) is None else 100.0 * (1.0 - pair[0] / max(pair[1], 1e-9))


def _values(rows: list[Row], of: Callable[[Row], float | None]) -> tuple[list[Row], np.ndarray]:
    kept = [row for row in rows if of(row) is not None]
    return kept, np.array([of(row) for row in kept], float)


def _greatest(rows, name, bar, limit, of) -> Figure:
    kept, values = _values(rows, of)
    if not kept:
        return Figure(name, float("nan"), bar, False, None, 0)
    at = int(values.argmax())
    return Figure(
        name, float(values[at]), bar, bool(values[at] <= limit), kept[at], len(kept), int((values > limit).sum())
    )


def _share(rows, name, least, of) -> Figure:
    kept, values = _values(rows, of)
    share = 100.0 * float(values.mean()) if kept else float("nan")
    return Figure(
        name,
        share,
        f">= {least:g}",
        share >= least,
        next((r for r, v in zip(kept, values, strict=True) if not v), None),
        len(kept),
    )


def _median(rows, name, bar, least, of) -> Figure:
    kept, values = _values(rows, of)
    middle = float(np.median(values)) if kept else float("nan")
    return Figure(name, middle, bar, middle >= least, kept[int(values.argmin())] if kept else None, len(kept))


def _tick(rows: list[Row]) -> Figure:
    ticks = np.concatenate([row["protect_ms"] for row in rows])
    slow = max(rows, key=lambda row: max(row["protect_ms"], default=0.0))
    middle = float(np.median(ticks))
    return Figure("a tick of protection, median ms", middle, "< 0.5", middle < 0.5, slow, len(rows))


def lines_of(rows: list[Row]) -> list[str]:
    """The table as text."""
    lines = [f"{len(rows)} threats at {len({row['case'].clip for row in rows})} clips"]
    lines.append(f"{'figure':<52} {'value':>9}  {'bar':<8} {'met':<4} {'cases':>5} {'over':>5}  worst")
    for figure in figures_of(rows):
        worst = str(figure.worst["case"]) if figure.worst else ""
        met = "yes" if figure.met else "NO"
        lines.append(
            f"{figure.name:<52} {figure.value:>9.3g}  {figure.bar:<8} {met:<4} {figure.cases:>5}"
            f" {figure.failing:>5}  {worst}"
        )
    return lines
