"""What a solved stance is worth: errors against what was asked, and the terms of the objective."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.stance import gaze, penalty, torso, wrists
from behaviours.stance.solve import StanceResult
from engine.body import limits, support
from engine.body.skeleton import ANKLES, PELVIS, Body
from engine.maths import quaternion

BOTH_FEET = np.array([True, True])


class Measures(NamedTuple):
    """Errors of one stance; sides left, right."""

    foot_error_m: np.ndarray  # (2,)
    foot_error_rad: np.ndarray  # (2,)
    wrist_error_m: np.ndarray  # (2,)
    balance_error_m: float  # centre of mass over the ground against where it was wanted
    limit_excess_rad: float
    gaze_error_rad: float  # nan when it looks at nothing
    support_m: np.ndarray  # (n, 2) the support polygon
    margin_m: float  # how far inside it the centre of mass projects, negative outside


def measures(body: Body, result: StanceResult) -> Measures:
    """All errors, measured on the finished pose."""
    positions, orientations, plan = result.joints_m, result.orientations, result.plan
    support_m = support.polygon_of(body, positions, orientations, BOTH_FEET)
    excess = limits.excess_rad(body, result.pose.rotations)
    excess[PELVIS] = 0.0  # nothing holds it
    return Measures(
        foot_error_m=_lengths(positions[list(ANKLES)] - plan.lower.ankle_m),
        foot_error_rad=np.array(
            [quaternion.angle_between(orientations[ANKLES[side]], plan.lower.foot_turned[side]) for side in range(2)]
        ),
        wrist_error_m=result.wrist_error_m,
        balance_error_m=float(np.hypot(*(result.com_m[:2] - plan.balance_m))),
        limit_excess_rad=float(excess.max()),
        gaze_error_rad=_gaze_error(body, result),
        support_m=support_m,
        margin_m=float(support.margin_m(support_m, result.com_m[:2])),
    )


def amplitudes(result: StanceResult) -> dict[str, float]:
    """The solver's unknowns as they came out."""
    return dict(zip(torso.UNKNOWNS, result.unknowns.tolist(), strict=True))


def penalties(result: StanceResult) -> dict[str, float]:
    """The weighted terms of eq. 5: one for each unknown, one for each wrist target."""
    wishes, plan, terms = result.wishes, result.plan, {}
    for u, name in enumerate(torso.UNKNOWNS):
        terms[name] = float(wishes.weight[u] * penalty.penalty_of(wishes.wanted[u], result.unknowns[u]))
    for side, name in enumerate(("reach_left", "reach_right")):
        if plan.reaching[side]:
            away = wrists.reach_distance_m(plan, result.joints_m, side)
            terms[name] = float(wishes.reach_weight * penalty.penalty_of(wishes.reach[side], away))
    return terms


def _lengths(vectors):
    return np.sqrt((vectors * vectors).sum(axis=-1))


def _gaze_error(body, result):
    if result.plan.gaze == 0.0:
        return float("nan")
    return float(gaze.gaze_error_rad(body, result.joints_m, result.orientations, result.plan.look_at_m))
