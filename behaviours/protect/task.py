"""What one protective pose is made from: the body at perception, its feet, the threat, and what was chosen once.

Everything here is fixed while the pose is optimised. Kernels take it whole.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.perceive.perceived import PerceivedThreat, head_centre_m
from behaviours.settings import Block, LeanTurn, Pelvis, Recoil, Wrap
from engine.body.capsules import CAPSULES, body_capsules
from engine.body.overlap import TRUNK
from engine.body.skeleton import ANKLES, ELBOWS, JOINT_COUNT, KNEES, WRISTS, Body, Pose
from engine.maths.kernel import njit

Triple = tuple[float, float, float]
OBSTACLES = TRUNK


class AtPerception(NamedTuple):
    """How a character is when it perceives a threat. World poses."""

    now: Pose
    ahead: Pose  # the clip 1/6 s later, which the pelvis and a foot in the air are taken from; or its next landing
    planted: np.ndarray  # (2,) bool: the feet that stand now; where `ahead` is a landing, those that stand there
    landing: bool = False  # whether it is: the feet are held where that pose has them
    turn_side: float = 0.0  # the side last turned to, kept when a threat comes from dead ahead


class Bones(NamedTuple):
    """The arrays that kernels need of a Body."""

    offset_m: np.ndarray  # (J, 3)
    part_joint: np.ndarray  # (P,)
    part_mass_kg: np.ndarray  # (P,)
    part_com_m: np.ndarray  # (P, 3)
    obstacle_joint: np.ndarray  # (C,) what arms must clear: the capsules of OBSTACLES
    obstacle_m: np.ndarray  # (C, 2, 3) their ends in those joints' frames


class Build(NamedTuple):
    """The numbers that kernels need of a Body; pairs are left, right."""

    palm_m: tuple[Triple, Triple]  # in the wrists' frames
    arm_m: tuple[float, float]  # shoulder to wrist, stretched
    leg_m: tuple[float, float]  # hip to ankle, stretched
    elbow_rad: tuple[float, float]  # the most they flex
    knee_rad: tuple[float, float]
    head_centre_m: Triple  # in the head's frame
    head_radius_m: float
    hand_radius_m: float
    arm_radius_m: tuple[float, float]  # of the forearms
    hand_start_m: tuple[Triple, Triple]  # both ends of the hands' capsules, in the wrists' frames
    hand_end_m: tuple[Triple, Triple]
    obstacle_radius_m: tuple[float, ...]  # of OBSTACLES


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
    limit_margin_rad: float  # limbs keep this far inside their limits


class Task(NamedTuple):
    """All of it."""

    bones: Bones
    build: Build
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
    trouble: np.ndarray  # (2,) what limits still forbid each leg, radians
    obstacles: np.ndarray  # (C, 6) both ends of what arms must clear, in the world
    made_from: np.ndarray  # (3, 6) what trunk and legs, left and right arm were last made from; see apply_rules


def triple(row) -> Triple:
    """A row of three numbers as a tuple, for kernels."""
    return (float(row[0]), float(row[1]), float(row[2]))


def bones_of(body: Body) -> tuple[Bones, Build]:
    """What kernels need of a body."""
    capsules, row = body_capsules(body), CAPSULES.index
    obstacles = [row(name) for name in OBSTACLES]
    lengths_m = np.sqrt(np.sum(body.offset_m**2, axis=1))
    bones = Bones(
        body.offset_m,
        body.part_joint,
        body.part_mass_kg,
        body.part_com_m,
        capsules.joint[obstacles],
        np.stack([capsules.start_m[obstacles], capsules.end_m[obstacles]], axis=1),
    )
    build = Build(
        (triple(body.palm_m[0]), triple(body.palm_m[1])),
        tuple((lengths_m[list(ELBOWS)] + lengths_m[list(WRISTS)]).tolist()),
        tuple((lengths_m[list(KNEES)] + lengths_m[list(ANKLES)]).tolist()),
        tuple((-body.limit_low_rad[list(ELBOWS), 1]).tolist()),
        tuple(body.limit_high_rad[list(KNEES), 1].tolist()),
        head_centre_m(body),
        float(capsules.radius_m[row("head")]),
        float(capsules.radius_m[row("left_hand")]),
        tuple(capsules.radius_m[[row("left_forearm"), row("right_forearm")]].tolist()),
        (triple(capsules.start_m[row("left_hand")]), triple(capsules.start_m[row("right_hand")])),
        (triple(capsules.end_m[row("left_hand")]), triple(capsules.end_m[row("right_hand")])),
        tuple(capsules.radius_m[obstacles].tolist()),
    )
    return bones, build


@njit(cache=True)
def new_posed():
    return Posed(
        np.empty((JOINT_COUNT, 4)),
        np.empty((JOINT_COUNT, 3)),
        np.empty((JOINT_COUNT, 4)),
        np.zeros((2, 3)),
        np.zeros(2),
        np.zeros(2),
        np.zeros((len(OBSTACLES), 6)),
        np.full((3, 6), np.nan),
    )
