"""The sustained pose (Hermens 2006, 3.3): the rules, then the search that balances it and braces it towards the
threat.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numba import njit

from behaviours import minimise
from behaviours.apply_rules import apply_rules, update_pose
from behaviours.guard import stop_shoulder
from behaviours.mirroring import (
    mirror_choices,
    mirror_controls,
    mirror_feet,
    mirror_pose,
    mirror_reference,
    mirror_task,
)
from behaviours.perceived import PerceivedThreat
from behaviours.prepare import prepare
from behaviours.rules.controls import controls_from_threat
from behaviours.settings import Settings
from behaviours.solve_pose import Solution, solve_bfgs, solve_least_squares
from behaviours.task import Choices, FeetPlan, Posed, Task, new_posed
from behaviours.total_error import (
    FORMS,
    RESIDUALS,
    TERMS,
    Reference,
    measure_into,
    term_errors,
    total_error,
)
from engine.body.kinematics import centre_of_mass
from engine.body.skeleton import BACK, HIPS, PELVIS, WAIST, WRISTS, Body, Pose
from engine.body.support import inside, polygon_of
from engine.body.two_bones import SOFT_REACH_M
from engine.clips.mirror import FLIP_POINT, mirror_body
from engine.maths import quaternion, vector

EXACT = 0.0  # leg reach without the soft end: for poses that are shown
DEARER = (5.0, 25.0, 125.0)  # rounds of making limits cost more, where legs still overstep them
BRACED_STARTS = ((0.0, 0.04), (1.0, 0.05))  # shares of the way that the COM has to go; metres down
ARMS_MATTER_M = 5e-4  # of COM, when elbows swing aside
LOWERINGS = 20  # each closes what is missing but for the leg's slant


class Case(IntEnum):
    """How balancing and bracing ended (fig. 3.10): the COM against the support polygon, before and after."""

    BALANCED = 0  # case 1: inside it
    BRACED_OUT = 1  # case 2: out, on the threat's side, which the impact is expected to mend
    UNRECOVERED = 2  # case 3: was out, stays out
    MENDED = 3  # was out, is in
    AIRBORNE = 4  # no foot on the ground: the upper body alone


class SolverReport(NamedTuple):
    """What the search did."""

    name: str
    iterations: int
    evaluations: int
    restarts: int
    stop: str  # one of minimise.STOPS, or "not needed"
    polish_evaluations: int  # by least squares, from where BFGS ended


class Protection(NamedTuple):
    """A protective pose and everything it was made from. World metres and radians."""

    rules: Pose  # the rules alone
    sustained: Pose  # balanced and braced
    controls_initial: np.ndarray  # (7,) see rules.controls
    controls: np.ndarray  # (7,)
    com_rules_m: np.ndarray  # (3,) COM_cur
    com_m: np.ndarray  # (3,) of the sustained pose
    com_wanted_m: np.ndarray  # (2,) COM_des
    support_m: np.ndarray  # (m, 2) support polygon of the sustained pose
    case: Case
    errors_initial: dict[str, float]  # each term, and the total
    errors: dict[str, float]
    choices: Choices
    feet: FeetPlan
    solver: SolverReport
    task: Task
    reference: Reference


def protect(
    body: Body,
    pose_now: Pose,
    pose_ahead: Pose,
    planted,
    threat: PerceivedThreat,
    settings: Settings,
    previous_turn_side: float = 0.0,
    landing: bool = False,
) -> Protection:
    """The pose in which to meet a threat. Arguments as for `prepare`."""
    task = prepare(body, pose_now, pose_ahead, planted, threat, settings, previous_turn_side, landing)
    return solve_protection(body, task, settings)


def solve_protection(body: Body, task: Task, settings: Settings) -> Protection:
    """Rules pose, search and report, for a task that is prepared. Who turns left is worked out in the mirror."""
    if task.choices.turn_side > 0.0:
        return mirror_protection(_solve_protection(mirror_body(body), mirror_task(task), settings))
    return _solve_protection(body, task, settings)


def _solve_protection(body: Body, task: Task, settings: Settings) -> Protection:
    controls = controls_from_threat(task.threat.speed_norm, task.threat.size_norm)
    posed = new_posed()
    rules_shift = pose_exactly(task, np.zeros(3), controls, posed, settings.balance.foot_tolerance_m)
    # the rules pose is the start: what it took to plant its feet exactly belongs to it
    task = task._replace(start=task.start._replace(root_m=task.start.root_m + rules_shift))
    rules, com_rules = _pose_of(posed), np.array(centre_of_mass(task.bones, posed.positions, posed.orientations))
    support_rules = polygon_of(body, posed.positions, posed.orientations, task.feet.held)
    plain = new_posed()  # as the search sees it: elbows at their swivels
    update_pose(task, np.zeros(3), controls, EXACT, False, plain)
    reference = refer_to(task, plain, com_rules, controls, settings)

    start = np.concatenate([np.zeros(3), controls])
    residuals, form = np.empty(RESIDUALS), FORMS.index(settings.objective.form)
    measure_into(task, reference, start, controls, posed, residuals)
    errors_initial = term_errors(residuals) | {"total": float(total_error(residuals, reference, form))}
    if not task.feet.held.any():
        return Protection(
            rules, rules, controls, controls, com_rules, com_rules, np.array(reference.com_wanted_m), support_rules,
            Case.AIRBORNE, errors_initial, errors_initial, task.choices, task.feet,
            SolverReport(settings.solver.method, 0, 0, 0, "not needed", 0), task, reference,
        )  # fmt: skip
    solution, polishing = solve(task, reference, form, start, posed, settings)
    solution = keep_limits(task, reference, solution, posed, settings)
    solution = weigh_arms(task, reference, solution, form, posed, settings)
    shift, controls_end = solution.variables[:3].copy(), np.clip(solution.variables[3:], 0.0, 1.0)
    shift += pose_exactly(task, shift, controls_end, posed, settings.balance.foot_tolerance_m)
    sustained, com = _pose_of(posed), np.array(centre_of_mass(task.bones, posed.positions, posed.orientations))
    support = polygon_of(body, posed.positions, posed.orientations, task.feet.held)
    final = np.concatenate([shift, solution.variables[3:]])
    measure_into(task, reference, final, controls_end, posed, residuals)
    errors = term_errors(residuals) | {"total": float(total_error(residuals, reference, form))}
    case = case_of(inside(support_rules, com_rules[:2]), inside(support, com[:2]))
    report = SolverReport(
        settings.solver.method,
        int(solution.iterations),
        int(solution.evaluations),
        int(solution.restarts),
        minimise.STOPS[solution.stop],
        polishing,
    )
    return Protection(
        rules, sustained, controls, controls_end, com_rules, com, np.array(reference.com_wanted_m), support,
        case, errors_initial, errors, task.choices, task.feet, report, task, reference,
    )  # fmt: skip


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
    evaluations = polished.evaluations
    if found.stop == minimise.LINE_SEARCH:
        again = solve_by_least_squares(task, reference, start, posed, settings)
        evaluations += again.evaluations
        polished = min(polished, again, key=lambda end: end.value)
    best = min(found, polished, key=lambda end: end.value)
    return found._replace(variables=best.variables, value=best.value), int(evaluations)


def solve_by_least_squares(
    task: Task, reference: Reference, start: np.ndarray, posed: Posed, settings: Settings
) -> Solution:
    """The best of a few descents: from the rules pose, and from there braced with bent knees, where limits are
    farther off.
    """
    s = settings.solver
    begins = [start]
    for share, down_m in BRACED_STARTS:
        braced = start.copy()
        braced[:2] += share * (np.array(reference.com_wanted_m) - reference.com_rules_m)
        braced[2] -= down_m
        begins.append(braced)
    ends = [solve_least_squares(task, reference, x, posed, s.polish_tolerance, s.iterations) for x in begins]
    best = min(ends, key=lambda end: end.value)
    return best._replace(evaluations=sum(end.evaluations for end in ends), value_initial=ends[0].value_initial)


def keep_limits(task: Task, reference: Reference, found: Solution, posed: Posed, settings: Settings) -> Solution:
    """The solution with the planted legs inside their limits, where there is one: what they forbid is made to
    cost more.

    A weight only trades limits off against the rest; the margin that limbs keep takes up what the greatest leaves
    over. Legs reach exactly here, as in the pose that is shown: the last millimetres of a stretched leg are degrees
    of its hip.
    """
    limits, tolerance_m = TERMS.index("limits"), settings.balance.foot_tolerance_m
    best, least = found, _legs_trouble(task, found.variables, posed, tolerance_m)
    begin = found.variables
    for dearer in DEARER:
        if least < task.rules.limit_margin_rad:
            break
        weights = list(reference.weights)
        weights[limits] *= dearer
        strict = reference._replace(weights=tuple(weights), soft_m=EXACT)
        begin = solve_least_squares(task, strict, begin, posed, settings.solver.polish_tolerance, 20).variables
        wrong = _legs_trouble(task, begin, posed, tolerance_m)
        if wrong < 0.9 * least:
            best, least = found._replace(variables=begin), wrong
    return best


def weigh_arms(
    task: Task, reference: Reference, found: Solution, form: int, posed: Posed, settings: Settings
) -> Solution:
    """The solution with the COM where it is wanted once the elbows have swung aside: the search is told how far
    they take it.
    """
    if FORMS[form] != "squares":
        return found
    controls = np.clip(found.variables[3:], 0.0, 1.0)
    posed.made_from[:] = np.nan
    update_pose(task, found.variables, controls, reference.soft_m, False, posed)
    before = np.array(centre_of_mass(task.bones, posed.positions, posed.orientations))
    apply_rules(task, found.variables, controls, reference.soft_m, posed)
    taken_m = (np.array(centre_of_mass(task.bones, posed.positions, posed.orientations)) - before)[:2]
    if np.abs(taken_m).max() < ARMS_MATTER_M:
        return found
    wanted = np.array(reference.com_wanted_m) - taken_m
    aside = reference._replace(com_wanted_m=(float(wanted[0]), float(wanted[1])))
    again = solve_least_squares(task, aside, found.variables, posed, settings.solver.polish_tolerance, 20)
    return found._replace(variables=again.variables)


def _legs_trouble(task: Task, variables: np.ndarray, posed: Posed, tolerance_m: float) -> float:
    """What limits forbid the planted legs in the pose that would be shown, radians."""
    pose_exactly(task, variables[:3].copy(), np.clip(variables[3:], 0.0, 1.0), posed, tolerance_m)
    return float(posed.trouble[:2].max())


def refer_to(task: Task, posed: Posed, com_m, controls, settings: Settings) -> Reference:
    """What the errors are measured from: the rules pose in `posed`, and the COM wanted, once and for all."""
    o = settings.objective
    towards = np.array([-task.threat.direction[0], -task.threat.direction[1]])
    along_ground = float(np.sqrt(np.sum(towards * towards)))
    if along_ground > 1e-6:  # a threat from straight above asks for no bracing
        towards = towards / along_ground
    else:
        towards = np.zeros(2)
    wanted = com_m[:2] + settings.balance.brace_m * towards
    weights = (
        o.balance_weight, o.hands_weight, o.torso_weight, o.pelvis_height_weight, o.feet_weight,
        o.control_weight, o.limits_weight, o.outside_weight,
    )  # fmt: skip
    return Reference(
        (float(com_m[0]), float(com_m[1])),
        (float(wanted[0]), float(wanted[1])),
        posed.palms.copy(),
        posed.orientations[[PELVIS, WAIST, BACK]].copy(),
        float(posed.positions[PELVIS, 2]),
        controls.copy(),
        weights,
        o.smoothing_m,
        False,
        SOFT_REACH_M,
    )


@njit(cache=True)
def pose_exactly(task, shift, controls, posed, tolerance_m):
    """Writes the pose with planted feet where they are planted; returns how far the pelvis had to give (3,),
    metres.

    The pelvis is lowered by what is missing, which leaves the COM over the same ground. Only where the foot lies
    farther to the side than the leg is long is it drawn towards it.
    """
    given, most = np.zeros(3), np.zeros(3)
    apply_rules(task, shift, controls, EXACT, posed)
    for _ in range(LOWERINGS):
        short = 0
        most[:] = 0.0
        for side in range(2):
            if task.feet.held[side] and posed.foot_miss_m[side] > tolerance_m:
                short += 1
                hip, ankle = vector.at(posed.positions, HIPS[side]), vector.at(task.feet.ankle_m, side)
                x, y, z = _missing(hip, ankle, task.build.leg_m[side])
                most[0] += x
                most[1] += y
                most[2] = min(most[2], z)
        if short == 0:
            break
        given[0] += most[0] / short
        given[1] += most[1] / short
        given[2] += most[2]
        apply_rules(task, shift + given, controls, EXACT, posed)
    low_rad, high_rad = task.start.low_rad, task.start.high_rad
    for side in range(2):
        # what no swivel of the elbow could mend: the shoulder stops, and the hand with it
        if posed.trouble[2 + side] > 0.0:
            stop_shoulder(
                side, task.bones.offset_m, low_rad, high_rad, posed.rotations, posed.positions, posed.orientations
            )
            palm = quaternion.rotate(quaternion.at(posed.orientations, WRISTS[side]), task.build.palm_m[side])
            vector.put(posed.palms, side, vector.add(vector.at(posed.positions, WRISTS[side]), palm))
    return given


@njit(cache=True)
def _missing(hip, ankle, leg_m):
    """What brings one hip within reach of its foot: down; along the leg too, where it lies farther aside than down."""
    reach = leg_m - 1e-6
    x, y, z = vector.subtract(hip, ankle)
    level = reach * reach - x * x - y * y
    if level > 0.25 * reach * reach:
        return (0.0, 0.0, np.sqrt(level) - z)
    return vector.scale((x, y, z), reach / vector.length((x, y, z)) - 1.0)


def case_of(inside_before: bool, inside_after: bool) -> Case:
    """Names the outcome of fig. 3.10. The COM moves towards the threat only, so out after in is out on the
    threat's side.
    """
    if inside_after:
        return Case.BALANCED if inside_before else Case.MENDED
    return Case.BRACED_OUT if inside_before else Case.UNRECOVERED


def _pose_of(posed: Posed) -> Pose:
    return Pose(posed.positions[PELVIS].copy(), posed.rotations.copy())


def mirror_protection(found: Protection) -> Protection:
    """The same, left and right exchanged."""
    return found._replace(
        rules=mirror_pose(found.rules),
        sustained=mirror_pose(found.sustained),
        controls_initial=mirror_controls(found.controls_initial),
        controls=mirror_controls(found.controls),
        com_rules_m=found.com_rules_m * FLIP_POINT,
        com_m=found.com_m * FLIP_POINT,
        com_wanted_m=found.com_wanted_m * FLIP_POINT[:2],
        support_m=found.support_m[::-1] * FLIP_POINT[:2],
        choices=mirror_choices(found.choices),
        feet=mirror_feet(found.feet),
        task=mirror_task(found.task),
        reference=mirror_reference(found.reference),
    )
