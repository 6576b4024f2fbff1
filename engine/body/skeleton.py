"""The one canonical skeleton: 21 joints that carry the thesis's hierarchy (fig. 3.1), the stance paper's degrees of
freedom, the mass model and the MuJoCo body. Every clip is mapped on it with its subject's own bone lengths.

Identity pose: standing upright, facing +X, left hand on the +Y side, legs straight, arms hanging, palms towards the
thighs, feet forward; every joint frame is then parallel to the world. Bones of limbs and fingers run along -Z of
their joint, the spine along +Z, the toe along +X. So, at any joint: elbows flex by *negative* Y, knees by positive Y,
the trunk bows forward by positive Y, the left arm lifts sideways by positive X, the right one by negative X.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

JOINTS = (
    "pelvis", "waist", "back", "neck", "head",
    "left_clavicle", "left_shoulder", "left_elbow", "left_wrist",
    "right_clavicle", "right_shoulder", "right_elbow", "right_wrist",
    "left_hip", "left_knee", "left_ankle", "left_toe",
    "right_hip", "right_knee", "right_ankle", "right_toe",
)  # fmt: skip
JOINT_COUNT = len(JOINTS)
PELVIS, WAIST, BACK, NECK, HEAD = range(5)
LEFT_CLAVICLE, LEFT_SHOULDER, LEFT_ELBOW, LEFT_WRIST = range(5, 9)
RIGHT_CLAVICLE, RIGHT_SHOULDER, RIGHT_ELBOW, RIGHT_WRIST = range(9, 13)
LEFT_HIP, LEFT_KNEE, LEFT_ANKLE, LEFT_TOE = range(13, 17)
RIGHT_HIP, RIGHT_KNEE, RIGHT_ANKLE, RIGHT_TOE = range(17, 21)

# side 0 is left, side 1 is right, here and in every array with an axis of two sides
LEFT, RIGHT = 0, 1
CLAVICLES, SHOULDERS, ELBOWS, WRISTS = (5, 9), (6, 10), (7, 11), (8, 12)
HIPS, KNEES, ANKLES, TOES = (13, 17), (14, 18), (15, 19), (16, 20)

PARENT = np.array([-1, 0, 1, 2, 3, 2, 5, 6, 7, 2, 9, 10, 11, 0, 13, 14, 15, 0, 17, 18, 19])
MIRRORED = np.array([0, 1, 2, 3, 4, 9, 10, 11, 12, 5, 6, 7, 8, 17, 18, 19, 20, 13, 14, 15, 16])

# the sole's contact points of one foot, in this order
SOLE_POINTS = ("heel_inner", "heel_outer", "ball_inner", "ball_outer", "toe_inner", "toe_outer")


class Body(NamedTuple):
    """One subject: bone lengths, extents, masses and limits. Arrays only, so that kernels take it whole.

    All lengths in metres, each in the frame of the joint named, identity pose; J = 21 joints, P = body parts.
    """

    offset_m: np.ndarray  # (J, 3) each joint in its parent's frame; row 0 is zero
    head_top_m: np.ndarray  # (3,) crown of the head, in the head's frame
    palm_m: np.ndarray  # (2, 3) palm centre, in the wrist's frame
    fingertip_m: np.ndarray  # (2, 3) in the wrist's frame
    sole_m: np.ndarray  # (2, 6, 3) SOLE_POINTS; heel and ball in the ankle's frame, toe in the toe's
    part_joint: np.ndarray  # (P,) the joint that carries each body part
    part_mass_kg: np.ndarray  # (P,)
    part_com_m: np.ndarray  # (P, 3) in the carrying joint's frame
    part_inertia_kgm2: np.ndarray  # (P, 3, 3) about the part's own COM
    limit_low_rad: np.ndarray  # (J, 3) swing X, swing Y, twist Z; see engine.body.limits
    limit_high_rad: np.ndarray  # (J, 3)


class Pose(NamedTuple):
    """Where a character is. A leading axis of frames or characters is allowed on both."""

    root_m: np.ndarray  # (3,) pelvis in the world
    rotations: np.ndarray  # (J, 4) w x y z, local to parent; the pelvis's is in the world


def joint_index(name: str) -> int:
    """The row of a joint by its name. ValueError names what is allowed."""
    if name not in JOINTS:
        raise ValueError(f"unknown joint {name!r}; the joints are {', '.join(JOINTS)}")
    return JOINTS.index(name)
