"""Both arms as they are shown: as near to what block or wrap wants as joints, the body and the other arm let.

Least squares (Levenberg and Marquardt) over how far each arm departs from its wish, see
`behaviours.protect.arm_trouble`. What is forbidden is mild at first and hard only then: an arm goes round what is in
its way, on the nearer side, instead of being caught where it happens to be.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.protect.arm_trouble import (
    ALONG_LINE_M,
    ARM_ROWS,
    ARM_VARIABLES,
    OFF_LINE_M,
    ROWS,
    SWING,
    VARIABLES,
    arm_trouble,
    crossing,
    place_obstacles,
    put_arm,
)
from behaviours.protect.arm_wishes import beside_head, mix_arms, wish, wish_as_posed
from behaviours.protect.guard import stop_arm
from engine.body.skeleton import BACK, SHOULDERS, WRISTS
from engine.maths import quaternion, vector
from engine.maths.copying import copy_into
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.maths.least_squares import bounded_step, normal_equations

# an elbow may be on either side of a limit of its shoulder's: both are tried, and a first that is as good is kept
SWINGS_RAD, WORTH = (0.0, 0.8, -0.8), 0.98
# it may hang on the wrong side of something: from trouble like this on others are tried, left and right
ENOUGH_TROUBLE = 9.0
OTHER_SWINGS_RAD = (
    (0.8, 0.0), (0.0, 0.8), (-0.8, 0.0), (0.0, -0.8), (0.8, 0.8), (-0.8, -0.8), (1.6, 0.0), (0.0, 1.6), (-1.6, 0.0),
    (0.0, -1.6),
)  # fmt: skip

STEP = 1e-5  # of the differences
LONGEST_M, LONGEST_RAD = 0.05, 0.25  # that one step moves a palm, turns a hand or an elbow
MILD = 0.15  # share of the weight of what is forbidden, at first
ITERATIONS, TOLERANCE = 50, 1e-4
FIRST_DAMPING, LATER_DAMPING, LEAST_DAMPING, MOST_DAMPING = 1.0, 0.1, 1e-6, 1e6


@njit(cache=True)
def fit_arms(task, controls, posed):
    """Puts both arms of a pose whose trunk and raised shoulders are placed where they are shown, in place.

    Returns how much trouble that is, a sum of squares.
    """
    bones, share = task.bones, task.choices.wrap
    place_obstacles(bones.obstacle_joint, bones.obstacle_m, posed.positions, posed.orientations, posed.obstacles)
    wishes = np.empty((2, 10))  # palm, hand, the elbow's way
    if share <= 0.0 or share >= 1.0:
        wish(task, controls, task.rules, share, posed, wishes)
    else:
        # between block and wrap the arms are between both as poses, by way of hands beside the head: on straight ways
        # hands would turn over, elbows flip, and both go through the head
        turned, rules, beside = np.empty((2, 6, 4)), task.rules, beside_head(task.rules)
        near, far = (0.0, 0.5) if share < 0.5 else (0.5, 1.0)
        for end in range(2):
            at = near if end == 0 else far
            wish(task, controls, rules if at != 0.5 else beside, math.ceil(at), posed, wishes)
            _fit(task, wishes, at, len(SWINGS_RAD), posed)
            for side in range(2):
                for joint in range(3):  # shoulder, elbow, wrist
                    q = quaternion.at(posed.rotations, SHOULDERS[side] + joint)
                    quaternion.put(turned[end], 3 * side + joint, q)
        mix_arms(bones.offset_m, turned, 2.0 * (share - near), posed)
        wish_as_posed(task.build, posed, wishes)
        return _fit(task, wishes, share, 1, posed)
    return _fit(task, wishes, share, len(SWINGS_RAD), posed)


@inner_kernel
def _fit(task, wishes, share, swings, posed):
    """Both arms as near to what is wished (2, 10) as can be, in place; share: how much of that is a wrap; swings: how
    many of SWINGS_RAD are tried.
    """
    bones, build, start = task.bones, task.build, task.start
    along = (1.0 / ALONG_LINE_M - 1.0 / OFF_LINE_M) * (1.0 - share)
    line = quaternion.unrotate(quaternion.at(posed.orientations, BACK), task.threat.tangent)
    point, begin = np.zeros(VARIABLES), np.zeros(VARIABLES)
    residuals = np.empty(ROWS)
    trouble = _better_of_both(task, wishes, line, along, swings, point, posed, residuals)
    for other in range(len(OTHER_SWINGS_RAD)):
        if trouble < ENOUGH_TROUBLE:
            break
        begin[:] = 0.0
        begin[SWING], begin[ARM_VARIABLES + SWING] = OTHER_SWINGS_RAD[other]
        wrong = _least_trouble(task, wishes, line, along, begin, posed, residuals)
        if wrong < trouble:
            trouble = wrong
            copy_into(point, begin)
    for side in range(2):
        palm = put_arm(task, wishes, point, side, posed)
        stop_arm(
            side, bones.offset_m, start.low_rad, start.high_rad, posed.rotations, posed.positions, posed.orientations
        )
        palm = quaternion.rotate(quaternion.at(posed.orientations, WRISTS[side]), build.palm_m[side])
        vector.put(posed.palms, side, vector.add(vector.at(posed.positions, WRISTS[side]), palm))
    return trouble


@inner_kernel
def _better_of_both(task, wishes, line, along, swings, point, posed, residuals):
    """The best of descents from a few swings of both elbows, for either arm by itself, and on from there together:
    writes `point` (14,), returns its trouble.
    """
    tried, least = np.zeros(VARIABLES), (np.inf, np.inf)
    for n in range(swings):
        tried[:] = 0.0
        tried[SWING] = tried[ARM_VARIABLES + SWING] = SWINGS_RAD[n]
        _least_trouble(task, wishes, line, along, tried, posed, residuals)
        left, right = _sum_of_squares(residuals, 0), _sum_of_squares(residuals, ARM_ROWS)
        for side in range(2):
            wrong = left if side == 0 else right
            if wrong < WORTH * least[side]:
                least = (wrong, least[1]) if side == 0 else (least[0], wrong)
                for k in range(side * ARM_VARIABLES, (side + 1) * ARM_VARIABLES):
                    point[k] = tried[k]
    return _least_trouble(task, wishes, line, along, point, posed, residuals)


@inner_kernel
def _sum_of_squares(residuals, first):
    """Of the rows of one arm, from its first on."""
    total = 0.0
    for row in range(first, first + ARM_ROWS):
        total += residuals[row] * residuals[row]
    return total


@inner_kernel
def _least_trouble(task, wishes, line, along, point, posed, residuals):
    """Levenberg and Marquardt's descent from `point` (14,), in place; see least_squares. Writes what is left."""
    low, high = np.full(VARIABLES, -np.inf), np.full(VARIABLES, np.inf)
    trial_residuals, changed = np.empty(ROWS), np.empty(ROWS)
    jacobian, matrix = np.zeros((ROWS, VARIABLES)), np.empty((VARIABLES, VARIABLES))
    slope, step, trial = np.empty(VARIABLES), np.empty(VARIABLES), np.empty(VARIABLES)
    segments = np.empty((2, 12))
    hard = MILD
    value = _trouble_of(task, wishes, line, along, hard, point, posed, segments, residuals)
    damping = FIRST_DAMPING
    for done in range(ITERATIONS):
        _slopes(task, wishes, line, along, hard, point, posed, segments, residuals, trial, changed, jacobian)
        normal_equations(jacobian, residuals, matrix, slope)
        while True:
            bounded_step(matrix, slope, point, low, high, damping, step)
            times = _too_long(step)
            for k in range(VARIABLES):
                trial[k] = point[k] + step[k] / times
            trial_value = _trouble_of(task, wishes, line, along, hard, trial, posed, segments, trial_residuals)
            if trial_value < value or damping >= MOST_DAMPING:
                break
            damping *= 8.0
        decrease = value - trial_value
        if decrease > 0.0:
            copy_into(point, trial)
            copy_into(residuals, trial_residuals)
            value = trial_value
            damping = max(0.2 * damping, LEAST_DAMPING)
        if decrease <= TOLERANCE * value or (hard < 1.0 and 2 * done >= ITERATIONS):
            if hard == 1.0:
                break
            hard, damping = 1.0, LATER_DAMPING
            value = _trouble_of(task, wishes, line, along, hard, point, posed, segments, residuals)
    return value


@inner_kernel
def _too_long(step):
    """How many times longer than it may be a step (14,) is, at least 1."""
    times = 1.0
    for k in range(VARIABLES):
        times = max(times, abs(step[k]) / (LONGEST_M if k % ARM_VARIABLES < SWING else LONGEST_RAD))
    return times


@inner_kernel
def _trouble_of(task, wishes, line, along, hard, point, posed, segments, residuals):
    """Poses both arms, writes all residuals (ROWS,), and returns the sum of their squares."""
    for side in range(2):
        arm_trouble(task, wishes, line, along, hard, point, side, posed, segments, residuals)
    crossing(task.build, hard, segments, residuals)
    total = 0.0
    for row in range(ROWS):
        total += residuals[row] * residuals[row]
    return total


@inner_kernel
def _slopes(task, wishes, line, along, hard, point, posed, segments, residuals, trial, changed, jacobian):
    """Forward differences of the residuals (ROWS, 14); a number of one arm moves that arm only."""
    copy_into(trial, point)
    for side in range(2):
        other = 1 - side
        arm_trouble(task, wishes, line, along, hard, point, other, posed, segments, changed)
        for k in range(ARM_VARIABLES):
            column = side * ARM_VARIABLES + k
            trial[column] = point[column] + STEP
            arm_trouble(task, wishes, line, along, hard, trial, side, posed, segments, changed)
            crossing(task.build, hard, segments, changed)
            trial[column] = point[column]
            for row in range(side * ARM_ROWS, (side + 1) * ARM_ROWS):
                jacobian[row, column] = (changed[row] - residuals[row]) / STEP
            for row in range(2 * ARM_ROWS, ROWS):
                jacobian[row, column] = (changed[row] - residuals[row]) / STEP
