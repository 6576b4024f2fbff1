"""The total error that the sustained pose minimises (Hermens 2006, eq. 3.2 and 3.3), in three forms.

Ten variables: the pelvis's shift (3, metres) and the seven controls. Every term but the first is the distance from
the pose that the rules alone gave. All three forms are made from one vector of residuals, grouped by term.

squares (the default): sum of w^2 d^2. It is smooth, and a least-squares problem. literal: the thesis's plain sum of
norms; it starts on the kink of every term at once, and BFGS makes no step from there. smoothed: the same with each
norm's tip rounded.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.protect.apply_rules import update_pose
from behaviours.rules.controls import CONTROL_COUNT
from engine.body.kinematics import centre_of_mass
from engine.body.skeleton import ANKLES, PELVIS
from engine.maths import quaternion
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

TERMS = ("balance", "hands", "torso", "pelvis_height", "feet", "controls", "limits", "outside")
VARIABLES = 3 + CONTROL_COUNT
FORMS = ("squares", "literal", "smoothed")
SQUARES, LITERAL, SMOOTHED = range(len(FORMS))

# where each term's residuals begin; the norms of the literal form are taken over runs of two or three of them
BALANCE, HANDS, TORSO, HEIGHT, FEET, CONTROLS, LIMITS, OUTSIDE, RESIDUALS = 0, 2, 8, 17, 18, 24, 31, 33, 40
BEGIN = (BALANCE, HANDS, TORSO, HEIGHT, FEET, CONTROLS, LIMITS, OUTSIDE, RESIDUALS)


class Reference(NamedTuple):
    """What the rules alone gave, and what is wanted of the COM."""

    com_rules_m: tuple[float, float]  # COM_cur
    com_wanted_m: tuple[float, float]  # COM_des, frozen
    palms: np.ndarray  # (2, 3)
    trunk: np.ndarray  # (3, 4) world orientations of pelvis, waist, back
    pelvis_z: float
    controls: np.ndarray  # (7,)
    weights: tuple[float, ...]  # one a term
    smoothing_m: float
    soft_m: float  # over which a leg's reach ends


@njit(cache=True, forceinline=True)
def residuals_into(task, reference, variables, controls, posed, residuals):
    """Writes the unweighted residuals (40,), and the pose that the variables give. controls (7,) is scratch.

    A control outside [0, 1] acts as if it stood on the bound; how far it is outside is a residual of its own.
    `posed` may have been used before, but for the same task only: see apply_rules.update_pose.
    """
    for i in range(CONTROL_COUNT):
        controls[i] = min(1.0, max(0.0, variables[3 + i]))
    update_pose(task, variables, controls, reference.soft_m, posed)
    measure_into(task, reference, variables, controls, posed, residuals)


@njit(cache=True, forceinline=True)
def measure_into(task, reference, variables, controls, posed, residuals):
    """Writes the residuals (40,) of a pose that is there, and of the variables and clamped controls that it has."""
    for i in range(CONTROL_COUNT):
        residuals[CONTROLS + i] = controls[i] - reference.controls[i]
        residuals[OUTSIDE + i] = variables[3 + i] - controls[i]
    com = centre_of_mass(task.bones, posed.positions, posed.orientations)
    residuals[BALANCE] = com[0] - reference.com_wanted_m[0]
    residuals[BALANCE + 1] = com[1] - reference.com_wanted_m[1]
    for side in range(2):
        for k in range(3):
            residuals[HANDS + 3 * side + k] = posed.palms[side, k] - reference.palms[side, k]
            missed = posed.positions[ANKLES[side], k] - task.feet.ankle_m[side, k]
            residuals[FEET + 3 * side + k] = missed if task.feet.held[side] else 0.0
    for joint in range(3):
        # sin(angle / 2): the vector part of the turn between the two orientations
        was = quaternion.at(reference.trunk, joint)
        turn = quaternion.multiply(quaternion.conjugate(was), quaternion.at(posed.orientations, joint))
        for k in range(3):
            residuals[TORSO + 3 * joint + k] = turn[1 + k]
    residuals[HEIGHT] = posed.positions[PELVIS, 2] - reference.pelvis_z
    for side in range(2):
        residuals[LIMITS + side] = posed.trouble[side]


@inner_kernel
def _norm(residuals, first, count):
    total = 0.0
    for i in range(first, first + count):
        total += residuals[i] * residuals[i]
    return math.sqrt(total)


@inner_kernel
def _sum_of_norms(residuals, smoothing_m):
    """Eq. 3.3: every distance counted once, each norm's tip rounded over `smoothing_m` (0: not)."""
    total = 0.0
    s = smoothing_m
    total += math.sqrt(_norm(residuals, BALANCE, 2) ** 2 + s * s) - s
    for first in (HANDS, HANDS + 3, TORSO, TORSO + 3, TORSO + 6, FEET, FEET + 3):
        total += math.sqrt(_norm(residuals, first, 3) ** 2 + s * s) - s
    total += math.sqrt(residuals[HEIGHT] ** 2 + s * s) - s
    total += residuals[LIMITS] + residuals[LIMITS + 1]
    for i in range(CONTROL_COUNT):
        total += residuals[OUTSIDE + i] ** 2
    return total


@njit(cache=True)
def total_error(residuals, reference, form):
    """The number that is minimised, from the residuals; form: SQUARES, LITERAL or SMOOTHED."""
    if form == LITERAL:
        return _sum_of_norms(residuals, 0.0)
    if form == SMOOTHED:
        return _sum_of_norms(residuals, reference.smoothing_m)
    total = 0.0
    for term in range(len(TERMS)):
        weight = reference.weights[term]
        for i in range(BEGIN[term], BEGIN[term + 1]):
            total += (weight * residuals[i]) ** 2
    return total


def term_errors(residuals: np.ndarray) -> dict[str, float]:
    """Each term as a plain distance: metres; for the torso the root sum of squares of sin(angle / 2); for
    controls 0 ... 1.
    """
    return {term: float(np.sqrt(np.sum(residuals[BEGIN[i] : BEGIN[i + 1]] ** 2))) for i, term in enumerate(TERMS)}
