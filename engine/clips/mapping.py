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

from engine.body.skeleton import (
    ANKLES,
    BACK,
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
    WAIST,
    WRISTS,
    Pose,
)
from engine.clips.axes import Axes, leg_length
from engine.clips.rest_pose import DOWN, Source, alignments, extents, offsets, rest_joints, rows_of, unit
from engine.clips.rig import Rig
from engine.clips.tracks import Tracks, rest_positions, world_of
from engine.maths import rotations

# a limb bent less than this tells nothing about its hinge; one bent more than that tells all
HINGE_UNSURE_RAD, HINGE_SURE_RAD = np.radians(12.0), np.radians(35.0)
SHORTEST_BONE_M = 0.01
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


def map_tracks(tracks: Tracks, rig: Rig, axes: Axes) -> Mapped:
    """The motion on the canonical skeleton. Shapes as in `Mapped`."""
    source = _source(tracks, axes)
    height_m = leg_length(source.rest, rig) * STATURE_PER_LEG
    rows = rows_of(rig, source.rest, height_m)
    rest = rest_joints(source, rig, rows, height_m)
    alignment = alignments(source, rig, rest)
    turned = _orientations(source, rig, rows, alignment)
    places = {j: source.positions[:, row] for j, row in rows.items()}
    offset = offsets(rest, alignment)
    hinge_error = _straighten_hinges(turned, places)
    _aim(turned, places, offset)
    pose = Pose(source.positions[:, rig.pelvis].copy(), _locals(turned))
    head_top, fingertip = extents(source, rig, alignment, height_m)
    error = _position_error(turned, offset, places)
    return Mapped(pose, offset, head_top, fingertip, _missing(rows, rig), hinge_error, error)


def _source(tracks: Tracks, axes: Axes) -> Source:
    positions, orientations = world_of(tracks)
    back = rotations.conjugate(axes.rest_from_file)
    tips = {row: rotations.rotate(axes.rest_from_file, tip) * axes.scale_to_m for row, tip in tracks.tips.items()}
    return Source(
        rotations.rotate(axes.world_from_file, positions) * axes.scale_to_m,
        rotations.multiply(rotations.multiply(axes.world_from_file, orientations), back),
        rotations.rotate(axes.rest_from_file, rest_positions(tracks)) * axes.scale_to_m,
        # many files end a chain with a site of no length, which says nothing
        {row: tip for row, tip in tips.items() if np.linalg.norm(tip) > SHORTEST_BONE_M},
    )


def _missing(rows: dict[int, int], rig: Rig) -> tuple[str, ...]:
    """The canonical joints that nothing in the file moves."""
    return tuple(name for j, name in enumerate(JOINTS) if j not in rows and not (j == WAIST and len(rig.spine) > 1))


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
            bone = unit(places[end] - places[middle])
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
            points = rotations.rotate(turned[:, j], unit(offset[child]))
            turned[:, j] = rotations.multiply(rotations.between(points, unit(places[child] - start)), turned[:, j])


def _locals(turned: np.ndarray) -> np.ndarray:
    """Rotations local to parent (F, 21, 4), interpolable from frame to frame."""
    local = turned.copy()
    local[:, 1:] = rotations.multiply(rotations.conjugate(turned[:, PARENT[1:]]), turned[:, 1:])
    return rotations.continuity(rotations.normalise(local))


def _position_error(turned: np.ndarray, offset: np.ndarray, places: dict[int, np.ndarray]) -> float:
    """The greatest distance between a canonical joint and the source joint that it stands for."""
    at, worst = {PELVIS: places[PELVIS]}, 0.0
    for j in range(1, JOINT_COUNT):
        if np.isfinite(offset[j]).all():
            at[j] = at[PARENT[j]] + rotations.rotate(turned[:, PARENT[j]], offset[j])
            if j in places:
                worst = max(worst, float(np.linalg.norm(at[j] - places[j], axis=-1).max()))
    return worst
