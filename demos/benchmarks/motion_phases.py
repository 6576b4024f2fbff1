"""Where in a reaction it goes wrong: the second table of `brace bench --motion`, one line a phase; and what the search
and the falls came to.
"""

from __future__ import annotations

from collections import Counter

import numpy as np

from behaviours.components import Phase
from behaviours.measure.measures import Worst
from demos.benchmarks.motion_figure import Figure
from demos.benchmarks.motion_run import Row
from demos.benchmarks.motion_table import SNAP_MPS, figures_of

LIMIT_RAD, DEPTH_M, SEAM_MPS = np.radians(0.5), 0.005, 0.05  # bars of the table
SOME_FIGURES = (
    "jump of place at a seam, mm", "jump of velocity at a seam, m/s", "change of velocity within a tick, m/s",
    "fastest joint under the physics, m/s", "planted feet slide, mm",
    "beyond joint limits, degrees", "arms inside head, trunk or each other, mm",
)  # fmt: skip


def phase_lines(rows: list[Row]) -> list[str]:
    """One line a phase: the greatest of each figure there, how many cases are over its bar, and which part mostly."""
    head = ("limits, degrees", "arms, mm", "seam, m/s", "pop, m/s")
    lines = [f"{'where it arises':<16}" + "".join(f"{word:>16} {'over':>4}  {'mostly':<24}" for word in head)]
    for phase in Phase:
        name = phase.name.lower()
        if any(name in row["limit_by_phase"] or name in row["seam_by_phase"] for row in rows):
            lines.append(f"{name:<16}{''.join(_cells(rows, name)).rstrip()}")
    return lines


def _cells(rows: list[Row], phase: str) -> list[str]:
    limits = [row["limit_by_phase"][phase] for row in rows if phase in row["limit_by_phase"]]
    arms = [row["overlap_by_phase"][phase] for row in rows if phase in row["overlap_by_phase"]]
    seams = [row["seam_by_phase"][phase][1] for row in rows if phase in row["seam_by_phase"]]
    snaps = [row["snap"] for row in rows if row["snap_phase"] == phase]
    return [
        _cell(limits, LIMIT_RAD, 180.0 / np.pi, "{:.1f}"),
        _cell(arms, DEPTH_M, 1e3, "{:.1f}"),
        _cell(seams, SEAM_MPS, 1.0, "{:.3f}"),
        _cell(snaps, SNAP_MPS, 1.0, "{:.1f}"),
    ]


def _cell(worst: list[Worst], bar: float, scale: float, form: str) -> str:
    if not worst:
        return f"{'-':>16} {'':>4}  {'':<24}"
    over = Counter(one.what for one in worst if one.value > bar)
    mostly = over.most_common(1)[0][0] if over else ""
    return f"{form.format(scale * max(one.value for one in worst)):>16} {sum(over.values()):>4}  {mostly:<24}"


def search_lines(rows: list[Row], get_ups_here: bool, falls: list[Row]) -> list[str]:
    """What the search for a new motion found, and how those fared who were knocked down."""
    asked = searching(rows)
    searches = [event for row in asked for event in row["searched"] if event["kind"] == "searched"]
    taken = Counter(event["clip"] for event in searches if event["chosen"] == "new")
    named = ", ".join(f"{clip} {times}" for clip, times in taken.most_common()) or "none"
    away_m = [event["distance_m"] for event in searches if event["chosen"] == "new"]
    near = f"; windows {np.median(away_m):.3f} m off in the median, {max(away_m):.3f} at most" if away_m else ""
    fell, rose = [row for row in falls if row["fell"]], [row for row in falls if row["got_up"]]
    lines = [
        f"search: {len(asked)} struck who ask for a new motion, {len(away_m)} times one is entered: {named}{near}",
        f"knock-downs: {len(falls)} thrown at, {len(fell)} fall, {len(rose)} get up by a motion that is found, "
        f"{sum(row['stands_again'] for row in falls)} stand at the end" + _lying(fell),
    ]
    if not get_ups_here:
        lines.append("knock-downs: no motion that gets up is here; `brace clips fetch --extra` brings two")
    reasons = Counter(e["reason"] for row in falls for e in row["searched"] if e["kind"] == "stays_down")
    lines.extend(f"knock-downs: {times} stay down: {reason}" for reason, times in reasons.most_common())
    return lines


def searching(rows: list[Row]) -> list[Row]:
    """Those who are struck and then look for a new motion."""
    return [row for row in rows if row["case"].recover == "new" and row["contact_error_s"] is not None]


def _lying(fell: list[Row]) -> str:
    if not fell:
        return ""
    still, low = max(row["lies_mps"] or 0.0 for row in fell), min(row["lowest_m"] for row in fell)
    high = max(row["rises_m"] for row in fell)
    return (
        f"; lying, no joint moves faster than {still:.2f} m/s at the end, none was ever lower than {1e3 * low:.0f} mm; "
        f"no COM was thrown higher than {1e3 * high:.0f} mm above where it stood"
    )


def some_figures(rows: list[Row]) -> list[Figure]:
    """The figures that can be told of some runs alone: of falls, of those who go on with a new motion."""
    return [figure for figure in figures_of(rows) if figure.name in SOME_FIGURES] if rows else []
