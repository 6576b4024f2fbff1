"""The table of `brace bench --motion`: each figure, what came out, its bar, the worst case, and what it counts."""

from __future__ import annotations

from collections import Counter

import numpy as np

from behaviours.timing import TICK_S
from demos.benchmarks.motion_cases import AHEAD_DEG
from demos.benchmarks.motion_figure import Figure, greatest, median, share, times
from demos.benchmarks.motion_run import DEAD_AHEAD_DEG, EVERY_MIRRORED, Row
from demos.benchmarks.pose_bars import PoseBars

SNAP_MPS = 4.0  # nobody's joint changes its velocity by more than this in a tick: 49 g


def figures_of(rows: list[Row], poses: PoseBars | None = None) -> list[Figure]:
    """All figures, in the order of the table."""
    degrees = 180.0 / np.pi
    return [
        *_of_contact(rows),
        *_of_feet(rows),
        *_of_lines(rows),
        *_of_seams(rows),
        greatest(
            rows, "beyond joint limits, degrees", 0.5, times("joint_limit_excess_max_rad", degrees),
            f"{_ticks(rows, 'reacting_ticks')} from the first of a reaction to the end of the run, physics included; "
            "beyond the most that the clip's own poses of that run have",
        ),
        greatest(
            rows, "arms inside head, trunk or each other, mm", 5.0, times("overlap_max_m", 1e3),
            "the same ticks; hands and forearms as capsules; beyond the most that the clip's own poses have",
        ),
        *_of_blows(rows),
        *_of_physics(rows),
        greatest(
            rows, "mirrored run differs, m", 1e-6, times("asymmetry_m", 1.0),
            f"every {EVERY_MIRRORED}th case is run once more in the mirror, up to contact; left out: within "
            f"{DEAD_AHEAD_DEG:g} degrees of dead ahead",
        ),
        *(_of_poses(poses) if poses else ()),
        _tick(rows),
    ]  # fmt: skip


def _of_contact(rows: list[Row]) -> list[Figure]:
    missed = [row["case"].number for row in rows if row["contact_error_s"] is None]
    return [greatest(
        rows, "contact off its plan, ticks", 1.0, _contact_ticks,
        f"first touch of each ball, the flight that the struck surface saves counted in; left out: {len(missed)} balls "
        f"that touch nobody{_numbers(missed)}",
    ), greatest(
        rows, "contact off the sustained pose's, ticks", None, _promise_ticks,
        "the first touch against that of the same ball on the sustained pose, were it there from the start",
    )]  # fmt: skip


def _of_feet(rows: list[Row]) -> list[Figure]:
    settling = _ticks(rows, "settling_foot_ticks")
    return [
        greatest(
            rows, "planted feet slide, mm", 2.0, times("foot_slide_max_m", 1e3),
            f"{_ticks(rows, 'foot_ticks')} of a foot flagged planted in protection and recovery; left out: {settling} "
            "of one that stands by the plan while what a seam or blow left over still moves it (next two figures)",
        ),
        greatest(
            rows, "feet that come to stand from the clip, mm", None, times("settling_before_m", 1e3),
            f"of those {settling} the ones in protection: a foot that stands in the clip still moves a little",
        ),
        greatest(
            rows, "feet that come to stand from a blow, mm", None, times("settling_after_m", 1e3),
            "the ones in recovery: the blow may have moved a foot",
        ),
    ]  # fmt: skip


def _of_lines(rows: list[Row]) -> list[Figure]:
    hands = Counter[str]()
    for row in rows:
        hands.update(row["hand_frames"])
    total, sequences = sum(hands.values()), _ticks(rows, "two_sequences_ticks")
    ticks = _ticks(rows, "line_ticks")
    return [
        greatest(
            rows, "hands off their straight lines, mm", 3.0, times("hand_line_deviation_max_m", 1e3),
            f"{hands['straight']} of {total} ticks of a hand in blends, without what a seam leaves over; left out: "
            f"{hands['bowed']} on a way bowed round the body, {hands['led']} pushed out of it just then, "
            f"{hands['beyond_reach']} with the line beyond the arm's reach, and {sequences} in recovery's first "
            "part, which blends two sequences and has no line",
        ),
        greatest(
            rows, "hands led round the body are off it, mm", None, times("led_astray_m", 1e3),
            f"those {hands['bowed'] + hands['led']}",
        ),
        greatest(
            rows, "COM off its line, mm", 5.0, times("com_line_deviation_max_m", 1e3),
            f"{ticks} of blends, without what a seam leaves over; left out: {sequences} in recovery's first part",
        ),
        greatest(rows, "neck off its line, mm", None, times("neck_line_m", 1e3), f"the same {ticks}"),
    ]  # fmt: skip


def _of_seams(rows: list[Row]) -> list[Figure]:
    seams = sum(row["seams"] for row in rows)
    return [
        greatest(
            rows, "jump of place at a seam, mm", 0.5, times("seam_position_jump_max_m", 1e3),
            f"all joints at {seams} seams, blows included",
        ),
        greatest(
            rows, "jump of velocity at a seam, m/s", 0.05, times("seam_velocity_jump_max_mps", 1.0),
            "the same joints and seams, one-sided velocities; left out: blows, whose impulse is meant to jump "
            f"({sum('respond' in row['seam_by_phase'] for row in rows)} cases have one)",
        ),
        greatest(
            rows, "change of velocity within a tick, m/s", SNAP_MPS, lambda row: row["snap"].value,
            "all joints outside the physics, also in the middle of blends, beyond the clip's own while it plays; a bar "
            "of our own: what is over it is a pop",
        ),
    ]  # fmt: skip


def _of_blows(rows: list[Row]) -> list[Figure]:
    ahead = [row for row in rows if row["case"].frontal_head]
    unmet = sum(row["first_contact"] is None for row in ahead)
    heads = [row for row in rows if row["case"].target == "head"]
    left_out, missed = (sum(peaks(row) is None for row in heads) for peaks in (_peaks, _peaks_of_same_ball))
    return [
        share(
            rows, "head threats from ahead met by hand or forearm, %", 95.0, _met_by_arm,
            f"threats to the head within {AHEAD_DEG:g} degrees of ahead; {unmet} that touched nobody count as not met",
        ),
        share(
            rows, "head is hit less hard than unprotected, %", 90.0, lambda row: _spared(_peaks(row)),
            "threats to the head from anywhere; of somebody who sees nothing coming it is aimed at where the clip will "
            f"have it; left out: {left_out} of {len(heads)}, nobody struck in one run",
        ),
        median(
            rows, "median cut of the head's peak acceleration, %", 40.0, lambda row: _cut(_peaks(row)),
            "the same threats",
        ),
        share(
            rows, "hit less hard by the very same ball, %", None, lambda row: _spared(_peaks_of_same_ball(row)),
            "that ball on that path: thrown at a head that leans away, it mostly passes the unprotected or brushes an "
            f"arm or the trunk; left out: {missed} of {len(heads)}, nobody struck in one run",
        ),
        median(
            rows, "median cut of the very same ball, %", None, lambda row: _cut(_peaks_of_same_ball(row)), "those balls"
        ),
    ]  # fmt: skip


def _of_physics(rows: list[Row]) -> list[Figure]:
    return [
        greatest(
            rows, "fastest joint under the physics, m/s", None, lambda row: row["fastest"].value,
            "all joints from the blow to recovery, and while down; nothing that is hit goes much faster than the ball",
        )
    ]  # fmt: skip


def _of_poses(poses: PoseBars) -> list[Figure]:
    kept = 100.0 * poses.restarts_share
    stray = poses.feet_off_floor - poses.feet_off_because_hip_high
    named = ", ".join(f"{count} {name}" for name, count in poses.cases_by_name.items())
    return [
        Figure(
            "poses that no perturbed restart betters by 1 %, %", kept, ">= 99", kept >= 99.0, poses.cases,
            poses.poses_improved, None,
            f"{poses.cases} sustained poses, {poses.restarts} restarts; fig. 3.10: {named}", poses.worst_restart,
        ),
        Figure(
            "feet off the floor without a hip too high", float(stray), "0", stray == 0, 2 * poses.cases, stray, None,
            f"feet of those poses; left out: {poses.feet_off_because_hip_high} off the floor with the hip too high",
            poses.worst_foot,
        ),
    ]  # fmt: skip


def _ticks(rows: list[Row], key: str) -> str:
    return f"{sum(row[key] for row in rows)} ticks"


def _numbers(cases: list[int]) -> str:
    return f" (cases {', '.join(map(str, cases))})" if cases else ""


def _contact_ticks(row: Row) -> float | None:
    return None if row["contact_error_s"] is None else abs(row["contact_error_s"]) / TICK_S


def _promise_ticks(row: Row) -> float | None:
    return None if row.get("promise_error_s") is None else abs(row["promise_error_s"]) / TICK_S


def _met_by_arm(row: Row) -> float | None:
    if not row["case"].frontal_head:
        return None
    return float(row["first_contact"] is not None and row["first_contact"].endswith(("hand", "forearm")))


def _peaks(row: Row) -> tuple[float, float] | None:
    """The head's peaks with and without protection from the same threat, where both are struck."""
    own, bare = row.get("head_peak_g"), row.get("bare_head_peak_g")
    return None if own is None or bare is None else (own, bare)


def _peaks_of_same_ball(row: Row) -> tuple[float, float] | None:
    """Likewise from the same ball on the same path."""
    own, bare = row.get("head_peak_g"), row.get("passed_head_peak_g")
    return None if own is None or bare is None else (own, bare)


def _spared(peaks: tuple[float, float] | None) -> float | None:
    return None if peaks is None else float(peaks[0] < peaks[1])


def _cut(peaks: tuple[float, float] | None) -> float | None:
    return None if peaks is None else 100.0 * (1.0 - peaks[0] / max(peaks[1], 1e-9))


def _tick(rows: list[Row]) -> Figure:
    ticks = np.array([ms for row in rows for ms in row["protect_ms"]])
    middle = float(np.median(ticks)) if len(ticks) else float("nan")
    slow = max(rows, key=lambda row: float(np.median(row["protect_ms"] or [0.0])))
    counted = f"processor time of {len(ticks)} ticks of startle and protection, everything in them"
    return Figure("a tick of protection, median ms", middle, "< 0.5", middle < 0.5, len(rows), 0, slow, counted)


def lines_of(figures: list[Figure]) -> list[str]:
    """The table as text, and below it what each figure counts."""
    lines = [f"{'figure':<52} {'value':>9}  {'bar':<8} {'met':<4} {'cases':>5} {'over':>5}  worst"]
    for figure in figures:
        met = "" if figure.bar == "-" else "yes" if figure.met else "NO"
        lines.append(
            f"{figure.name:<52} {figure.value:>9.3g}  {figure.bar:<8} {met:<4} {figure.cases:>5}"
            f" {figure.failing:>5}  {figure.worst_words}"
        )
    return [*lines, "", "what is counted", *(f"  {figure.name}: {figure.counted}" for figure in figures)]
