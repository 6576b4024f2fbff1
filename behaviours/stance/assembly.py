"""One whole pose from its parameters, in the paper's order (5): lower body and balance, torso, arms, head.

Nothing is searched here. `balance` finds the ankle offsets and `solver` the amplitudes, both by assembling again and
again.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.stance import arms, gaze, lower_body, torso
from behaviours.stance.lower_body import LowerBody
from engine.body import kinematics
from engine.body.skeleton import BACK, CLAVICLES, JOINT_COUNT, PELVIS, WAIST
from engine.maths import quaternion
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


class Plan(NamedTuple):
    """All that decides a pose besides the solver's unknowns and the balance offsets. World frame."""

    lower: LowerBody
    classes: np.ndarray  # (2,) sagittal and coronal shape class, rows of torso.WEIGHTS
    opposed: np.ndarray  # (2,) collars opposed about Y, about Z
    arm: np.ndarray  # (2, 6) parameters of each arm, see arms
    reaching: np.ndarray  # (2,) whether the wrist has a target
    wrist_m: np.ndarray  # (2, 3) the targets
    look_at_m: np.ndarray  # (3,)
    gaze: float  # weight
    balance_m: np.ndarray  # (2,) where the centre of mass is to project


class Figure(NamedTuple):
    """The pose being worked out."""

    root_m: np.ndarray  # (3,)
    rotations: np.ndarray  # (J, 4)
    positions: np.ndarray  # (J, 3) world
    orientations: np.ndarray  # (J, 4) world


def new_figure() -> Figure:
    rotations = np.zeros((JOINT_COUNT, 4))
    rotations[:, 0] = 1.0
    return Figure(np.zeros(3), rotations, np.zeros((JOINT_COUNT, 3)), rotations.copy())


@njit(cache=True)
def assemble(body, plan, unknowns, balance_rad, figure):
    """Fills the figure; returns the world place (x, y) over which its centre of mass is.

    unknowns (6,): see torso.UNKNOWNS; balance_rad (x, z): offsets of the root ankle.
    """
    lower_body.solve_lower_body(body, plan.lower, balance_rad, figure.root_m, figure.rotations)
    torso.shape_torso(body, plan.classes, plan.opposed, unknowns, figure.rotations)
    _begin_arms(body, plan, figure.rotations)
    kinematics.joints_into(body.offset_m, figure.root_m, figure.rotations, figure.positions, figure.orientations)
    for side in range(2):
        if plan.reaching[side]:
            arms.reach(
                body, figure.rotations, figure.positions, figure.orientations, side,
                plan.wrist_m[side], plan.arm[side, arms.SWIVEL] + arms.NEUTRAL_SWIVEL,
            )  # fmt: skip
    if plan.gaze > 0.0:
        gaze.look(body, figure.rotations, figure.positions, figure.orientations, plan.look_at_m, plan.gaze)
    com = kinematics.centre_of_mass(body, figure.positions, figure.orientations)
    return (com[0], com[1])


@inner_kernel
def _begin_arms(body, plan, rotations):
    chest = quaternion.multiply(
        quaternion.multiply(quaternion.at(rotations, PELVIS), rotations[WAIST]), rotations[BACK]
    )
    for side in range(2):
        if plan.reaching[side]:
            arms.ready_arm(side, rotations)
        else:
            clavicle = quaternion.multiply(chest, rotations[CLAVICLES[side]])
            arms.hang_arm(body, plan.arm[side], side, rotations, chest, clavicle)
