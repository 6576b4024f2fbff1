"""Feet that stand flat when they stand: the last constant that a rest pose gets wrong.

Marker models put the foot's frame a few degrees off the sole and one ankle up to two centimetres above the other. While
a foot stands flat its sole *is* the floor, so those frames say what the rest pose should have: the motion of every
joint stays as it was, only the frames of ankle and toe and the height of the sole under them are corrected, once for
the clip."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body.skeleton import ANKLES, TOES, Pose
from engine.maths import rotations

UP = np.array([0.0, 0.0, 1.0])
# a foot further over than this rolls, it does not stand flat
FLAT_RAD = np.radians(12.0)
FEWEST_FLAT_S = 0.1
LEAST_SHARE = 0.15
GREATEST_SOLE_SHIFT_M = 0.03


class Feet(NamedTuple):
    """A pose and bones with the ankles' and toes' frames put level."""

    pose: Pose
    offset_m: np.ndarray  # (21, 3)
    flat: np.ndarray  # (F, 2) frames in which each foot stands flat; none for a foot that never does


def level_feet(pose: Pose, offset_m: np.ndarray, orientations: np.ndarray, planted: np.ndarray, fps: float) -> Feet:
    """Turns the frames of ankles and toes so that a foot that stands flat is level. orientations (F, 21, 4) of the
    pose, world Z up."""
    local, offset_m = pose.rotations.copy(), offset_m.copy()
    flat = np.zeros_like(planted)
    for side, (ankle, toe) in enumerate(zip(ANKLES, TOES, strict=True)):
        stands = _flat(orientations[:, ankle], planted[:, side], fps)
        if not stands.any():
            continue
        flat[:, side] = stands
        turn = _levelling(orientations[stands, ankle])
        local[:, ankle] = rotations.multiply(local[:, ankle], turn)
        if np.isfinite(offset_m[toe]).all():
            offset_m[toe] = rotations.unrotate(turn, offset_m[toe])
        if _moves_by_itself(pose.rotations[:, toe]):
            toe_stands = stands & _flat(orientations[:, toe], planted[:, side], fps)
            toe_turn = _levelling(orientations[toe_stands, toe]) if toe_stands.any() else turn
            local[:, toe] = rotations.multiply(rotations.multiply(rotations.conjugate(turn), local[:, toe]), toe_turn)
    return Feet(Pose(pose.root_m, local), offset_m, flat)


def _flat(orientation: np.ndarray, planted: np.ndarray, fps: float) -> np.ndarray:
    """(F,) the frames in which a joint of the foot is planted and nearly level, if there are enough to learn from."""
    tilt = rotations.rotate(orientation, UP)[:, 2]
    flat = planted & (tilt > np.cos(FLAT_RAD))
    enough = flat.sum() >= max(FEWEST_FLAT_S * fps, LEAST_SHARE * planted.sum(), 1.0)
    return flat if enough else np.zeros_like(flat)


def _levelling(orientation: np.ndarray) -> np.ndarray:
    """The constant turn (4,) after which these frames (F, 4) are, in the median, level."""
    up = np.median(rotations.unrotate(orientation, UP), axis=0)
    return rotations.between(UP, up / np.linalg.norm(up))


def _moves_by_itself(local: np.ndarray) -> bool:
    return bool(np.abs(local[:, 1:]).max() > 1e-9)


def stand_on(
    ankle_m: np.ndarray, sole_m: np.ndarray, flat: np.ndarray, ball_level_m: np.ndarray, toe_offset_m: np.ndarray
) -> tuple[float, np.ndarray]:
    """The floor's height, and how much each sole must be moved to lie on it, (2,) metres.

    ankle_m (F, 2) heights, sole_m (2, 6, 3) as anthropometry has it, ball_level_m (2,) heights of standing balls. The
    floor is where the two soles are on average; what is left between left and right is made up by the soles."""
    under = np.array(
        [
            np.median(ankle_m[flat[:, s], s]) + sole_m[s, 0, 2]
            if flat[:, s].any()
            else ball_level_m[s] - toe_offset_m[s, 2] + sole_m[s, 0, 2]
            for s in (0, 1)
        ]
    )
    floor = float(under.mean())
    return floor, np.clip(floor - under, -GREATEST_SOLE_SHIFT_M, GREATEST_SOLE_SHIFT_M)
