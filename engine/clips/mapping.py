"""From a file's joints to the canonical 21, keeping the subject's own bones.

The world orientation of a canonical joint is the source joint's world orientation times a constant *alignment*, found
from the rest pose, that takes "arms hanging, palms in, legs straight, feet ahead" to the identity. Where several source
joints make one (spine, neck, forearm), it is the last of them, then swung the least that points the bone at the next
joint's true place, so that shortening the chain costs millimetres. Elbows and knees end up bending about their own Y:
what the rest pose says of that axis is corrected once for the clip, and what is left is turned back frame by frame, as
far as the limb is bent, by turning the upper bone about itself, which moves no joint."""

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
    JOINTS,
    KNEES,
    NECK,
    PARENT,
    PELVIS,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
    Pose,
)
from engine.clips.axes import Axes, leg_length
from engine.clips.rig import Rig
from engine.clips.tracks import Tracks, rest_positions, world_of
from engine.maths import rotations

DOWN, AHEAD = np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0])
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])
# a limb bent less than this tells nothing about its hinge; one bent more than that tells all
HINGE_UNSURE_RAD, HINGE_SURE_RAD = np.radians(12.0), np.radians(35.0)
FOREARM = 0.146  # of stature, where a file has no wrist (Winter, fig. 4.1)
STATURE_PER_LEG = 1.0 / 0.495  # de Leva 1996, males: thigh and shank are 49.5 % of stature


@dataclass(frozen=True)
class Mapped:
    """A clip on the canonical skeleton, still where the file put it."""

    pose: Pose  # (F, 3), (F, 21, 4)
    offset_m: np.ndarray  # (21, 3); toes nan where the file has none
    head_top_m: np.ndarray | None
    fingertip_m: np.ndarray | None
    missing: tuple[str, ...]  # canonical joints that the file has no joint for
    # how far from its Y axis a well-bent elbow or knee of the file bends, 95th percentile, before it is put right
    hinge_residual_deg: float
    position_error_m: float  # how far a joint that both have lies from where the file has it, at most


@dataclass(frozen=True)
class Source:
    """The file's joints in metres, Z up; the rest pose ahead along X."""

    positions: np.ndarray  # (F, J, 3)
    orientations: np.ndarray  # (F, J, 4); the rest pose is the identity
    rest: np.ndarray  # (J, 3)
    tips: dict[int, np.ndarray]  # joint row -> (3,) end of its bone, from the joint, in the rest pose


def map_tracks(tracks: Tracks, rig: Rig, axes: Axes) -> Mapped:
    """The motion on the canonical skeleton. Shapes as in `Mapped`."""
    source = _source(tracks, axes)
    height_m = leg_length(source.rest, rig) * STATURE_PER_LEG
    rows = _rows(rig, source.rest, height_m)
    rest = _rest_joints(source, rig, rows, height_m)
    alignment = _alignments(source, rig, rest)
    turned = _orientations(source, rig, rows, alignment)
    places = {j: source.positions[:, row] for j, row in rows.items()}
    offset = _offsets(rest, alignment)
    hinge_error = _straighten_hinges(turned, places)
    _aim(turned, places, offset)
    pose = Pose(source.positions[:, rig.pelvis].copy(), _locals(turned))
    head_top, fingertip = _extents(source, rig, alignment, height_m)
    error = _position_error(turned, offset, places)
    return Mapped(pose, offset, head_top, fingertip, _missing(rows, rig), hinge_error, error)


def _source(tracks: Tracks, axes: Axes) -> Source:
    positions, orientations = world_of(tracks)
    back = rotations.conjugate(axes.rest_from_file)
    return Source(
        rotations.rotate(axes.world_from_file, positions) * axes.scale_to_m,
        rotations.multiply(rotations.multiply(axes.world_from_file, orientations), back),
        rotations.rotate(axes.rest_from_file, rest_positions(tracks)) * axes.scale_to_m,
        {row: rotations.rotate(axes.rest_from_file, tip) * axes.scale_to_m for row, tip in tracks.tips.items()},
    )


def _rows(rig: Rig, rest: np.ndarray, height_m: float) -> dict[int, int]:
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


def _missing(rows: dict[int, int], rig: Rig) -> tuple[str, ...]:
    """The canonical joints that nothing in the file moves."""
    return tuple(name for j, name in enumerate(JOINTS) if j not in rows and not (j == WAIST and len(rig.spine) > 1))


def _rest_joints(source: Source, rig: Rig, rows: dict[int, int], height_m: float) -> dict[int, np.ndarray]:
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


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-12)


def _alignments(source: Source, rig: Rig, rest: dict[int, np.ndarray]) -> np.ndarray:
    """(21, 4) what turns a canonical joint's frame into the source's rest pose: bones of limbs along -Z, hinges about
    Y."""
    alignment = np.tile(IDENTITY, (JOINT_COUNT, 1))
    for side in (0, 1):
        upper, fore = (
            _unit(rest[b] - rest[a]) for a, b in ((SHOULDERS[side], ELBOWS[side]), (ELBOWS[side], WRISTS[side]))
        )
        # from hanging arms to the rest pose's the short way: a T-pose then has its palms down, as it does in every
        # convention met
        alignment[SHOULDERS[side]] = rotations.between(DOWN, upper)
        alignment[ELBOWS[side]] = rotations.multiply(rotations.between(upper, fore), alignment[SHOULDERS[side]])
        hand = _unit(_hand(source, rig, side, fore))
        alignment[WRISTS[side]] = rotations.multiply(rotations.between(fore, hand), alignment[ELBOWS[side]])
        thigh, shin = (_unit(rest[b] - rest[a]) for a, b in ((HIPS[side], KNEES[side]), (KNEES[side], ANKLES[side])))
        alignment[HIPS[side]] = rotations.between(DOWN, thigh)
        alignment[KNEES[side]] = rotations.multiply(rotations.between(thigh, shin), alignment[HIPS[side]])
        alignment[ANKLES[side]] = alignment[TOES[side]] = _foot_alignment(_foot(source, rig, side), shin)
    return alignment


def _hand(source: Source, rig: Rig, side: int, fore: np.ndarray) -> np.ndarray:
    """The direction of the hand in the rest pose: to its last bone's end, or straight on."""
    row = rig.wrist[side]
    tip = source.tips.get(row) if row is not None else None
    return tip if tip is not None and np.sum(_unit(tip) * fore) > 0.8 else fore


def _foot(source: Source, rig: Rig, side: int) -> np.ndarray:
    """Ankle to toe joint (or to the end of the foot) in the rest pose; straight ahead if the file says nothing."""
    row = rig.toe[side]
    if row is not None:
        return source.rest[row] - source.rest[rig.ankle[side]]
    return source.tips.get(rig.ankle[side], AHEAD)


def _foot_alignment(foot: np.ndarray, shin: np.ndarray) -> np.ndarray:
    """A foot that is level fore and aft in the rest pose, tilted sideways with a splayed leg, toes where the foot
    points."""
    splay = rotations.between(DOWN, _unit(np.array([0.0, shin[1], shin[2]])))
    flat = rotations.unrotate(splay, foot)
    return rotations.multiply(splay, rotations.about_z(np.arctan2(flat[1], flat[0])))


def _orientations(source: Source, rig: Rig, rows: dict[int, int], alignment: np.ndarray) -> np.ndarray:
    """World orientations (F, 21, 4) of the canonical joints; a joint that the file lacks turns with its parent."""
    turning = dict(rows)
    # of several joints that make one bone, the last knows how it is turned
    turning[WAIST] = rig.spine[-2] if len(rig.spine) > 1 else rig.pelvis
    turning[BACK] = rig.spine[-1]
    if rig.neck:
        turning[NECK] = rig.neck[-2] if len(rig.neck) > 1 else rig.neck[0]
    for side in (0, 1):
        turning[ELBOWS[side]] = rig.forearm[side]
    turned = np.empty((len(source.positions), JOINT_COUNT, 4))
    for j in range(JOINT_COUNT):
        if j in turning:
            turned[:, j] = rotations.multiply(source.orientations[:, turning[j]], alignment[j])
        else:
            relative = rotations.multiply(rotations.conjugate(alignment[PARENT[j]]), alignment[j])
            turned[:, j] = rotations.multiply(turned[:, PARENT[j]], relative)
    return turned


def _offsets(rest: dict[int, np.ndarray], alignment: np.ndarray) -> np.ndarray:
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


def _straighten_hinges(turned: np.ndarray, places: dict[int, np.ndarray]) -> float:
    """Turns upper arms and thighs about themselves so that elbows and knees bend about Y. Returns the residual,
    degrees.

    First by one constant angle for the clip, then frame by frame by what is left, faded in with the bend.
    """
    residuals = [np.zeros(1)]
    for upper, middle, end, ahead in [
        *((SHOULDERS[s], ELBOWS[s], WRISTS[s], 1.0) for s in (0, 1)),
        *((HIPS[s], KNEES[s], ANKLES[s], -1.0) for s in (0, 1)),
    ]:
        if end in places:
            bone = _unit(places[end] - places[middle])
        else:
            bone = rotations.rotate(turned[:, middle], DOWN)
        astray, bend = _hinge_error(turned[:, upper], bone, ahead)
        weight = np.sin(bend) ** 2 * (bend > HINGE_UNSURE_RAD)
        constant = np.arctan2(np.sum(weight * np.sin(astray)), np.sum(weight * np.cos(astray))) if weight.any() else 0.0
        left = (astray - constant + np.pi) % (2.0 * np.pi) - np.pi
        residuals.append(np.abs(left[bend > HINGE_SURE_RAD]))
        sure = np.clip((bend - HINGE_UNSURE_RAD) / (HINGE_SURE_RAD - HINGE_UNSURE_RAD), 0.0, 1.0)
        turned[:, upper] = rotations.multiply(
            turned[:, upper], rotations.about_z(constant + left * sure**2 * (3.0 - 2.0 * sure))
        )
    every = np.concatenate(residuals)
    return float(np.degrees(np.percentile(every, 95)))


def _hinge_error(upper: np.ndarray, bone: np.ndarray, ahead: float) -> tuple[np.ndarray, np.ndarray]:
    """How far (F,) about the upper bone the lower one lies from where a hinge about Y puts it, and how far it is bent.
    Radians."""
    local = rotations.unrotate(upper, bone)
    return np.arctan2(ahead * local[:, 1], ahead * local[:, 0]), np.arccos(np.clip(-local[:, 2], -1.0, 1.0))


def _aim(turned: np.ndarray, places: dict[int, np.ndarray], offset: np.ndarray) -> None:
    """Swings every single bone the least that points it at its next joint's true place, the joint itself being where FK
    puts it."""
    at = {PELVIS: places[PELVIS]}
    single = {WAIST: BACK, NECK: HEAD}
    single |= {
        a[s]: b[s] for a, b in ((SHOULDERS, ELBOWS), (ELBOWS, WRISTS), (HIPS, KNEES), (KNEES, ANKLES)) for s in (0, 1)
    }
    for j in range(1, JOINT_COUNT):
        parent = PARENT[j]
        if not np.isfinite(offset[j]).all():
            continue
        at[j] = at[parent] + rotations.rotate(turned[:, parent], offset[j])
        child = single.get(j)
        # a joint whose place is no joint of the file's (half way along the lower back) is aimed from where it is
        if child in places:
            start = places[j] if j in places else at[j]
            points = rotations.rotate(turned[:, j], _unit(offset[child]))
            turned[:, j] = rotations.multiply(rotations.between(points, _unit(places[child] - start)), turned[:, j])


def _locals(turned: np.ndarray) -> np.ndarray:
    """Rotations local to parent (F, 21, 4), interpolable from frame to frame."""
    local = turned.copy()
    local[:, 1:] = rotations.multiply(rotations.conjugate(turned[:, PARENT[1:]]), turned[:, 1:])
    return rotations.continuity(rotations.normalise(local))


def _extents(
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


def _position_error(turned: np.ndarray, offset: np.ndarray, places: dict[int, np.ndarray]) -> float:
    """The greatest distance between a canonical joint and the source joint that it stands for."""
    at, worst = {PELVIS: places[PELVIS]}, 0.0
    for j in range(1, JOINT_COUNT):
        if np.isfinite(offset[j]).all():
            at[j] = at[PARENT[j]] + rotations.rotate(turned[:, PARENT[j]], offset[j])
            if j in places:
                worst = max(worst, float(np.linalg.norm(at[j] - places[j], axis=-1).max()))
    return worst
