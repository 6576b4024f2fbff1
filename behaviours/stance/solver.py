"""The torso's solver (section 5.2): amplitudes that keep to the shape and bring the shoulders within reach of the targets.

The objective is eq. 5, a weighted sum of penalties: one for each unknown about its wanted value, one for each wrist target on the
distance from that arm's shoulder, and one for each further place in the world. It is minimised along one unknown after the other by
Brent's method, cycle after cycle, until it is within tolerance of zero or stops improving.

Beyond the paper: amplitudes never leave the joints' limits, and where a hard reach fights the shape the weight of the reach grows by
itself until the target is met or more weight no longer helps (the paper tunes by hand).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from behaviours.stance import arms, balance, brent, torso
from behaviours.stance.assembly import assemble
from behaviours.stance.penalty import penalty_of
from engine.body import kinematics
from engine.body.skeleton import SHOULDERS
from engine.maths import vector

WITHIN = 1e-6  # the objective that counts as zero
STOPS_IMPROVING = 0.03  # a cycle that gains less than this share of the objective is the last one
MOST_CYCLES = 20  # of one weight of the reach
# the automatic weights: a target counts as missed from here on; more pull helps if it leaves less than this share of the miss
MISSED_M, HELPS = 1e-4, 0.9
GROWTH, FIRST_STRAIN, STRONGEST = 10.0, 10.0, 2e4
FINISHING, FINISHED_M = 12, 1e-5

# rows of `wrists`
MISS, SWIVEL, STRAIN = range(3)

# first step and tolerance of each unknown's line search, in the order of torso.UNKNOWNS
STEPS = np.array([0.3, 0.3, 0.15, 0.1, 0.06, 0.1])
TOLERANCES = np.array([0.05, 0.05, 0.015, 0.012, 0.012, 0.01])


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


class Pull(NamedTuple):
    """The automatic weights: how hard the wrists' targets pull on the torso."""

    reach: float  # of the penalties on shoulder to target
    strain: float  # of the squared radians by which a reaching arm is beyond its limits
    abdomen: bool  # whether the abdomen may help, though its shape does not say so


class Outcome(NamedTuple):
    """How a solve went."""

    cycles: int
    evaluations: int
    objective: float
    reach_weight: float  # what the automatic weights have come to
    strain_weight: float
    balance_error_m: float


@njit(cache=True)
def shape_penalty(wishes, unknowns):
    """The part of eq. 5 that the unknowns decide alone."""
    total = 0.0
    for u in range(len(unknowns)):
        total += wishes.weight[u] * penalty_of(wishes.wanted[u], unknowns[u])
    return total


@njit(cache=True)
def world_penalty(body, plan, wishes, pull, figure, way):
    """The part of eq. 5 that the figure decides, carried where its balance takes it: wrist targets and further places."""
    total = 0.0
    for side in range(2):
        if plan.reaching[side]:
            away = vector.distance(balance.carried(way, figure.positions[SHOULDERS[side]]), plan.wrist_m[side])
            total += pull.reach * penalty_of(wishes.reach[side], away)
            if pull.strain > 0.0:
                total += pull.strain * arms.strain_rad(body, figure.rotations, side) ** 2
    for p in range(len(wishes.place_joint)):
        away = vector.distance(balance.carried(way, figure.positions[wishes.place_joint[p]]), wishes.place_m[p])
        total += wishes.place_weight[p] * penalty_of(wishes.place[p], away)
    return total


@njit(cache=True)
def objective(body, plan, wishes, pull, unknowns, search, figure):
    """Eq. 5. Assembles the pose (lower body and balance, torso, arms, head) only where something in the world asks for it."""
    total = shape_penalty(wishes, unknowns)
    if not _world_matters(plan, wishes):
        return total
    com_m = assemble(body, plan, unknowns, (search.offset_rad[0], search.offset_rad[1]), figure)
    return total + world_penalty(body, plan, wishes, pull, figure, balance.settle(body, plan, search, com_m, figure))


@njit(cache=True)
def _world_matters(plan, wishes):
    return plan.reaching[0] or plan.reaching[1] or len(wishes.place_joint) > 0


@njit(cache=True)
def minimise_line(body, plan, wishes, pull, unknowns, u, value, bounds, search, figure, line):
    """One line search, along one unknown, in place. Returns the objective there and the evaluations."""
    brent.begin(line, unknowns[u], value, STEPS[u], bounds[u, 0], bounds[u, 1])
    while not brent.finished(line):
        unknowns[u] = line.numbers[brent.TRIAL]
        brent.tell(line, objective(body, plan, wishes, pull, unknowns, search, figure), TOLERANCES[u])
    unknowns[u], value = brent.best(line)
    return value, line.counts[1]


@njit(cache=True)
def minimise_cycles(body, plan, wishes, pull, unknowns, bounds, search, figure):
    """Cycles of line searches until the objective is zero or stops improving. Returns objective, cycles, evaluations."""
    line = brent.new_line()
    before, cycles, evaluations = np.inf, 0, 0
    while True:
        # every cycle begins in balance, so that one step of its search is enough inside the evaluations
        balance.find_balance(body, plan, unknowns, search, figure)
        value = objective(body, plan, wishes, pull, unknowns, search, figure)
        evaluations += 1
        if value <= WITHIN or cycles == MOST_CYCLES or before - value <= STOPS_IMPROVING * value:
            return value, cycles, evaluations
        before = value
        for u in range(len(unknowns)):
            if wishes.free[u] or (pull.abdomen and u == torso.ABDOMEN_X):
                value, more = minimise_line(
                    body, plan, wishes, pull, unknowns, u, value, bounds, search, figure, line
                )
                evaluations += more
        cycles += 1


@njit(cache=True)
def reach_distance_m(plan, positions, side):
    """From a shoulder to its wrist's target."""
    return vector.distance(positions[SHOULDERS[side]], plan.wrist_m[side])


@njit(cache=True)
def out_of_reach_m(body, plan, figure):
    """By how much the farther target lies beyond its arm, metres; 0 when both are within reach."""
    worst = 0.0
    for side in range(2):
        if plan.reaching[side]:
            worst = max(worst, reach_distance_m(plan, figure.positions, side) - arms.arm_length_m(body, side))
    return worst


@njit(cache=True)
def solve_torso(body, plan, wishes, unknowns, search, figure, wrists):
    """Finds the unknowns (6,), in place, from where they are; assembles the figure, balanced, its arms within their limits.

    wrists (3, 2), written for left, right: how far each misses its target, the swivel taken, the strain. Returns an Outcome.
    The pull grows tenfold while a target is missed, as long as that helps.
    """
    bounds = torso.amplitude_bounds(body, plan.classes, plan.opposed)
    for u in range(len(unknowns)):
        unknowns[u] = min(max(unknowns[u], bounds[u, 0]), bounds[u, 1])
    pull, cycles, evaluations, missed = Pull(wishes.reach_weight, 0.0, False), 0, 0, np.inf
    while True:
        value, more_cycles, more = minimise_cycles(body, plan, wishes, pull, unknowns, bounds, search, figure)
        cycles, evaluations = cycles + more_cycles, evaluations + more
        error = finish(body, plan, unknowns, search, figure, wrists)
        now_missed = max(wrists[MISS, 0], wrists[MISS, 1])
        stronger = _pull_harder(body, plan, pull, figure, wrists)
        if now_missed < MISSED_M or now_missed > HELPS * missed or stronger.reach + stronger.strain > STRONGEST:
            return Outcome(cycles, evaluations, value, pull.reach, pull.strain, error)
        missed, pull = now_missed, stronger


@njit(cache=True)
def _pull_harder(body, plan, pull, figure, wrists):
    """Ten times what was too weak: the reach where a target is too far, the strain where an arm is at its limits."""
    reach, strain = pull.reach, pull.strain
    if out_of_reach_m(body, plan, figure) > 0.0:
        reach *= GROWTH
    if max(wrists[STRAIN, 0], wrists[STRAIN, 1]) > 0.0:
        strain = max(strain * GROWTH, FIRST_STRAIN)
        for side in range(2):
            plan.arm[side, arms.SWIVEL] = wrists[SWIVEL, side] - arms.NEUTRAL_SWIVEL
    return Pull(reach, strain, True)


@njit(cache=True)
def finish(body, plan, unknowns, search, figure, wrists):
    """The figure of the unknowns, in balance with its arms within their limits. Returns how far off balance it is, metres."""
    balance.find_balance(body, plan, unknowns, search, figure)
    error_m = 0.0
    for attempt in range(FINISHING + 1):
        _finish_arms(body, plan, figure, wrists)
        com = kinematics.centre_of_mass(body, figure.positions, figure.orientations)
        error = (plan.balance_m[0] - com[0], plan.balance_m[1] - com[1])
        error_m = math.hypot(error[0], error[1])
        if error_m < FINISHED_M or attempt == FINISHING:
            break
        search.offset_rad[0], search.offset_rad[1] = balance.offsets_towards(search, search.offset_rad, error)
        assemble(body, plan, unknowns, (search.offset_rad[0], search.offset_rad[1]), figure)
    return error_m


@njit(cache=True)
def _finish_arms(body, plan, figure, wrists):
    for side in range(2):
        wanted = plan.arm[side, arms.SWIVEL] + arms.NEUTRAL_SWIVEL
        wrists[MISS, side], wrists[SWIVEL, side], wrists[STRAIN, side] = 0.0, wanted, 0.0
        if plan.reaching[side]:
            wrists[MISS, side], wrists[SWIVEL, side], wrists[STRAIN, side] = arms.reach_within_limits(
                body, figure.rotations, figure.positions, figure.orientations, side, plan.wrist_m[side], wanted
            )
