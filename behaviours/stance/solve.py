"""A stance from its name and one number: `solve_stance`. Below it, a stance from its parameters: `solve_shape`."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.stance import arms, balance, footprints, lower_body, penalty, shape_sets, solver, torso, wrists
from behaviours.stance.around import look_around
from behaviours.stance.assembly import Plan, new_figure
from behaviours.stance.footprints import Footprints
from behaviours.stance.penalty import Side
from behaviours.stance.shape import HEAVIER, LEFT_FOOT, Shape, mix, shape
from engine.body import kinematics, limits
from engine.body.skeleton import ANKLES, HIPS, KNEES, TOES, Body, Pose
from engine.core.errors import BadInput

# a neutral knee is not locked
NEUTRAL_KNEE_RAD = np.radians(4.0)
LEGS = np.array([*HIPS, *KNEES, *ANKLES, *TOES])
ROUNDING_RAD = 1e-9
MOST_EASINGS = 4


class Place(NamedTuple):
    """A further wish in the world: how far a joint above the pelvis is to be from a point (5.2, last lines)."""

    joint: int
    point_m: tuple[float, float, float]
    penalty: np.ndarray  # penalty.row of the distance, metres
    weight: float = 1.0


class StanceResult(NamedTuple):
    """A solved stance. World frame, metres, radians; sides left, right. What it is worth: `measures`."""

    pose: Pose
    joints_m: np.ndarray  # (J, 3)
    orientations: np.ndarray  # (J, 4)
    shape: Shape  # as it was asked for
    unknowns: np.ndarray  # (6,) amplitudes as they came out, in the order of torso.UNKNOWNS
    wishes: solver.Wishes
    outcome: solver.Outcome
    plan: Plan  # what was assembled
    balance_rad: np.ndarray  # (2,) the root ankle's offsets, the paper's X and Z
    feet: Footprints
    com_m: np.ndarray  # (3,)
    wrist_error_m: np.ndarray  # (2,) 0 without a target
    swivel_rad: np.ndarray  # (2,) taken
    kept: float  # share of the lower body's wishes that the legs' limits left, 1 when all


def solve_stance(
    body: Body,
    set_name: str,
    intensity: float,
    *,
    object_m=None,
    reach_left_m=None,
    reach_right_m=None,
    feet: Footprints | None = None,
    balance_m=None,
) -> StanceResult:
    """The stance of a shape set at an intensity. Pure; world points (3,) or None.

    object_m: what the stance is about, and what is looked at (a wrist's target is, where there is no object). feet:
    where they stand, by default side by side about the origin, as wide as the set says. balance_m (2,): where the
    centre of mass is to project, instead of where the set puts it. BadInput for an unknown set and for numbers that
    are not finite.
    """
    feet_given = feet is not None
    feet = feet if feet is not None else footprints.stand(body)
    if not np.isfinite(intensity):
        raise BadInput("stance", f"intensity is {intensity}, expected a finite number")
    reach_m = (_point(reach_left_m, "reach_left_m"), _point(reach_right_m, "reach_right_m"))
    object_m = _point(object_m, "object_m")
    reaching = (reach_m[0] is not None, reach_m[1] is not None)
    target = object_m if object_m is not None else next((p for p in reach_m if p is not None), None)
    wanted = shape_sets.shape_of(set_name, intensity, look_around(body, feet, target, reaching))
    if not feet_given and wanted.numbers.width_m != 0.0:
        feet = footprints.stand(body, width_m=max(footprints.neutral_width_m(body) + wanted.numbers.width_m, 0.0))
    return solve_shape(body, wanted, feet, reach_m=reach_m, look_at_m=target, balance_m=balance_m)


def solve_saved(
    body: Body, own: Shape, intensity: float = 1.0, *, object_m=None, reach_left_m=None, reach_right_m=None, feet=None
) -> StanceResult:
    """`solve_stance` for a shape of one's own: from neutral at 0 to the shape at 1, and past it."""
    if not np.isfinite(intensity):
        raise BadInput("stance", f"intensity is {intensity}, expected a finite number")
    reach_m = (_point(reach_left_m, "reach_left_m"), _point(reach_right_m, "reach_right_m"))
    look_at_m = next((p for p in (_point(object_m, "object_m"), *reach_m) if p is not None), None)
    wanted = mix(shape(), own, intensity)
    return solve_shape(body, wanted, feet, reach_m=reach_m, look_at_m=look_at_m)


def solve_shape(
    body: Body,
    wanted: Shape,
    feet: Footprints | None = None,
    *,
    reach_m=(None, None),
    look_at_m=None,
    balance_m=None,
    places: tuple[Place, ...] = (),
) -> StanceResult:
    """The pose of a shape: every low-level parameter is in `wanted`. Feet and points as in `solve_stance`."""
    if feet is None:
        feet = footprints.stand(body, width_m=max(footprints.neutral_width_m(body) + wanted.numbers.width_m, 0.0))
    feet = footprints.raised(body, feet, wanted.numbers.rise_rad)
    plan = plan_of(body, wanted, feet, reach_m, look_at_m, balance_m)
    wishes = wishes_of(body, wanted, places)
    kept, unknowns, search, figure, outcome, found = _solve_within_limits(body, plan, wishes)
    plan = _eased(body, plan, kept)
    return StanceResult(
        pose=Pose(figure.root_m, figure.rotations),
        joints_m=figure.positions,
        orientations=figure.orientations,
        shape=wanted,
        unknowns=unknowns,
        wishes=wishes,
        outcome=outcome,
        plan=plan,
        balance_rad=search.offset_rad,
        feet=feet,
        com_m=np.array(kinematics.centre_of_mass(body, figure.positions, figure.orientations)),
        wrist_error_m=found[wrists.MISS],
        swivel_rad=found[wrists.SWIVEL],
        kept=kept,
    )


def plan_of(body: Body, wanted: Shape, feet: Footprints, reach_m=(None, None), look_at_m=None, balance_m=None) -> Plan:
    """The kernels' view of a shape on given (already raised) feet."""
    states, n = wanted.states, wanted.numbers
    dominant = states.dominant
    if dominant == HEAVIER:
        root = 0 if n.balance_x >= 0.0 else 1
    else:
        root = 0 if dominant == LEFT_FOOT else 1
    if balance_m is None:
        balance_m = footprints.middle_m(body, feet, n.balance_x, n.balance_z)
    lower = lower_body.ask(
        body, feet.ankle_m, feet.foot_turned, feet.toe_rad, root,
        NEUTRAL_KNEE_RAD + np.array([n.knee_left_rad, n.knee_right_rad]),
        np.array([n.pelvis_x_rad, n.pelvis_y_rad, n.pelvis_z_rad]),
        states.trade_off == lower_body.PELVIS_EXACT,
    )  # fmt: skip
    reaching = np.array([p is not None for p in reach_m])
    return Plan(
        lower=lower,
        classes=np.array([torso.SHAPE_CLASSES.index(c) for c in (states.sagittal_class, states.coronal_class)]),
        opposed=np.array([states.collar_y == torso.OPPOSED, states.collar_z == torso.OPPOSED]),
        arm=np.array([
            (n.arm_out_left_rad, n.arm_forward_left_rad, n.elbow_left_rad,
             n.arm_turn_left_rad, n.palm_left_rad, n.swivel_left_rad),
            (n.arm_out_right_rad, n.arm_forward_right_rad, n.elbow_right_rad,
             n.arm_turn_right_rad, n.palm_right_rad, n.swivel_right_rad),
        ]),
        reaching=reaching,
        wrist_m=np.array([(0.0, 0.0, 0.0) if p is None else p for p in reach_m], float),
        look_at_m=np.array((0.0, 0.0, 0.0) if look_at_m is None else look_at_m, float),
        gaze=0.0 if look_at_m is None else min(max(n.gaze, 0.0), 1.0),
        balance_m=np.array(balance_m, float),
    )  # fmt: skip


def wishes_of(body: Body, wanted: Shape, places: tuple[Place, ...] = ()) -> solver.Wishes:
    """The terms of eq. 5 for a shape."""
    numbers = unknowns_of(wanted)
    rows = np.array([(number, *wish.low, *wish.high) for number, wish in zip(numbers, wanted.wishes, strict=True)])
    free = np.ones(len(numbers), bool)
    free[torso.ABDOMEN_X] = wanted.states.solve_abdomen
    n = len(places)
    return solver.Wishes(
        wanted=rows,
        weight=np.array([wish.weight for wish in wanted.wishes]),
        free=free,
        reach=np.array([reach_penalty(arms.arm_length_m(body, side)) for side in range(2)]),
        reach_weight=1.0,
        place_joint=np.array([p.joint for p in places], np.int64),
        place_m=np.array([p.point_m for p in places], float).reshape(n, 3),
        place=np.array([p.penalty for p in places], float).reshape(n, penalty.ROW),
        place_weight=np.array([p.weight for p in places], float),
    )


def reach_penalty(arm_m: float) -> np.ndarray:
    """The penalty on the distance from shoulder to target: none from a well bent to an easily stretched arm, then
    rising.

    Gently, so that the line searches are not led along a steep-sided valley; what is lacking in the end is made up
    for by `solver.give_way`.
    """
    return penalty.row(
        0.7 * arm_m, Side(0.25 * arm_m, 0.0, 0.7 * arm_m, 1.0), Side(0.12 * arm_m, 0.0, 0.6 * arm_m, 1.0)
    )


def unknowns_of(wanted: Shape) -> np.ndarray:
    """(6,) the numbers of a shape that the solver may change, in the order of torso.UNKNOWNS."""
    n = wanted.numbers
    return np.array([n.coronal, n.sagittal, n.transverse_rad, n.collar_y_rad, n.collar_z_rad, n.abdomen_x_rad])


def _solve_within_limits(body, plan, wishes):
    """Solves; where a leg would break a limit, with so much of the lower body's wishes as it allows (by halving).

    Returns (share kept, unknowns, balance search, figure, outcome, wrists (3, 2)).
    """
    kept, solved = 1.0, _solve(body, plan, wishes)
    for _ in range(MOST_EASINGS):
        if _leg_excess_rad(body, solved[2]) <= ROUNDING_RAD:
            break
        kept = _share_allowed(body, plan, solved[0], kept)
        solved = _solve(body, _eased(body, plan, kept), wishes)
    return kept, *solved


def _share_allowed(body, plan, unknowns, refused):
    """The largest share of the lower body's wishes, below the one refused, that the legs' limits allow with this
    torso.
    """
    allowed, figure = 0.0, new_figure()
    for _ in range(10):
        middle = 0.5 * (allowed + refused)
        eased = _eased(body, plan, middle)
        balance.find_balance(body, eased, unknowns, balance.new_search(eased.lower), figure)
        if _leg_excess_rad(body, figure) > 0.0:
            refused = middle
        else:
            allowed = middle
    return allowed


def _solve(body, plan, wishes):
    unknowns, search, figure = wishes.wanted[:, penalty.WANTED].copy(), balance.new_search(plan.lower), new_figure()
    found = np.zeros((3, 2))
    plan = plan._replace(arm=plan.arm.copy())  # the solver may change the swivels
    outcome = solver.solve_torso(body, plan, wishes, unknowns, search, figure, found)
    return unknowns, search, figure, outcome, found


def _eased(body, plan, share) -> Plan:
    """The plan with only a share of what it asks of pelvis, knees and balance."""
    if share == 1.0:
        return plan
    lower = plan.lower
    middle = footprints.middle_m(body, Footprints(lower.ankle_m, lower.foot_turned, lower.toe_rad))
    knees = NEUTRAL_KNEE_RAD + share * (lower.knee_rad - NEUTRAL_KNEE_RAD)
    lower = lower_body.ask(
        body, lower.ankle_m, lower.foot_turned, lower.toe_rad, lower.root,
        knees, share * lower.pelvis_rad, lower.pelvis_exact,
    )  # fmt: skip
    return plan._replace(lower=lower, balance_m=middle + share * (plan.balance_m - middle))


def _leg_excess_rad(body, figure):
    return limits.excess_rad(body, figure.rotations)[LEGS].max()


def _point(value, name):
    """A world point as an array, or None. BadInput for anything else."""
    if value is None:
        return None
    point = np.asarray(value, float)
    if point.shape != (3,) or not np.isfinite(point).all():
        raise BadInput("stance", f"{name} is {value}, expected three finite numbers")
    return point
