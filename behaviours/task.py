"""What one protective pose is made from: the body at perception, its feet, the threat, and what was chosen once.

Everything here is fixed while the pose is optimised. Kernels take it whole.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from behaviours.perceived import PerceivedThreat, head_centre_m, head_radius_m
from behaviours.settings import Block, LeanTurn, Pelvis, Recoil, Wrap
from engine.body.skeleton import ELBOWS, JOINT_COUNT, KNEES, WRISTS, ANKLES, Body

Triple = tuple[float, float, float]


class Bones(NamedTuple):
    """What kernels need of a Body. No more: a whole body costs more to hand on than a limb to solve."""

    offset_m: np.ndarray  # (J, 3)
    part_joint: np.ndarray  # (P,)
    part_mass_kg: np.ndarray  # (P,)
    part_com_m: np.ndarray  # (P, 3)
    palm_m: tuple[Triple, Triple]  # in the wrists' frames
    arm_m: tuple[float, float]  # shoulder to wrist, stretched
    leg_m: tuple[float, float]  # hip to ankle, stretched
    elbow_rad: tuple[float, float]  # the most they flex
    knee_rad: tuple[float, float]
    head_centre_m: Triple  # in the head's frame
    head_radius_m: float


class Start(NamedTuple):
    """The pose that the rules begin with, and how far each joint may go from there."""

    root_m: np.ndarray  # (3,) world
    rotations: np.ndarray  # (J, 4)
    orientations: np.ndarray  # (J, 4) world
    heading_rad: float  # yaw of the root at perception: the frame that threats are described in
    low_rad: np.ndarray  # (J, 3) limits, moved out to where the clip itself oversteps them
    high_rad: np.ndarray  # (J, 3)


class FeetPlan(NamedTuple):
    """Where both feet stand in the protective pose. Axis 0 is left, right."""

    ankle_m: np.ndarray  # (2, 3) world
    turned: np.ndarray  # (2, 4) ankle orientations, world
    toe: np.ndarray  # (2, 4) toe rotations, local
    held: np.ndarray  # (2,) bool: stands here; False: the leg goes with the pose
    step_m: np.ndarray  # (2,) how far the ankle goes from where it is at perception


class Choices(NamedTuple):
    """Everything discrete, chosen once from the rules pose and frozen for the optimisation and the reaction."""

    turn_side: float  # +1 turns left, -1 right
    turn_rad: float  # yaw that would bring the back of the head to the threat, going round by that side
    across: Triple  # unit horizontal across the line of approach, to the left hand's side
    fingers: Triple  # unit, at right angles to the line: where fingers point that block
    wrap: float  # 0 blocks in front, 1 wraps the arms around the head


class Rules(NamedTuple):
    """The settings that the rules use."""

    lean_turn: LeanTurn
    recoil: Recoil
    block: Block
    wrap: Wrap
    pelvis: Pelvis


class Task(NamedTuple):
    """All of it."""

    bones: Bones
    start: Start
    feet: FeetPlan
    threat: PerceivedThreat
    choices: Choices
    rules: Rules


class Posed(NamedTuple):
    """A pose being worked on: kernels write here, nothing is allocated on the way."""

    rotations: np.ndarray  # (J, 4) local
    positions: np.ndarray  # (J, 3) world
    orientations: np.ndarray  # (J, 4) world
    palms: np.ndarray  # (2, 3) world
    foot_miss_m: np.ndarray  # (2,) how far each held foot is from where it should stand


def bones_of(body: Body) -> Bones:
    """What kernels need of a body."""
    palms = [tuple(float(v) for v in palm) for palm in body.palm_m]
    lengths_m = np.sqrt(np.sum(body.offset_m**2, axis=1))
    arm, leg = (lengths_m[list(a)] + lengths_m[list(b)] for a, b in ((ELBOWS, WRISTS), (KNEES, ANKLES)))
    return Bones(
        body.offset_m,
        body.part_joint,
        body.part_mass_kg,
        body.part_com_m,
        (palms[0], palms[1]),
        (float(arm[0]), float(arm[1])),
        (float(leg[0]), float(leg[1])),
        (float(-body.limit_low_rad[ELBOWS[0], 1]), float(-body.limit_low_rad[ELBOWS[1], 1])),
        (float(body.limit_high_rad[KNEES[0], 1]), float(body.limit_high_rad[KNEES[1], 1])),
        head_centre_m(body),
        head_radius_m(body),
    )


@njit(cache=True)
def new_posed():
    return Posed(
        np.empty((JOINT_COUNT, 4)), np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4)), np.zeros((2, 3)), np.zeros(2)
    )
