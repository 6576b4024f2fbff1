"""Frames at a clip's start that are no motion: a T-pose put in front by a converter, and the smear out of it."""

from __future__ import annotations

import numpy as np

from engine.body.skeleton import ELBOWS, KNEES, SHOULDERS
from engine.clips.rest_pose import DOWN
from engine.maths import rotations

# no joint of a person turns so fast out of standing still with the arms held out
SMEAR_RAD_PER_S = np.radians(1500.0)
SEARCHED_S = 0.25


def rest_frames(local: np.ndarray, orientations: np.ndarray, file_rotations: np.ndarray, fps: float) -> int:
    """How many frames to drop. local, orientations: (F, 21, 4) on the canonical skeleton; file_rotations (F, J, 4) as
    in the file.

    Only a clip whose first frame is a rest pose (arms straight out to the sides on straight legs, or every joint of the
    file at zero) loses any, and only up to the last jump that leads away from it."""
    if len(local) < 2 or not (_is_t_pose(local[0], orientations[0]) or _is_zero(file_rotations[0])):
        return 0
    searched = min(len(local) - 1, max(2, round(SEARCHED_S * fps)))
    turns = rotations.angle_between(local[:searched], local[1 : searched + 1]).max(axis=-1) * fps
    jumps = turns > SMEAR_RAD_PER_S
    return int(searched if jumps.all() else np.argmin(jumps))


def _is_t_pose(local: np.ndarray, orientations: np.ndarray) -> bool:
    upper_arms = rotations.rotate(orientations[list(SHOULDERS)], DOWN)
    bends = rotations.rotate(local[[*ELBOWS, *KNEES]], DOWN)
    level = np.abs(upper_arms[:, 2]) < np.sin(np.radians(25.0))
    straight = -bends[:, 2] > np.cos(np.radians(25.0))
    return bool(level.all() and straight.all())


def _is_zero(file_rotations: np.ndarray) -> bool:
    return bool((np.abs(file_rotations[1:, 0]) > np.cos(np.radians(0.5))).all())
