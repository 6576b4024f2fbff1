"""The torso's solver (section 5.2): amplitudes that keep to the shape and bring the shoulders within reach of the
targets.

The objective is eq. 5, a weighted sum of penalties: one for each unknown about its wanted value, one for each wrist
target on the distance from that arm's shoulder, and one for each further place in the world. It is minimised along
one unknown after the other by Brent's method, cycle after cycle, until it is within tolerance of zero or stops
improving.

Beyond the paper: amplitudes never leave the joints' limits, and where the minimum leaves a target out of reach, the
shape gives way by as little as the reach needs (`yielding`), without weights tuned by hand.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.stance import balance, torso, wrists
from behaviours.stance.assembly import assemble
from behaviours.stance.penalty import penalty_of
from behaviours.stance.yielding import give_way
from engine.body.skeleton import SHOULDERS
from engine.maths import brent, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

WITHIN = 1e-6  # the objective that counts as zero
STOPS_IMPROVING = 0.03  # a cycle that gains less than this share of the objective is the last one
MOST_CYCLES = 20

# first step and tolerance of each unknown's line search, in the order of torso.UNKNOWNS
STEPS = np.array([0.3, 0.3, 0.15, 0.1, 0.06, 0.1])
TOLERANCES = np.array([0.03, 0.03, 0.01, 0.008, 0.008, 0.006])


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
    yields: int  # times that the shape gave way to a reach
    balance_error_m: float


@inner_kernel
def shape_penalty(wishes, unknowns):
    """The part of eq. 5 that the unknowns decide alone."""
    total = 0.0
    for u in range(len(unknowns)):
        total += wishes.weight[u] * penalty_of(wishes.wanted[u], unknowns[u])
    return total


@inner_kernel
def world_penalty(plan, wishes, figure, way):
    """The part of eq. 5 that the figure decides, carried where its balance takes it: wrist targets and further
    places.
    """
    total = 0.0
    for side in range(2):
        if plan.reaching[side]:
            away = vector.distance(balance.carried(way, figure.positions[SHOULDERS[side]]), plan.wrist_m[side])
            total += wishes.reach_weight * penalty_of(wishes.reach[side], away)
    for p in range(len(wishes.place_joint)):
        away = vector.distance(balance.carried(way, figure.positions[wishes.place_joint[p]]), wishes.place_m[p])
        total += wishes.place_weight[p] * penalty_of(wishes.place[p], away)
    return total


@njit(cache=True)
def objective(body, plan, wishes, unknowns, search, figure):
    """Eq. 5. Assembles the pose (lower body and balance, torso, arms, head) only where something in the world asks
    for it.
    """
    total = shape_penalty(wishes, unknowns)
    if not _world_matters(plan, wishes):
        return total
    com_m = assemble(body, plan, unknowns, (search.offset_rad[0], search.offset_rad[1]), figure)
    return total + world_penalty(plan, wishes, figure, balance.settle(body, plan, search, com_m, figure))


@inner_kernel
def _world_matters(plan, wishes):
    return plan.reaching[0] or plan.reaching[1] or len(wishes.place_joint) > 0


@inner_kernel
def minimise_line(body, plan, wishes, unknowns, u, value, bounds, search, figure, line):
    """One line search, along one unknown, in place. Returns the objective there and the evaluations."""
    brent.begin(line, unknowns[u], value, STEPS[u], bounds[u, 0], bounds[u, 1])
    while not brent.finished(line):
        unknowns[u] = line.numbers[brent.TRIAL]
        brent.tell(line, objective(body, plan, wishes, unknowns, search, figure), TOLERANCES[u])
    unknowns[u], value = brent.best(line)
    return value, line.counts[1]


@njit(cache=True)
def minimise_cycles(body, plan, wishes, unknowns, bounds, search, figure):
    """Cycles of line searches until the objective is zero or stops improving. Returns objective, cycles,
    evaluations.
    """
    line = brent.new_line()
    before, cycles, evaluations = np.inf, 0, 0
    while True:
        # every cycle begins in balance, so that one step of its search is enough inside the evaluations
        balance.find_balance(body, plan, unknowns, search, figure)
        value = objective(body, plan, wishes, unknowns, search, figure)
        evaluations += 1
        if value <= WITHIN or cycles == MOST_CYCLES or before - value <= STOPS_IMPROVING * value:
            return value, cycles, evaluations
        before = value
        for u in range(len(unknowns)):
            if wishes.free[u]:
                value, more = minimise_line(body, plan, wishes, unknowns, u, value, bounds, search, figure, line)
                evaluations += more
        cycles += 1


def solve_torso(body, plan, wishes, unknowns, search, figure, found) -> Outcome:
    """Finds the unknowns (6,), in place, from where they are; assembles the figure, balanced, arms within their limits.

    found (3, 2), written for the left and right wrist: see the rows of `wrists`. Not a kernel, but what calls the
    three: one that held them all would be compiled with every line of theirs once more.
    """
    bounds = torso.amplitude_bounds(body, plan.classes, plan.opposed)
    np.clip(unknowns, bounds[:, 0], bounds[:, 1], out=unknowns)
    value, cycles, evaluations = minimise_cycles(body, plan, wishes, unknowns, bounds, search, figure)
    error, yields = wrists.finish(body, plan, unknowns, search, figure, found), 0
    if plan.reaching.any() and wrists.greatest_lack_m(body, plan, figure, found) > 0.0:
        yields, more, error = give_way(body, plan, wishes, unknowns, bounds, search, figure, found)
        evaluations += more
    return Outcome(cycles, evaluations, value, yields, error)
