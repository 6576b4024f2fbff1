"""`brace bench --stance`: how good stances are, over a seeded sample of solves of all shape sets. Every figure has a
bar.

A case is a set, an intensity in its range, mostly an object, often one or two wrist targets. Each is solved, and once
more a hundredth of intensity on, where nothing may jump. Then a crouch, a twist and a shift of the weight are played
on narrow and wide feet, and a timid and a bold character meet the same threats.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from behaviours.stance import arms, footprints, sequence, torso, wrists
from behaviours.stance.assembly import new_figure
from behaviours.stance.balance import find_balance, new_search
from behaviours.stance.measures import Measures, measures
from behaviours.stance.shape import shape
from behaviours.stance.shape_sets import SETS
from behaviours.stance.solve import StanceResult, solve_shape, solve_stance
from behaviours.stance.solver import MOST_CYCLES, STOPS_IMPROVING
from engine.body.anthropometry import standard_body
from engine.body.skeleton import ANKLES, SHOULDERS, Body
from engine.maths import quaternion, rotations

CASES, SEED = 504, 5
REACHED_M = 1e-3
STEP, JUMP_DEG = 0.01, 2.0
# sets whose spine changes its class at 0, as they state: what a wrist target makes of the two sides differs
SWITCH_AT_ZERO = ("posture", "beauty-line", "reach-beauty-line")
WIDTHS_M = (0.12, 0.42)
TRIES = 3  # of each timing, the best counts


class Case(NamedTuple):
    """One stance to solve."""

    set_name: str
    intensity: float
    points: dict[str, Any]  # keyword arguments of solve_stance


class Bar(NamedTuple):
    """One figure and what it must be."""

    what: str
    value: float
    bar: str
    met: bool
    note: str = ""


def make_cases(body: Body, count: int = CASES, seed: int = SEED) -> list[Case]:
    """All sets in turn. Wrist targets lie in front and at the side of the shoulder of somebody standing straight,
    within an arm.
    """
    chance, names, cases = np.random.default_rng(seed), list(SETS), []
    standing = solve_shape(body, shape())
    for number in range(count):
        name = names[number % len(names)]
        entry, points = SETS[name], {}
        if entry.needs_object or chance.random() < 0.3:
            azimuth, away = chance.uniform(-math.pi, math.pi), chance.uniform(0.5, 2.0)
            points["object_m"] = (away * math.cos(azimuth), away * math.sin(azimuth), chance.uniform(0.1, 1.9))
        if name.startswith("reach") or chance.random() < 0.3:
            first = number // len(names) % 2
            for side, key in enumerate(("reach_left_m", "reach_right_m")):
                if side == first or chance.random() < 0.2:
                    points[key] = _target(body, standing, side, chance)
        cases.append(Case(name, chance.uniform(entry.low, entry.high), points))
    return cases


def _target(body, standing, side, chance):
    azimuth, elevation = chance.uniform(-0.5, 1.2) * (1 - 2 * side), chance.uniform(-1.0, 1.0)
    away = chance.uniform(0.6, 1.0) * arms.arm_length_m(body, side)
    level = away * math.cos(elevation)
    way = (level * math.cos(azimuth), level * math.sin(azimuth), away * math.sin(elevation))
    return tuple(float(x) for x in np.add(standing.joints_m[SHOULDERS[side]], way))


def bars(count: int = CASES, seed: int = SEED, progress: Callable[[Any], Any] = lambda cases: cases) -> list[Bar]:
    """Solves the whole sample and returns every figure with its bar."""
    body = standard_body()
    cases = make_cases(body, count, seed)
    solved, seconds = [], []
    for case in progress(cases):
        result, best_s = _timed(body, case)
        solved.append((case, result, measures(body, result)))
        seconds.append(best_s)
    return [
        *_error_bars(body, solved),
        *_solver_bars([result for _, result, _ in solved], seconds),
        _against_plain(body),
        *_continuity_bars(body, solved),
        *_sequence_bars(body),
        *_meeting_bars(),
    ]  # fmt: skip


def solve(body: Body, case: Case, more: float = 0.0) -> StanceResult:
    return solve_stance(body, case.set_name, case.intensity + more, **case.points)


def _timed(body, case) -> tuple[StanceResult, float]:
    best = math.inf
    for _ in range(TRIES):
        begun = time.perf_counter()
        result = solve(body, case)
        best = min(best, time.perf_counter() - begun)
    return result, best


def _error_bars(body: Body, solved: list[tuple[Case, StanceResult, Measures]]) -> list[Bar]:
    found = [m for _, _, m in solved]
    foot_mm = 1e3 * max(m.foot_error_m.max() for m in found)
    foot_deg = math.degrees(max(m.foot_error_rad.max() for m in found))
    balance_mm = 1e3 * max(m.balance_error_m for m in found)
    excess = max(m.limit_excess_rad for m in found)
    eased = sum(result.kept < 1.0 for _, result, _ in solved)
    wrist_mm, reachable, beyond_mm, beyond = _wrist_errors_mm(body, [result for _, result, _ in solved])
    return [
        Bar("foot position error, mm", foot_mm, "<= 0.1", foot_mm <= 0.1),
        Bar("foot orientation error, deg", foot_deg, "<= 0.01", foot_deg <= 0.01),
        Bar("wrist error, reachable, mm", wrist_mm, "<= 1", wrist_mm <= 1.0, f"{reachable} stances"),
        Bar("wrist beyond the nearest point, mm", beyond_mm, "<= 10", beyond_mm <= 10.0, f"{beyond} out of reach"),
        Bar("balance error of a pose solve, mm", balance_mm, "<= 2", balance_mm <= 2.0),
        Bar("joint limit excess, rad", excess, "0", excess <= 1e-9, f"{eased} with the lower body eased"),
    ]


def _wrist_errors_mm(body: Body, results: list[StanceResult]) -> tuple[float, int, float, int]:
    """Over stances whose targets can be reached: the largest miss and how many; over the others: how much farther
    than need be.

    A missed target counts as out of reach only where a global search finds no torso of that shape that reaches it.
    """
    reachable, beyond = [0.0], [0.0]
    for result in results:
        if not any(result.plan.reaching):
            continue
        miss = float(result.wrist_error_m.max())
        best = 0.0 if miss <= REACHED_M else _nearest_miss_m(body, result)
        (reachable if best <= REACHED_M else beyond).append(miss if best <= REACHED_M else miss - best)
    return 1e3 * max(reachable), len(reachable) - 1, 1e3 * max(beyond), len(beyond) - 1


def _nearest_miss_m(body: Body, result: StanceResult) -> float:
    """The least that any torso of this shape could miss the farther target by: SciPy's global search."""
    from scipy.optimize import differential_evolution

    plan, figure = result.plan, new_figure()
    bounds = torso.amplitude_bounds(body, plan.classes, plan.opposed)

    def missing(unknowns):
        search = new_search(plan.lower)
        search.offset_rad[:] = result.balance_rad
        find_balance(body, plan, np.ascontiguousarray(unknowns), search, figure)
        sides = [side for side in range(2) if plan.reaching[side]]
        return max(wrists.reach_distance_m(plan, figure.positions, s) - arms.arm_length_m(body, s) for s in sides)

    return float(differential_evolution(missing, bounds, seed=1, maxiter=40, popsize=8, tol=1e-6).fun)


def _solver_bars(results: list[StanceResult], seconds: list[float]) -> list[Bar]:
    reaching = [k for k, result in enumerate(results) if any(result.plan.reaching)]
    searched = [result.outcome.cycles for result in results if result.outcome.cycles > 0]
    cycles, longest = float(np.median(searched)), max(searched)
    cut_off = sum(taken >= MOST_CYCLES for taken in searched)
    one_ms, reach_ms = 1e3 * float(np.median(seconds)), 1e3 * float(np.median([seconds[k] for k in reaching]))
    slowest_ms = 1e3 * np.quantile(seconds, 0.95)
    return [
        Bar("Brent cycles, median of those that search", cycles, "<= 5", cycles <= 5, f"most {longest}"),
        Bar("solves cut off at the most cycles", cut_off, "0", cut_off == 0),
        Bar("one solve, median, ms", one_ms, "< 0.5", one_ms < 0.5, f"95 % under {slowest_ms:.2f}"),
        Bar("one solve with a target, median, ms", reach_ms, "< 0.5", reach_ms < 0.5),
    ]  # fmt: skip


def _against_plain(body: Body) -> Bar:
    """One stance that reaches, ours and in plain numpy and SciPy, in this same run."""
    from demos.benchmarks import plain_stance

    case = Case("recoil-mild", 0.4, {"object_m": (1.2, -0.3, 1.2), "reach_right_m": (0.5, -0.3, 1.25)})
    result, ours_s = _timed(body, case)
    bounds = torso.amplitude_bounds(body, result.plan.classes, result.plan.opposed)
    begun = time.perf_counter()
    joints, _ = plain_stance.solve(body, result.plan, result.wishes, bounds, STOPS_IMPROVING)
    plain_s = time.perf_counter() - begun
    apart_mm = 1e3 * float(np.abs(joints - result.joints_m).max())
    note = f"{1e3 * ours_s:.2f} ms against {plain_s:.1f} s; {apart_mm:.1f} mm apart"
    return Bar("times faster than plain numpy and SciPy", plain_s / ours_s, "> 1", ours_s < plain_s, note)


def _continuity_bars(body: Body, solved) -> list[Bar]:
    free, led = [0.0], [0.0]
    for case, result, _ in solved:
        if case.set_name in SWITCH_AT_ZERO and case.intensity * (case.intensity + STEP) <= 0.0:
            continue
        (led if any(result.plan.reaching) else free).append(_jump_deg(result, solve(body, case, STEP)))
    smooth = np.mean(np.array(led) <= JUMP_DEG)
    return [
        Bar("joint's change for 0.01 of intensity, deg", max(free), f"<= {JUMP_DEG:g}", max(free) <= JUMP_DEG),
        Bar("the same with wrist targets, deg", max(led), f"<= {JUMP_DEG:g}", max(led) <= JUMP_DEG,
            f"{100 * smooth:.1f} % of stances within the bar"),
    ]  # fmt: skip


def _jump_deg(before: StanceResult, after: StanceResult) -> float:
    turned = rotations.multiply(rotations.conjugate(before.pose.rotations), after.pose.rotations)
    return float(np.degrees(2.0 * np.arccos(np.clip(np.abs(turned[:, 0]), 0.0, 1.0))).max())


def crouch_twist_shift(body: Body, width_m: float) -> tuple[StanceResult, list[sequence.Move]]:
    """The paper's sequence (7) on feet that far apart: its start and its moves."""
    feet = footprints.stand(body, width_m=width_m)
    keys = (
        shape(knee_left_rad=1.1, knee_right_rad=1.1, pelvis_x_rad=0.15),
        shape(knee_left_rad=1.1, knee_right_rad=1.1, pelvis_y_rad=0.35),
        shape(knee_left_rad=0.6, knee_right_rad=0.6, pelvis_y_rad=-0.35, balance_x=0.35),
        shape(knee_left_rad=0.5, knee_right_rad=0.5, pelvis_y_rad=0.2, balance_x=-0.35, balance_z=0.3),
        shape(),
    )
    return solve_shape(body, shape(), feet), [sequence.Move(solve_shape(body, key, feet), 0.8, 0.5) for key in keys]


def _sequence_bars(body: Body) -> list[Bar]:
    foot_mm, foot_deg, steady_mm, eased = 0.0, 0.0, 0.0, 0
    for width_m in WIDTHS_M:
        start, moves = crouch_twist_shift(body, width_m)
        eased += sum(move.to.kept < 1.0 for move in moves)
        frames = list(sequence.frames(body, start, moves))
        ankles = np.array([frame.joints_m[list(ANKLES)] for frame in frames])
        foot_mm = max(foot_mm, 1e3 * np.abs(ankles - start.feet.ankle_m).max())
        for frame, side in ((frame, side) for frame in frames for side in range(2)):
            turned = quaternion.angle_between(frame.orientations[ANKLES[side]], start.feet.foot_turned[side])
            foot_deg = max(foot_deg, math.degrees(turned))
        ends = np.cumsum([round((m.move_s + m.hold_s) * sequence.TICK_RATE_HZ) for m in moves]) - 1
        steady_mm = max(steady_mm, 1e3 * max(np.hypot(*(frames[k].com_m[:2] - frames[k].com_wanted_m)) for k in ends))
    return [
        Bar("crouch, twist, shift: foot motion, mm", foot_mm, "<= 0.1", foot_mm <= 0.1, f"{eased} keys eased"),
        Bar("crouch, twist, shift: foot turn, deg", foot_deg, "<= 0.01", foot_deg <= 0.01),
        Bar("balance with feedback, steady, mm", steady_mm, "<= 5", steady_mm <= 5.0),
    ]  # fmt: skip


def _meeting_bars() -> list[Bar]:
    from demos.benchmarks.stance_meeting import pairs

    met = pairs()
    nearest, worst = min(met, key=lambda pair: pair.apart_m), max(met, key=lambda pair: pair.off_balance_m)
    apart_cm, off_cm = 100.0 * nearest.apart_m, 100.0 * worst.off_balance_m
    return [
        Bar("timid against bold: wrists apart, least, cm", apart_cm, ">= 10", apart_cm >= 10.0,
            f"{len(met)} threats; {nearest.what}"),
        Bar("their balance error, worst, cm", off_cm, "<= 2", off_cm <= 2.0, worst.what),
    ]  # fmt: skip


def table(found: list[Bar]) -> list[str]:
    """The figures for people."""
    return [f"{'ok ' if b.met else 'NOT'}  {b.what:<44} {b.value:>10.4g}  {b.bar:<8} {b.note}".rstrip() for b in found]
