"""The search for the balanced, braced pose (Hermens 2006, 3.3): BFGS, polished; then what limits and elbows ask for.

The kernels are in `solve_pose`; here is in which order they are tried, and when that is enough.
"""

from __future__ import annotations

import numpy as np

from behaviours.protect.apply_rules import apply_rules
from behaviours.protect.exact_feet import EXACT, stand_exactly
from behaviours.protect.fit_arms import fit_arms
from behaviours.protect.solve_pose import Solution, solve_bfgs, solve_least_squares
from behaviours.protect.task import Posed, Task
from behaviours.protect.total_error import FORMS, TERMS, Reference
from behaviours.rules.controls import LEAN, RECOIL, TURN
from behaviours.settings import Settings
from engine.body.kinematics import centre_of_mass

DEARER = (5.0, 25.0, 125.0)  # rounds of making limits cost more, where legs still overstep them
# shares of the way that the COM has to go, metres down, and recoil, whose own limit is a kink on the way to more of it
BRACED_STARTS = ((0.0, 0.04, 0.0), (1.0, 0.05, 0.3), (0.5, 0.02, -0.5), (1.0, 0.0, 0.6))
ARMS_MATTER_M = 5e-4  # of COM, when arms are fitted in
DRAWN_BACK = 14  # halvings of the way back to what planted legs can do


def solve(
    task: Task, reference: Reference, form: int, start: np.ndarray, posed: Posed, settings: Settings
) -> tuple[Solution, int]:
    """Runs the solver that the settings name; the solution, and how many evaluations polishing it took.

    A joint limit that is met on the way is a ridge on which BFGS ends in its line search. Least squares, which
    bends with it, goes on from there, and then also from the start. It knows only the `squares` form.
    """
    s = settings.solver
    if s.method == "least_squares":
        return solve_by_least_squares(task, reference, start, posed, settings), 0
    found = solve_bfgs(task, reference, form, start, posed, s.offset, s.tolerance, s.iterations, s.restarts)
    if not s.polish or FORMS[form] != "squares":
        return found, 0
    polished = solve_least_squares(task, reference, found.variables, posed, s.polish_tolerance, s.iterations)
    again = solve_by_least_squares(task, reference, start, posed, settings)
    best = min(found, polished, again, key=lambda end: end.value)
    return found._replace(variables=best.variables, value=best.value), int(polished.evaluations + again.evaluations)


def solve_by_least_squares(
    task: Task, reference: Reference, start: np.ndarray, posed: Posed, settings: Settings
) -> Solution:
    """The best of a few descents: from the rules pose, and from there braced with bent knees, where limits are
    farther off.
    """
    s = settings.solver
    begins = [start]
    for share, down_m, recoil in BRACED_STARTS:
        braced = start.copy()
        braced[:2] += share * (np.array(reference.com_wanted_m) - reference.com_rules_m)
        braced[2] -= down_m
        braced[3 + RECOIL] = min(1.0, max(0.0, braced[3 + RECOIL] + recoil))
        begins.append(braced)
    ends = [solve_least_squares(task, reference, x, posed, s.polish_tolerance, s.iterations) for x in begins]
    best = min(ends, key=lambda end: end.value)
    return best._replace(evaluations=sum(end.evaluations for end in ends), value_initial=ends[0].value_initial)


def weigh_arms(
    task: Task, reference: Reference, found: Solution, form: int, posed: Posed, settings: Settings
) -> tuple[Solution, Reference]:
    """The solution with the COM where it is wanted once the arms are fitted in, and what was asked for to get there.

    The search goes by arms as the rules want them: it is told how far fitting them in takes the COM.
    """
    if FORMS[form] != "squares":
        return found, reference
    controls = np.clip(found.variables[3:], 0.0, 1.0)
    apply_rules(task, found.variables, controls, reference.soft_m, posed)
    before = np.array(centre_of_mass(task.bones, posed.positions, posed.orientations))
    fit_arms(task, controls, posed)
    taken_m = (np.array(centre_of_mass(task.bones, posed.positions, posed.orientations)) - before)[:2]
    if np.abs(taken_m).max() < ARMS_MATTER_M:
        return found, reference
    wanted = np.array(reference.com_wanted_m) - taken_m
    aside = reference._replace(com_wanted_m=(float(wanted[0]), float(wanted[1])))
    again = solve_least_squares(task, aside, found.variables, posed, settings.solver.polish_tolerance, 20)
    return found._replace(variables=again.variables), aside


def keep_limits(task: Task, reference: Reference, found: Solution, posed: Posed, settings: Settings) -> Solution:
    """The solution with the planted legs inside their limits, where there is one: what they forbid is made to
    cost more, and what then still is forbidden is drawn back from.

    A weight only trades limits off against the rest; the margin that limbs keep takes up what the greatest leaves
    over. Legs reach exactly here, as in the pose that is shown: the last millimetres of a stretched leg are degrees
    of its hip.
    """
    limits, tolerance_m = TERMS.index("limits"), settings.balance.foot_tolerance_m
    best, least = found, legs_trouble(task, found.variables, posed, tolerance_m)
    begin = found.variables
    for dearer in DEARER:
        if least < task.rules.limit_margin_rad:
            return best
        weights = list(reference.weights)
        weights[limits] *= dearer
        strict = reference._replace(weights=tuple(weights), soft_m=EXACT)
        begin = solve_least_squares(task, strict, begin, posed, settings.solver.polish_tolerance, 20).variables
        wrong = legs_trouble(task, begin, posed, tolerance_m)
        if wrong < 0.9 * least:
            best, least = found._replace(variables=begin), wrong
    ends = [
        back_within(task, strict, begin, best.variables, posed, settings)
        for begin in starts_of(np.concatenate([np.zeros(3), reference.controls]))
        if legs_trouble(task, begin, posed, tolerance_m) < task.rules.limit_margin_rad
    ]
    return min(ends, key=lambda end: end.value) if ends else best


def starts_of(start: np.ndarray) -> list[np.ndarray]:
    """Where to draw back to: the start, and the start without lean and turn, which take the pelvis along."""
    upright = start.copy()
    upright[[3 + LEAN, 3 + TURN]] = 0.0
    return [start, upright]


def back_within(
    task: Task, strict: Reference, begin: np.ndarray, wanted: np.ndarray, posed: Posed, settings: Settings
) -> Solution:
    """The least error on from `begin`, which the planted legs can take, towards and beyond what is wanted.

    From inside the limits what is forbidden is a wall, not a valley to be caught in.
    """
    s, tolerance_m = settings.solver, settings.balance.foot_tolerance_m
    drawn = draw_back(task, begin, wanted, posed, tolerance_m)
    again = solve_least_squares(task, strict, drawn, posed, s.polish_tolerance, 20)
    kept = draw_back(task, drawn, again.variables, posed, tolerance_m)
    return again._replace(
        variables=kept, value=solve_least_squares(task, strict, kept, posed, s.polish_tolerance, 0).value
    )


def draw_back(task: Task, begin: np.ndarray, wanted: np.ndarray, posed: Posed, tolerance_m: float) -> np.ndarray:
    """(10,) as far from `begin` on the straight way to `wanted` as the planted legs can go within their limits."""
    margin_rad = task.rules.limit_margin_rad

    def allowed(share: float) -> bool:
        return legs_trouble(task, begin + share * (wanted - begin), posed, tolerance_m) < margin_rad

    if allowed(1.0):
        return wanted
    near, far = 0.0, 1.0
    for _ in range(DRAWN_BACK):
        middle = 0.5 * (near + far)
        near, far = (middle, far) if allowed(middle) else (near, middle)
    return begin + near * (wanted - begin)


def legs_trouble(task: Task, variables: np.ndarray, posed: Posed, tolerance_m: float) -> float:
    """What limits forbid the planted legs in the pose that would be shown, radians."""
    stand_exactly(task, variables[:3].copy(), np.clip(variables[3:], 0.0, 1.0), posed, tolerance_m)
    return float(posed.trouble.max())
