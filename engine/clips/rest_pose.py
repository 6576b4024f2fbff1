"""What a file's rest pose says: where the canonical joints lie in it and how their frames are aligned with it.

The canonical rest is standing with the arms hanging, palms in, legs straight, feet ahead; a file's may be a T-pose,
legs apart. An *alignment* is the constant turn from the one to the other, joint by joint.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.body.anthropometry import BALL_AHEAD, BUILD, TOE_AHEAD, TOE_JOINT_HEIGHT
from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    ELBOWS,
    HEAD,
    HIPS,
    JOINT_COUNT,
    KNEES,
    NECK,
    PARENT,
    PELVIS,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
)
from engine.clips.rig import Rig
from engine.maths import rotations

DOWN, AHEAD = np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0])
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])
FOREARM = 0.146  # of stature, where a file has no wrist (Winter, fig. 4.1)


@dataclass(frozen=True)
class Source:
    """The file's joints in metres, Z up; the rest pose ahead along X."""

    positions: np.ndarray  # (F, J, 3)
    orientations: np.ndarray  # (F, J, 4); the rest pose is the identity
    rest: np.ndarray  # (J, 3)
    tips: dict[int, np.ndarray]  # joint row -> (3,) end of its bone, from the joint, in the rest pose


def rows_of(rig: Rig, rest: np.ndarray, height_m: float) -> dict[int, int]:
    """Canonical joint -> the source joint at whose place it lies."""
    rows = {PELVIS: rig.pelvis, BACK: rig.spine[-1]}
    # a lower back that starts at the root itself would put the waist on the pelvis
    if len(rig.spine) > 1 and np.linalg.norm(rest[rig.spine[0]] - rest[rig.pelvis]) > 0.01 * height_m:
        rows[WAIST] = rig.spine[0]
    if rig.neck:
        rows[NECK] = rig.neck[0]
    if len(rig.neck) > 1:
        rows[HEAD] = rig.neck[-1]
    limbs = (
        (CLAVICLES, rig.collar),
        (SHOULDERS, rig.shoulder),
        (ELBOWS, rig.elbow),
        (WRISTS, rig.wrist),
        (HIPS, rig.hip),
        (KNEES, rig.knee),
        (ANKLES, rig.ankle),
        (TOES, rig.toe),
    )
    for joints, found in limbs:
        for side in (0, 1):
            if found[side] is not None:
                rows[joints[side]] = int(found[side])  # type: ignore[arg-type]
    return rows


def rest_joints(source: Source, rig: Rig, rows: dict[int, int], height_m: float) -> dict[int, np.ndarray]:
    """Where every canonical joint lies in the file's rest pose (3,); those that it lacks are filled in from
    anthropometry."""
    rest = {j: source.rest[row] for j, row in rows.items()}
    if WAIST not in rest:
        # half way along the lowest bone of the spine is where a person bends
        above = source.rest[rig.spine[1]] if len(rig.spine) > 1 else rest[BACK]
        rest[WAIST] = 0.5 * (rest[PELVIS] + above)
    shoulders = 0.5 * (rest[SHOULDERS[0]] + rest[SHOULDERS[1]])
    if NECK not in rest:
        rest[NECK] = shoulders
    if HEAD not in rest:
        rest[HEAD] = rest[NECK] + np.array([0.01, 0.0, 0.055]) * height_m
    for side in (0, 1):
        if CLAVICLES[side] not in rest:
            outwards = rest[SHOULDERS[side]] - shoulders
            rest[CLAVICLES[side]] = shoulders + 0.15 * outwards
        if WRISTS[side] not in rest:
            rest[WRISTS[side]] = rest[ELBOWS[side]] + source.tips.get(rig.elbow[side], DOWN * FOREARM * height_m)
        if TOES[side] not in rest and rig.ankle[side] in source.tips:
            rest[TOES[side]] = rest[ANKLES[side]] + _toe_on_the_way(source.tips[rig.ankle[side]], height_m)
    return rest


def _toe_on_the_way(tip: np.ndarray, height_m: float) -> np.ndarray:
    """The toe joint of a foot without one: where its bone ends, if that is at the ball; a share of the way, if at the
    toes' tips."""
    reach = float(np.hypot(tip[0], tip[1])) / (height_m * BUILD["male"].foot)
    if reach < BALL_AHEAD + 0.5 * TOE_AHEAD:
        return tip
    share = BALL_AHEAD / (BALL_AHEAD + TOE_AHEAD)
    # the tips of the toes lie on the ground, the joint a little over it
    return np.array([tip[0] * share, tip[1] * share, tip[2] + TOE_JOINT_HEIGHT * height_m])


def unit(v: np.ndarray) -> np.ndarray:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


def alignments(source: Source, rig: Rig, rest: dict[int, np.ndarray]) -> np.ndarray:
    """(21, 4) what turns a canonical joint's frame into the source's rest pose: bones of limbs along -Z, hinges about
    Y."""
    alignment = np.tile(IDENTITY, (JOINT_COUNT, 1))
    for side in (0, 1):
        upper, fore = (
            unit(rest[b] - rest[a]) for a, b in ((SHOULDERS[side], ELBOWS[side]), (ELBOWS[side], WRISTS[side]))
        )
        # from hanging arms to the rest pose's the short way: a T-pose then has its palms down, as it does in every
        # convention met
        alignment[SHOULDERS[side]] = rotations.between(DOWN, upper)
        alignment[ELBOWS[side]] = rotations.multiply(rotations.between(upper, fore), alignment[SHOULDERS[side]])
        hand = unit(_hand(source, rig, side, fore))
        alignment[WRISTS[side]] = rotations.multiply(rotations.between(fore, hand), alignment[ELBOWS[side]])
        thigh, shin = (unit(rest[b] - rest[a]) for a, b in ((HIPS[side], KNEES[side]), (KNEES[side], ANKLES[side])))
        alignment[HIPS[side]] = rotations.between(DOWN, thigh)
        alignment[KNEES[side]] = rotations.multiply(rotations.between(thigh, shin), alignment[HIPS[side]])
        alignment[ANKLES[side]] = alignment[TOES[side]] = _foot_alignment(_foot(source, rig, side), shin)
    return alignment


def _hand(source: Source, rig: Rig, side: int, fore: np.ndarray) -> np.ndarray:
    """The direction of the hand in the rest pose: to its last bone's end, or straight on."""
    row = rig.wrist[side]
    tip = source.tips.get(row) if row is not None else None
    return tip if tip is not None and np.sum(unit(tip) * fore) > 0.8 else fore


def _foot(source: Source, rig: Rig, side: int) -> np.ndarray:
    """Ankle to toe joint (or to the end of the foot) in the rest pose; straight ahead if the file says nothing."""
    row = rig.toe[side]
    if row is not None:
        return source.rest[row] - source.rest[rig.ankle[side]]
    return source.tips.get(rig.ankle[side], AHEAD)


def _foot_alignment(foot: np.ndarray, shin: np.ndarray) -> np.ndarray:
    """A foot that is level fore and aft in the rest pose, tilted sideways with a splayed leg, toes where the foot
    points."""
    splay = rotations.between(DOWN, unit(np.array([0.0, shin[1], shin[2]])))
    flat = rotations.unrotate(splay, foot)
    return rotations.multiply(splay, rotations.about_z(np.arctan2(flat[1], flat[0])))


def offsets(rest: dict[int, np.ndarray], alignment: np.ndarray) -> np.ndarray:
    """(21, 3) every joint in its parent's frame: what the rest pose says, seen from the aligned parent."""
    offset = np.full((JOINT_COUNT, 3), np.nan)
    offset[PELVIS] = 0.0
    for j in range(1, JOINT_COUNT):
        if j in rest:
            offset[j] = rotations.unrotate(alignment[PARENT[j]], rest[j] - rest[PARENT[j]])
    for joints in (ELBOWS, WRISTS, KNEES, ANKLES):
        for j in joints:
            offset[j] = DOWN * np.linalg.norm(offset[j])
    return offset


def extents(
    source: Source, rig: Rig, alignment: np.ndarray, height_m: float
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Crown (3,) and fingertips (2, 3) where the file ends its head and hands at a human distance; else None for
    anthropometry."""
    top = source.tips.get(rig.neck[-1]) if len(rig.neck) > 1 else None
    if top is not None and not (0.07 < top[2] / height_m < 0.12 and abs(top[0]) < 0.5 * top[2]):
        top = None
    tips = []
    for side in (0, 1):
        row = rig.wrist[side]
        tip = source.tips.get(row) if row is not None else None
        if tip is not None and 0.08 < np.linalg.norm(tip) / height_m < 0.125:
            tips.append(rotations.unrotate(alignment[WRISTS[side]], tip))
    return top, np.array(tips) if len(tips) == 2 else None
