"""How a body falls that has lost its balance: knees and hips give, arms go to the side it falls to, the head away.

Unexpected falls look alike: the hands come to the ground with the hips, the head is kept off it (Hsiao and Robinovitch
1998, Common protective movements govern unexpected falls from standing height, J. Biomechanics 31). That is a target
for the servos, made once when the fall begins: how it comes about, and where everything lands, is physics.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.components import Phase, Reaction, Sustained
from behaviours.playing import body_of
from behaviours.settle.seams import shown
from behaviours.timing import TICK_S
from engine.body import footing
from engine.body.kinematics import com_of, joints_of
from engine.body.limits import clamp_keeping, clamp_rotation, from_components
from engine.body.skeleton import ANKLES, ELBOWS, HIPS, JOINT_COUNT, JOINTS, KNEES, MIRRORED, PELVIS, WRISTS, Pose
from engine.maths import quaternion

# degrees of swing X, swing Y, twist Z at each joint (engine.body.limits), left side given: falling forwards, backwards,
# to the left and to the right
_FORWARDS = {
    "waist": (0, 5, 0), "back": (0, 5, 0), "neck": (0, -22, 0), "head": (0, -12, 0),
    "left_shoulder": (14, -95, 0), "left_elbow": (0, -42, 0), "left_wrist": (35, 0, 0),
    "left_hip": (6, -24, 0), "left_knee": (0, 44, 0), "left_ankle": (0, 5, 0),
}  # fmt: skip
_BACKWARDS = {
    "waist": (0, 22, 0), "back": (0, 28, 0), "neck": (0, 24, 0), "head": (0, 14, 0),
    "left_shoulder": (38, 22, 0), "left_elbow": (0, -38, 0), "left_wrist": (30, 0, 0),
    "left_hip": (10, -48, 0), "left_knee": (0, 48, 0), "left_ankle": (0, -5, 0),
}  # fmt: skip
_LEFTWARDS = {
    "waist": (8, 12, 0), "back": (10, 14, 0), "neck": (16, 8, 0), "head": (8, 5, 0),
    "left_shoulder": (62, -42, 0), "left_elbow": (0, -48, 0), "left_wrist": (25, 0, 0),
    "left_hip": (4, -38, 0), "left_knee": (0, 58, 0), "left_ankle": (0, 0, 0),
    "right_shoulder": (-24, -66, 0), "right_elbow": (0, -58, 0), "right_wrist": (0, 0, 0),
    "right_hip": (-8, -24, 0), "right_knee": (0, 40, 0), "right_ankle": (0, 0, 0),
}  # fmt: skip


def _both_sides(given):
    """(J, 3) radians, the right side the mirror image of the left unless it is given too; (0, 0, 0) elsewhere."""
    out = np.zeros((JOINT_COUNT, 3))
    for j, name in enumerate(JOINTS):
        if name in given:
            out[j] = np.radians(given[name])
        elif JOINTS[MIRRORED[j]] in given:
            out[j] = np.radians(given[JOINTS[MIRRORED[j]]]) * [-1, 1, -1]
    return out


def _mirrored(components):
    """The same towards the other side."""
    return components[list(MIRRORED)] * [-1, 1, -1]


FORWARDS, BACKWARDS, LEFTWARDS = (_both_sides(given) for given in (_FORWARDS, _BACKWARDS, _LEFTWARDS))
RIGHTWARDS = _mirrored(LEFTWARDS)
RESTING = _both_sides({
    "left_hip": (5, -6, 0), "left_knee": (0, 5, 0), "left_ankle": (0, 50, 0),
    "left_elbow": (0, -15, 0), "left_wrist": (0, 0, 0),
})  # fmt: skip
LIMP = (*HIPS, *KNEES, *ANKLES, *ELBOWS, *WRISTS)  # a forearm that stood on its elbow would stand there for ever
LIES_BELOW = 0.3  # of the leg's length, the hips


def begin_falling(world, row: int) -> None:
    """From now on the servos pull towards a fall to the side that the body goes to; part of its pose stays."""
    s, share = world[Sustained], world.assets.settings.response.fall_share
    now, before = shown(world, row)
    body = body_of(world, row)
    way_mps = (com_of(body, now) - com_of(body, before)) / TICK_S
    asked = falling_rotations(body, side_rad(now, way_mps))
    s.root_m[row] = now.root_m
    for j in range(1, JOINT_COUNT):
        # a limb's turn on the way between two of its rotations may lie outside both its limits
        between = quaternion.slerp(now.rotations[j], asked[j], share)
        s.rotations[row, j] = clamp_keeping(body.limit_low_rad[j], body.limit_high_rad[j], now.rotations[j], between)


def side_rad(pose: Pose, way) -> float:
    """To which side of itself a body goes: 0 ahead, positive to the left. way (3,), world."""
    return math.atan2(way[1], way[0]) - quaternion.heading(pose.rotations[PELVIS])


def falling_rotations(body, side: float) -> np.ndarray:
    """(J, 4) the pose of a fall to a side, radians, 0 ahead, positive to the left; within the joints' limits."""
    ahead, aside = math.cos(side), math.sin(side)
    weights = (max(ahead, 0.0) ** 2, max(-ahead, 0.0) ** 2, max(aside, 0.0) ** 2, max(-aside, 0.0) ** 2)
    poses = (FORWARDS, BACKWARDS, LEFTWARDS, RIGHTWARDS)
    turns = sum(w * p for w, p in zip(weights, poses, strict=True))
    out = np.array([from_components(*turn) for turn in turns])
    for j in range(1, JOINT_COUNT):
        out[j] = clamp_rotation(body.limit_low_rad[j], body.limit_high_rad[j], out[j])
    return out


def held_pose(world, row: int, pose: Pose) -> tuple[Pose, float]:
    """What the servos of a simulated body in this pose pull towards, and with which share of its strength.

    On its feet the sustained pose, with all of it. In a fall that of the fall, with less; once it lies, with little,
    and legs and forearms stretch out on the ground.
    """
    s, response, body = world[Sustained], world.assets.settings.response, body_of(world, row)
    target = Pose(s.root_m[row].copy(), s.rotations[row].copy())
    if world[Reaction].phase[row] != Phase.DOWN:
        return target, 1.0
    height = joints_of(body, pose)[0][PELVIS, 2] / footing.leg_length_m(body, 0)
    up = min(max((height - LIES_BELOW) / LIES_BELOW, 0.0), 1.0)
    for j in LIMP:
        target.rotations[j] = quaternion.slerp(from_components(*RESTING[j]), target.rotations[j], up)
    return target, response.down_share + up * (response.falling_share - response.down_share)
