"""The sustained pose (Hermens 2006, 3.3): the rules, then the search that balances it and braces it towards the
threat.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from behaviours.perceive.perceived import PerceivedThreat
from behaviours.protect.apply_rules import apply_rules
from behaviours.protect.balance_search import draw_back, keep_limits, legs_trouble, solve, starts_of, weigh_arms
from behaviours.protect.exact_feet import EXACT, pose_exactly
from behaviours.protect.mirroring import (
    mirror_choices,
    mirror_controls,
    mirror_feet,
    mirror_pose,
    mirror_reference,
    mirror_task,
)
from behaviours.protect.prepare import prepare
from behaviours.protect.task import AtPerception, Choices, FeetPlan, Posed, Task, new_posed
from behaviours.protect.total_error import (
    FORMS,
    RESIDUALS,
    Reference,
    measure_into,
    term_errors,
    total_error,
)
from behaviours.rules.controls import controls_from_threat
from behaviours.settings import Settings
from engine.body.kinematics import centre_of_mass
from engine.body.skeleton import BACK, PELVIS, WAIST, Body, Pose
from engine.body.support import inside, polygon_of
from engine.body.two_bones import SOFT_REACH_M
from engine.clips.mirror import FLIP_POINT, mirror_body
from engine.maths import minimise


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


def protect(body: Body, at: AtPerception, threat: PerceivedThreat, settings: Settings) -> Protection:
    """The pose in which to meet a threat."""
    return solve_protection(body, prepare(body, at, threat, settings), settings)


def solve_protection(body: Body, task: Task, settings: Settings) -> Protection:
    """Rules pose, search and report, for a task that is prepared. Who turns left is worked out in the mirror."""
    if task.choices.turn_side > 0.0:
        return mirror_protection(_solve_protection(mirror_body(body), mirror_task(task), settings))
    return _solve_protection(body, task, settings)


def _solve_protection(body: Body, task: Task, settings: Settings) -> Protection:
    """The same for a task that turns right, or not at all."""
    posed, form = new_posed(), FORMS.index(settings.objective.form)
    controls = controls_allowed(task, posed, settings)
    rules_shift = pose_exactly(task, np.zeros(3), controls, posed, settings.balance.foot_tolerance_m)
    # the rules pose is the start: what it took to plant its feet exactly belongs to it
    task = task._replace(start=task.start._replace(root_m=task.start.root_m + rules_shift))
    rules = _stood(body, task, posed)
    plain = new_posed()  # as the search sees it: arms as the rules want them
    apply_rules(task, np.zeros(3), controls, EXACT, plain)
    reference = refer_to(task, plain, rules.com_m, controls, settings)
    reported = reference._replace(palms=posed.palms.copy())  # errors are told of the poses that are shown
    start = np.concatenate([np.zeros(3), controls])
    errors_initial = _errors(task, reported, form, start, controls, posed)
    if task.feet.held.any():
        final, report = _search(task, reference, form, start, posed, settings)
        controls_end, sustained = np.clip(final[3:], 0.0, 1.0), _stood(body, task, posed)
        errors = _errors(task, reported, form, final, controls_end, posed)
        case = case_of(inside(rules.support_m, rules.com_m[:2]), inside(sustained.support_m, sustained.com_m[:2]))
    else:
        controls_end, sustained, errors, case = controls, rules, errors_initial, Case.AIRBORNE
        report = SolverReport(settings.solver.method, 0, 0, 0, "not needed", 0)
    return Protection(
        rules.pose, sustained.pose, controls, controls_end, rules.com_m, sustained.com_m,
        np.array(reference.com_wanted_m), sustained.support_m, case, errors_initial, errors, task.choices, task.feet,
        report, task, reference,
    )  # fmt: skip


class _Stood(NamedTuple):
    """A pose as it stands. World metres."""

    pose: Pose
    com_m: np.ndarray  # (3,)
    support_m: np.ndarray  # (m, 2) support polygon


def _stood(body: Body, task: Task, posed: Posed) -> _Stood:
    """The pose that kernels have just made."""
    return _Stood(
        Pose(posed.positions[PELVIS].copy(), posed.rotations.copy()),
        np.array(centre_of_mass(task.bones, posed.positions, posed.orientations)),
        polygon_of(body, posed.positions, posed.orientations, task.feet.held),
    )


def _errors(task: Task, reference: Reference, form: int, variables, controls, posed: Posed) -> dict[str, float]:
    """Each term of the total error, and the total, of a pose that is there."""
    residuals = np.empty(RESIDUALS)
    measure_into(task, reference, variables, controls, posed, residuals)
    return term_errors(residuals) | {"total": float(total_error(residuals, reference, form))}


def _search(
    task: Task, reference: Reference, form: int, start: np.ndarray, posed: Posed, settings: Settings
) -> tuple[np.ndarray, SolverReport]:
    """The variables (10,) of the balanced, braced pose, which is left in `posed` as it is shown, and how it went."""
    solution, polishing = solve(task, reference, form, start, posed, settings)
    solution, weighed = weigh_arms(task, reference, solution, form, posed, settings)
    solution = keep_limits(task, weighed, solution, posed, settings)
    shift, controls = solution.variables[:3].copy(), np.clip(solution.variables[3:], 0.0, 1.0)
    shift += pose_exactly(task, shift, controls, posed, settings.balance.foot_tolerance_m)
    report = SolverReport(
        settings.solver.method,
        int(solution.iterations),
        int(solution.evaluations),
        int(solution.restarts),
        minimise.STOPS[solution.stop],
        polishing,
    )
    return np.concatenate([shift, solution.variables[3:]]), report


def controls_allowed(task: Task, posed: Posed, settings: Settings) -> np.ndarray:
    """(7,) the controls that the threat asks for, with as much of lean and turn as the planted legs allow.

    Both take the pelvis along; over feet that stand crossed or far apart a hip would be beyond its limits.
    """
    wanted = np.concatenate([np.zeros(3), controls_from_threat(task.threat.speed_norm, task.threat.size_norm)])
    _, upright = starts_of(wanted)
    tolerance_m = settings.balance.foot_tolerance_m
    if legs_trouble(task, upright, posed, tolerance_m) >= task.rules.limit_margin_rad:
        return wanted[3:]  # it is not lean and turn that take a leg beyond: the search moves the pelvis
    return draw_back(task, upright, wanted, posed, tolerance_m)[3:]


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
        SOFT_REACH_M,
    )


def case_of(inside_before: bool, inside_after: bool) -> Case:
    """Names the outcome of fig. 3.10. The COM moves towards the threat only, so out after in is out on the
    threat's side.
    """
    if inside_after:
        return Case.BALANCED if inside_before else Case.MENDED
    return Case.BRACED_OUT if inside_before else Case.UNRECOVERED


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
