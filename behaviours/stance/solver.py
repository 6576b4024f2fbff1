"""The torso's solver (section 5.2): amplitudes that keep to the shape and bring the shoulders within reach of the targets.

The objective is eq. 5, a weighted sum of penalties: one for each unknown about its wanted value, one for each wrist target on the
distance from that arm's shoulder, and one for each further place in the world. It is minimised along one unknown after the other by
Brent's method, cycle after cycle, until it is within tolerance of zero or stops improving.

Beyond the paper: amplitudes never leave the joints' limits, and where a hard reach fights the shape the weight of the reach grows by
itself until the target is met or more weight no longer helps (the paper tunes by hand).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from behaviours.stance import arms, balance, brent, torso
from behaviours.stance.assembly import assemble
from behaviours.stance.penalty import penalty_of
from engine.body.skeleton import SHOULDERS
from engine.maths import vector

WITHIN = 1e-6  # the objective that counts as zero
STOPS_IMPROVING = 0.01  # a cycle that gains less than this share of the objective is the last one
MOST_CYCLES = 20  # of one weight of the reach
REACH_GROWTH, MOST_GROWTHS = 10.0, 5

# first step and tolerance of each unknown's line search, in the order of torso.UNKNOWNS
STEPS = np.array([0.3, 0.3, 0.15, 0.1, 0.06, 0.1])
TOLERANCES = np.array([0.02, 0.02, 0.006, 0.006, 0.006, 0.004])


class Wishes(NamedTuple):
    """The objective's terms."""

    wanted: np.ndarray  # (6, ROW) penalty of each unknown
    weight: np.ndarray  # (6,)
    free: np.ndarray  # (6,) bool: the unknowns that may move
    reach: np.ndarray  # (2, ROW) penalty on the distance from each shoulder to its wrist's target, metres
    reach_weight: float
    place_joint: np.ndarray  # (n,) further places: the joint ...
    place_m: np.ndarray  # (n, 3) ... the point ...
    place: np.ndarray  # (n, ROW) ... the penalty on their distance, metres ...
    place_weight: np.ndarray  # (n,) ... and its weight


class Outcome(NamedTuple):
    """How a solve went."""

    cycles: int
    evaluations: int
    objective: float
    reach_weight: float  # what the automatic weight has come to
    balance_error_m: float


@njit(cache=True)
def shape_penalty(wishes, unknowns):
    """The part of eq. 5 that the unknowns decide alone."""
    total = 0.0
    for u in range(len(unknowns)):
        total += wishes.weight[u] * penalty_of(wishes.wanted[u], unknowns[u])
    return total


@njit(cache=True)
def world_penalty(plan, wishes, reach_weight, figure, way):
    """The part of eq. 5 that the figure decides, carried where its balance takes it: wrist targets and further places."""
    total = 0.0
    for side in range(2):
        if plan.reaching[side]:
            away = vector.distance(balance.carried(way, figure.positions[SHOULDERS[side]]), plan.wrist_m[side])
            total += reach_weight * penalty_of(wishes.reach[side], away)
    for p in range(len(wishes.place_joint)):
        away = vector.distance(balance.carried(way, figure.positions[wishes.place_joint[p]]), wishes.place_m[p])
        total += wishes.place_weight[p] * penalty_of(wishes.place[p], away)
    return total


@njit(cache=True)
def objective(body, plan, wishes, reach_weight, unknowns, search, figure):
    """Eq. 5. Assembles the pose (lower body and balance, torso, arms, head) only where something in the world asks for it."""
    total = shape_penalty(wishes, unknowns)
    if not _world_matters(plan, wishes):
        return total
    com_m = assemble(body, plan, unknowns, (search.offset_rad[0], search.offset_rad[1]), figure)
    return total + world_penalty(plan, wishes, reach_weight, figure, balance.settle(body, plan, search, com_m, figure))


@njit(cache=True)
def _world_matters(plan, wishes):
    return plan.reaching[0] or plan.reaching[1] or len(wishes.place_joint) > 0


@njit(cache=True)
def minimise_line(body, plan, wishes, reach_weight, unknowns, u, value, bounds, search, figure, line):
    """One line search, along one unknown, in place. Returns the objective there and the evaluations."""
    brent.begin(line, unknowns[u], value, STEPS[u], bounds[u, 0], bounds[u, 1])
    while not brent.finished(line):
        unknowns[u] = line.numbers[brent.TRIAL]
        brent.tell(line, objective(body, plan, wishes, reach_weight, unknowns, search, figure), TOLERANCES[u])
    unknowns[u], value = brent.best(line)
    return value, line.counts[1]


@njit(cache=True)
def minimise_cycles(body, plan, wishes, reach_weight, unknowns, bounds, search, figure):
    """Cycles of line searches until the objective is zero or stops improving. Returns objective, cycles, evaluations."""
    line = brent.new_line()
    value = objective(body, plan, wishes, reach_weight, unknowns, search, figure)
    cycles, evaluations = 0, 1
    while value > WITHIN and cycles < MOST_CYCLES:
        before = value
        for u in range(len(unknowns)):
            if wishes.free[u]:
                value, more = minimise_line(
                    body, plan, wishes, reach_weight, unknowns, u, value, bounds, search, figure, line
                )
                evaluations += more
        cycles += 1
        if before - value <= STOPS_IMPROVING * before + WITHIN:
            break
    return value, cycles, evaluations


@njit(cache=True)
def reach_distance_m(plan, figure, side):
    """From a shoulder to its wrist's target."""
    return vector.distance(figure.positions[SHOULDERS[side]], plan.wrist_m[side])


@njit(cache=True)
def out_of_reach_m(body, plan, figure):
    """By how much the farther target lies beyond its arm, metres; 0 when both are within reach."""
    worst = 0.0
    for side in range(2):
        if plan.reaching[side]:
            worst = max(worst, reach_distance_m(plan, figure, side) - arms.arm_length_m(body, side))
    return worst


@njit(cache=True)
def solve_torso(body, plan, wishes, unknowns, search, figure):
    """Finds the unknowns (6,), in place, from where they are; assembles the figure, balanced. Returns an Outcome."""
    bounds = torso.amplitude_bounds(body, plan.classes, plan.opposed)
    for u in range(len(unknowns)):
        unknowns[u] = min(max(unknowns[u], bounds[u, 0]), bounds[u, 1])
    error = balance.find_balance(body, plan, unknowns, search, figure)
    weight, cycles, evaluations = wishes.reach_weight, 0, 0
    value = 0.0
    for growth in range(MOST_GROWTHS + 1):
        missing = out_of_reach_m(body, plan, figure)
        value, more_cycles, more = minimise_cycles(body, plan, wishes, weight, unknowns, bounds, search, figure)
        cycles, evaluations = cycles + more_cycles, evaluations + more
        error = balance.find_balance(body, plan, unknowns, search, figure)
        now_missing = out_of_reach_m(body, plan, figure)
        if now_missing == 0.0 or growth == MOST_GROWTHS or (growth > 1 and now_missing > 0.97 * missing):
            break
        weight *= REACH_GROWTH
    return Outcome(cycles, evaluations, value, weight, error)


@njit(cache=True)
def finish_arms(body, plan, figure, wrist_error_m, swivel_rad):
    """Puts the reaching wrists on their targets inside the joints' limits; writes the misses and the swivels taken."""
    for side in range(2):
        wrist_error_m[side] = 0.0
        swivel_rad[side] = plan.arm[side, arms.SWIVEL] + arms.NEUTRAL_SWIVEL
        if plan.reaching[side]:
            wrist_error_m[side], swivel_rad[side] = arms.reach_within_limits(
                body, figure.rotations, figure.positions, figure.orientations, side,
                plan.wrist_m[side], swivel_rad[side],
            )  # fmt: skip
