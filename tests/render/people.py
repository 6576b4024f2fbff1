"""Poses for pictures: standing, walking, protecting; made of a few joint turns, standing on the floor."""

from __future__ import annotations

import math

import numpy as np

from engine.body.anthropometry import standard_body
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, JOINT_COUNT, Body, Pose, joint_index
from engine.maths import quaternion
from engine.render.scene import PERSON, Figure

_ABOUT = {"x": quaternion.about_x, "y": quaternion.about_y, "z": quaternion.about_z}

STAND = {
    "left_shoulder": "x8",
    "right_shoulder": "x-8",
    "left_elbow": "y-12",
    "right_elbow": "y-12",
    "left_hip": "x3",
    "right_hip": "x-3",
    "left_ankle": "x-3",
    "right_ankle": "x3",
}
WALK = {
    "waist": "y4",
    "back": "z8",
    "left_shoulder": "x7 y25",
    "right_shoulder": "x-7 y-25",
    "left_elbow": "y-20",
    "right_elbow": "y-35",
    "left_hip": "y-28",
    "left_knee": "y8",
    "right_hip": "y18",
    "right_knee": "y25",
    "right_ankle": "y10",
    "right_toe": "y-25",
}
PROTECT = {
    "waist": "y18",
    "back": "y12 z-15",
    "neck": "y10 z-20",
    "head": "z-15 y8",
    "left_clavicle": "x12",
    "right_clavicle": "x-12",
    "left_shoulder": "y-65 x10 z-30",
    "right_shoulder": "y-80 x-5 z25",
    "left_elbow": "y-105",
    "right_elbow": "y-100",
    "left_hip": "y-24 x6",
    "right_hip": "y-16 x-10",
    "left_knee": "y42",
    "right_knee": "y36",
    "left_ankle": "y-18 x-6",
    "right_ankle": "y-20 x10",
}

BEHIND_HEAD = {
    "left_clavicle": "x20",
    "right_clavicle": "x-20",
    "left_shoulder": "x150 z30",
    "right_shoulder": "x-150 z-30",
    "left_elbow": "y-135",
    "right_elbow": "y-135",
    "head": "y15",
}
SQUAT = {
    "waist": "y20",
    "left_hip": "y-110 x15",
    "right_hip": "y-110 x-15",
    "left_knee": "y130",
    "right_knee": "y130",
    "left_ankle": "y-30",
    "right_ankle": "y-30",
    "left_shoulder": "y-80",
    "right_shoulder": "y-80",
}


def pose_of(body: Body, turns: dict[str, str]) -> Pose:
    """Joint turns in degrees, each in the frame that the one before it left; the lowest sole point on the floor."""
    rotations = np.tile(quaternion.IDENTITY, (JOINT_COUNT, 1))
    for name, steps in turns.items():
        q = quaternion.IDENTITY
        for step in steps.split():
            q = quaternion.multiply(q, _ABOUT[step[0]](math.radians(float(step[1:]))))
        rotations[joint_index(name)] = q
    positions, orientations = joints_of(body, Pose(np.zeros(3), rotations))
    soles = [
        positions[ankle][2] + quaternion.rotate(orientations[ankle], point)[2]
        for side, ankle in enumerate(ANKLES)
        for point in body.sole_m[side, :4]
    ]
    return Pose(np.array([0.0, 0.0, -min(soles)]), rotations)


def person(
    turns=STAND, colour=PERSON, alpha: float = 1.0, at=(0.0, 0.0), body: Body | None = None, style: str = "smooth"
) -> Figure:
    """A figure in one of the poses above, at a place on the floor."""
    body = body or standard_body()
    positions, orientations = joints_of(body, pose_of(body, turns))
    return Figure(body, positions + (*at, 0.0), orientations, colour, alpha, style)
