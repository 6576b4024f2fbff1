"""The torso's solver (section 5.2): amplitudes that keep to the shape and bring the shoulders within reach of the targets.

The objective is eq. 5, a weighted sum of penalties: one for each unknown about its wanted value, one for each wrist target on the
distance from that arm's shoulder, and one for each further place in the world. It is minimised along one unknown after the other by
Brent's method, cycle after cycle, until it is within tolerance of zero or stops improving.

Beyond the paper: amplitudes never leave the joints' limits, and a hard reach that fights the shape needs no weights tuned by hand.
Where the minimum leaves a target out of reach, or an arm beyond its limits, the reach becomes a constraint, and the shape
gives way in the proportion of its own penalties: what is wanted firmly moves little. See `give_way`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from behaviours.stance import arms, balance, brent, penalty, torso
from behaviours.stance.assembly import assemble
from behaviours.stance.penalty import penalty_of
from engine.body import kinematics
from engine.body.skeleton import SHOULDERS
from engine.maths import vector

WITHIN = 1e-6  # the objective that counts as zero
STOPS_IMPROVING = 0.03  # a cycle that gains less than this share of the objective is the last one
MOST_CYCLES = 20  # of one weight of the reach
# an elbow is not stretched beyond this share of the arm's length as long as the torso can come nearer
COMFORTABLE = 0.97
# giving way: what a metre of lack counts against a wish moved to its far point; metres that a radian of strain counts; most
# steps; a step of which no unknown moves more than this share of its wish's far point is the last; step of the differences
LACK_WEIGHT, STRAIN_M, MOST_YIELDS, SETTLED, DIFFERENCE = 1e4, 0.3, 12, 1e-3, 0.01
SHORTEST_SHARE, LONGEST_SHARE, MOST_SHORTER = 0.05, 0.7, 3
FINISHING, FINISHED_M = 12, 1e-6

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


class Outcome(NamedTuple):
    """How a solve went."""

    cycles: int
    evaluations: int
    objective: float
    yields: int  # times that the shape gave way to a reach
    balance_error_m: float


@njit(cache=True)
def shape_penalty(wishes, unknowns):
    """The part of eq. 5 that the unknowns decide alone."""
    total = 0.0
    for u in range(len(unknowns)):
        total += wishes.weight[u] * penalty_of(wishes.wanted[u], unknowns[u])
    return total


@njit(cache=True)
def world_penalty(plan, wishes, figure, way):
    """The part of eq. 5 that the figure decides, carried where its balance takes it: wrist targets and further places."""
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
    """Eq. 5. Assembles the pose (lower body and balance, torso, arms, head) only where something in the world asks for it."""
    total = shape_penalty(wishes, unknowns)
    if not _world_matters(plan, wishes):
        return total
    com_m = assemble(body, plan, unknowns, (search.offset_rad[0], search.offset_rad[1]), figure)
    return total + world_penalty(plan, wishes, figure, balance.settle(body, plan, search, com_m, figure))


@njit(cache=True)
def _world_matters(plan, wishes):
    return plan.reaching[0] or plan.reaching[1] or len(wishes.place_joint) > 0


@njit(cache=True)
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
    """Cycles of line searches until the objective is zero or stops improving. Returns objective, cycles, evaluations."""
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
                value, more = minimise_line(
                    body, plan, wishes, unknowns, u, value, bounds, search, figure, line
                )
                evaluations += more
        cycles += 1


@njit(cache=True)
def reach_distance_m(plan, positions, side):
    """From a shoulder to its wrist's target."""
    return vector.distance(positions[SHOULDERS[side]], plan.wrist_m[side])


@njit(cache=True)
def solve_torso(body, plan, wishes, unknowns, search, figure, wrists):
    """Finds the unknowns (6,), in place, from where they are; assembles the figure, balanced, its arms within their limits.

    wrists (3, 2), written for left, right: how far each misses its target, the swivel taken, the strain. Returns an Outcome.
    """
    bounds = torso.amplitude_bounds(body, plan.classes, plan.opposed)
    for u in range(len(unknowns)):
        unknowns[u] = min(max(unknowns[u], bounds[u, 0]), bounds[u, 1])
    value, cycles, evaluations = minimise_cycles(body, plan, wishes, unknowns, bounds, search, figure)
    error = finish(body, plan, unknowns, search, figure, wrists)
    yields = 0
    if greatest_lack_m(body, plan, figure, wrists) > 0.0:
        yields, more, error = give_way(body, plan, wishes, unknowns, bounds, search, figure, wrists)
        evaluations += more
    return Outcome(cycles, evaluations, value, yields, error)


@njit(cache=True)
def greatest_lack_m(body, plan, figure, wrists):
    """What a finished figure lacks: how much too far the worse shoulder is and how far its arm is beyond its limits, as metres."""
    worst = 0.0
    for side in range(2):
        if plan.reaching[side]:
            away = reach_distance_m(plan, figure.positions, side)
            too_far = max(away - COMFORTABLE * arms.arm_length_m(body, side), 0.0)
            worst = max(worst, too_far + STRAIN_M * wrists[STRAIN, side])
    return worst


@njit(cache=True)
def give_way(body, plan, wishes, unknowns, bounds, search, figure, wrists):
    """Moves the unknowns, in place, as little as the lacking reach needs. Returns (steps, evaluations, balance error).

    Least squares (Gauss-Newton) of two things: how far each unknown goes from the objective's minimum in the
    measure of its wish, and what the wrists lack, which counts so much more that half a millimetre of it is left where a
    shape has to give way altogether. Where weights would have to be tuned by hand, this finds them: what is wanted firmly
    (high weight, near wall) moves little. The abdomen may help even where its shape does not let it.
    """
    count = len(unknowns)
    minimum, before, step = unknowns.copy(), unknowns.copy(), np.empty(count)
    stiffness, slopes, lacks = np.empty(count), np.zeros((2, count)), np.empty(2)
    new_lacks = np.empty(2)
    for u in range(count):
        stiffness[u] = wishes.weight[u] / wishes.wanted[u, penalty.HIGH + 2] ** 2
    evaluations, steps = 1, 0
    _lacks_at(body, plan, unknowns, search, figure, wrists, lacks)
    value = _yielded(minimum, unknowns, stiffness, lacks)
    while steps < MOST_YIELDS:
        steps += 1
        evaluations += _slopes_at(body, plan, wishes, unknowns, bounds, search, figure, wrists, lacks, slopes)
        before[:] = unknowns
        _least_squares_step(minimum, unknowns, stiffness, lacks, slopes, bounds, step)
        slope, share = _slope_along(minimum, unknowns, stiffness, lacks, slopes, step), 1.0
        for _ in range(MOST_SHORTER + 1):
            unknowns[:] = before + share * step
            finish(body, plan, unknowns, search, figure, wrists)
            _lacks_at(body, plan, unknowns, search, figure, wrists, new_lacks)
            new_value = _yielded(minimum, unknowns, stiffness, new_lacks)
            evaluations += 1
            if new_value < value:
                break
            # the least point of the parabola through what is known along the step
            least = -0.5 * slope * share * share / max(new_value - value - slope * share, 1e-30)
            share = min(max(least, SHORTEST_SHARE * share), LONGEST_SHARE * share)
        if new_value >= value:
            unknowns[:] = before
            break
        value = new_value
        lacks[:] = new_lacks
        if np.max(np.abs(share * step) * np.sqrt(stiffness)) < SETTLED:
            break
    return steps, evaluations, finish(body, plan, unknowns, search, figure, wrists)


@njit(cache=True)
def _slope_along(minimum, unknowns, stiffness, lacks, slopes, step):
    """How fast what is minimised falls at the start of a step (negative)."""
    slope = 0.0
    for u in range(len(step)):
        slope += 2.0 * stiffness[u] * (unknowns[u] - minimum[u]) * step[u]
        for side in range(2):
            slope += 2.0 * LACK_WEIGHT * max(lacks[side], 0.0) * slopes[side, u] * step[u]
    return slope


@njit(cache=True)
def _yielded(minimum, unknowns, stiffness, lacks):
    """What is minimised while giving way."""
    total = LACK_WEIGHT * (max(lacks[0], 0.0) ** 2 + max(lacks[1], 0.0) ** 2)
    for u in range(len(unknowns)):
        total += stiffness[u] * (unknowns[u] - minimum[u]) ** 2
    return total


@njit(cache=True)
def _lacks_at(body, plan, unknowns, search, figure, wrists, lacks):
    """Writes (2,) what each wrist lacks with these unknowns, metres, negative where there is room to spare.

    Arms are strained as much as they are at the swivels that they have taken.
    """
    wanted_swivels = (plan.arm[0, arms.SWIVEL], plan.arm[1, arms.SWIVEL])
    for side in range(2):
        plan.arm[side, arms.SWIVEL] = wrists[SWIVEL, side] - arms.NEUTRAL_SWIVEL
    com_m = assemble(body, plan, unknowns, (search.offset_rad[0], search.offset_rad[1]), figure)
    way = balance.settle(body, plan, search, com_m, figure)
    for side in range(2):
        plan.arm[side, arms.SWIVEL] = wanted_swivels[side]
        lacks[side] = -1.0
        if plan.reaching[side]:
            away = vector.distance(balance.carried(way, figure.positions[SHOULDERS[side]]), plan.wrist_m[side])
            lacks[side] = away - COMFORTABLE * arms.arm_length_m(body, side)
            strain = arms.strain_rad(body, figure.rotations, side)
            if strain > arms.ROUNDING_RAD:
                lacks[side] = max(lacks[side], 0.0) + STRAIN_M * strain


@njit(cache=True)
def _slopes_at(body, plan, wishes, unknowns, bounds, search, figure, wrists, lacks, slopes):
    """Writes (2, 6) how what is lacking (2,) changes with each unknown. Returns the evaluations."""
    there = np.empty(2)
    for u in range(len(unknowns)):
        start, step = unknowns[u], DIFFERENCE * wishes.wanted[u, penalty.HIGH + 2]
        if start + step > bounds[u, 1]:
            step = -step
        unknowns[u] = start + step
        _lacks_at(body, plan, unknowns, search, figure, wrists, there)
        unknowns[u] = start
        for side in range(2):
            slopes[side, u] = (there[side] - lacks[side]) / step if plan.reaching[side] else 0.0
    return len(unknowns)


@njit(cache=True)
def _least_squares_step(minimum, unknowns, stiffness, lacks, slopes, bounds, step):
    """Writes the step (6,) of least squares.

    A wrist that lacks nothing, nor will after the step, has no say in it. An unknown that would pass a bound stops there, and
    the others make up for it.
    """
    free, counts = np.ones(len(step), np.bool_), lacks > 0.0
    left = lacks.copy()
    for _ in range(len(step) + 2):
        _free_step(minimum, unknowns, stiffness, left, slopes, free, counts, step)
        changed = False
        for u in range(len(step)):
            held = min(max(unknowns[u] + step[u], bounds[u, 0]), bounds[u, 1]) - unknowns[u]
            if free[u] and held != step[u]:
                free[u], step[u], changed = False, held, True
                left += slopes[:, u] * held
        for side in range(2):
            if not changed and not counts[side] and left[side] + _sum_over(free, slopes[side], step) > 0.0:
                counts[side], changed = True, True
        if not changed:
            return


@njit(cache=True)
def _sum_over(free, slopes, step):
    total = 0.0
    for u in range(len(step)):
        if free[u]:
            total += slopes[u] * step[u]
    return total


@njit(cache=True)
def _free_step(minimum, unknowns, stiffness, left, slopes, free, counts, step):
    """The step of the unknowns that are free: with two conditions on diagonal stiffness, two equations (Woodbury)."""
    a, b, d = 1.0 / LACK_WEIGHT, 0.0, 1.0 / LACK_WEIGHT
    towards = (left[0], left[1])
    for u in range(len(step)):
        if free[u]:
            ease, home = 1.0 / stiffness[u], minimum[u] - unknowns[u]
            first, second = slopes[0, u] * counts[0], slopes[1, u] * counts[1]
            a += first * first * ease
            b += first * second * ease
            d += second * second * ease
            towards = (towards[0] + first * home, towards[1] + second * home)
    towards = (towards[0] * counts[0], towards[1] * counts[1])
    determinant = a * d - b * b
    pull = ((d * towards[0] - b * towards[1]) / determinant, (a * towards[1] - b * towards[0]) / determinant)
    for u in range(len(step)):
        if free[u]:
            ease, home = 1.0 / stiffness[u], minimum[u] - unknowns[u]
            step[u] = home - ease * (slopes[0, u] * counts[0] * pull[0] + slopes[1, u] * counts[1] * pull[1])


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
