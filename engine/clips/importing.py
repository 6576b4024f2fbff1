"""A motion file becomes a clip: read, mapped, laid on a level floor, facing ahead. The steps in their order."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from engine.body.anthropometry import make_body, stature_m
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, TOES, Body, Pose
from engine.clips.acclaim import read_acclaim
from engine.clips.axes import find_axes, leg_length
from engine.clips.bvh import read_bvh
from engine.clips.clip import Clip, ImportReport
from engine.clips.contacts import runs
from engine.clips.deepmimic import read_deepmimic
from engine.clips.feet import level_feet, stand_on
from engine.clips.floor import Floor, fit_floor, level_from_floor
from engine.clips.glitches import mend_glitches
from engine.clips.looping import find_loop
from engine.clips.making import Wanted, content_key, sources_of
from engine.clips.mapping import Mapped, map_tracks
from engine.clips.npz import read_npz
from engine.clips.rest_frames import rest_frames
from engine.clips.rig import find_rig, restore_dropped_bones
from engine.clips.tracks import Tracks, rest_positions
from engine.core.errors import BadInput
from engine.maths import rotations


def import_clip(
    path: str | Path,
    *,
    sex: str = "male",
    body_mass_kg: float | None = None,
    name: str | None = None,
    frames: tuple[int, int] | None = None,
    as_captured: bool = False,
) -> Clip:
    """The clip in a .bvh, .amc (its .asf beside it), .npz or .json (DeepMimic) file. BadInput says what is wrong
    with the file, and where.

    frames: first and last frame of the file to keep, 0-based; all of them if absent. as_captured: glitches of a frame
    or two (`engine.clips.glitches`) are left as they are.
    """
    path = Path(path)
    first, last = frames or (0, None)
    wanted = Wanted(sex, body_mass_kg, first, last, as_captured)
    return build_clip(read_tracks(path), path, wanted, name or path.stem, content_key(path, wanted))


def read_tracks(path: Path) -> Tracks:
    """What the file says, by its kind."""
    files = sources_of(path)
    if len(files) == 2:
        return read_acclaim(*files)
    readers = {".bvh": read_bvh, ".npz": read_npz, ".json": read_deepmimic}
    return readers[path.suffix.lower()](path)


class Standing(NamedTuple):
    """A motion on a level floor, its feet flat on it, still where the file put it."""

    pose: Pose
    body: Body
    planted: np.ndarray  # (F, 2)
    floor_m: float
    slope: float  # that the file's floor had


def build_clip(tracks: Tracks, where: Path, wanted: Wanted, name: str, key: str) -> Clip:
    """The steps of the import, each on the outcome of the one before."""
    rig = find_rig(tracks, where)
    tracks = restore_dropped_bones(tracks, rig)
    axes = find_axes(tracks, rig)
    mapped = map_tracks(tracks, rig, axes)
    dropped = _dropped(mapped, _body(mapped, mapped.offset_m, wanted, where), tracks)
    kept = _kept(mapped.pose, dropped, wanted, where)
    whole, glitches = mend_glitches(kept, tracks.fps) if tracks.captured and not wanted.as_captured else (kept, [])
    standing = _stand(whole, mapped, wanted, where, tracks)
    pose, facing = _facing_ahead(standing.pose, standing.floor_m)
    loop = find_loop(pose, standing.body, standing.planted, tracks.fps)
    report = ImportReport(
        name=name,
        format=tracks.format,
        frames=len(pose.root_m),
        fps=tracks.fps,
        duration_s=(len(pose.root_m) - 1) / tracks.fps,
        source_joints=len(tracks.names),
        scale_to_m=axes.scale_to_m,
        up_axis=axes.up,
        leg_length_m=leg_length(rest_positions(tracks), rig) * axes.scale_to_m,
        height_m=stature_m(standing.body.offset_m),
        floor_m=standing.floor_m,
        floor_slope=standing.slope,
        facing_deg=float(np.degrees(facing)),
        rest_frames_dropped=dropped,
        glitches=[{**glitch._asdict(), "joints": list(glitch.joints)} for glitch in glitches],
        planted={side: [list(run) for run in runs(standing.planted[:, s])] for s, side in enumerate(("left", "right"))},
        missing_joints=list(mapped.missing),
        hinge_residual_deg=mapped.hinge_residual_deg,
        position_error_m=mapped.position_error_m,
        notes=[*tracks.notes, *axes.notes],
    )
    return Clip(name, tracks.fps, pose, standing.body, standing.planted, loop, report, key)


def _stand(pose: Pose, mapped: Mapped, wanted: Wanted, where: Path, tracks: Tracks) -> Standing:
    """Finds the floor, levels it, and puts the soles on it."""
    fps = tracks.fps
    floor = _floor(pose, _body(mapped, mapped.offset_m, wanted, where), fps, tracks.level)
    pose = _turned(pose, level_from_floor(floor.slope))
    positions, orientations = joints_of(_body(mapped, mapped.offset_m, wanted, where), pose)
    feet = level_feet(pose, mapped.offset_m, orientations, floor.planted, fps)
    body = _body(mapped, feet.offset_m, wanted, where)
    ankle_heights = positions[:, list(ANKLES), 2]
    balls = _ball_levels(positions, floor)
    floor_m, shift = stand_on(ankle_heights, body.sole_m, feet.flat, balls, body.offset_m[list(TOES)])
    body = body._replace(sole_m=body.sole_m + shift[:, None, None] * np.array([0.0, 0.0, 1.0]))
    return Standing(feet.pose, body, floor.planted, floor_m, float(np.linalg.norm(floor.slope)))


def _body(mapped: Mapped, offset_m: np.ndarray, wanted: Wanted, where: Path) -> Body:
    try:
        return make_body(
            offset_m,
            sex=wanted.sex,
            mass_kg=wanted.body_mass_kg,
            head_top_m=mapped.head_top_m,
            fingertip_m=mapped.fingertip_m,
        )
    except ValueError as trouble:
        raise BadInput("clip-body", str(trouble), str(where)) from None


def _dropped(mapped: Mapped, body: Body, tracks: Tracks) -> int:
    pose = mapped.pose
    _, orientations = joints_of(body, Pose(pose.root_m[:1], pose.rotations[:1]))
    return rest_frames(pose.rotations, orientations, tracks.rotations, tracks.fps)


def _kept(pose: Pose, dropped: int, wanted: Wanted, where: Path) -> Pose:
    """The frames asked for, less the rest frames at the start of the file."""
    frames = len(pose.root_m)
    last = frames - 1 if wanted.last_frame is None else wanted.last_frame
    if not 0 <= wanted.first_frame <= last < frames:
        raise BadInput(
            "clip-frames",
            f"found frames 0 to {frames - 1}, expected {wanted.first_frame} to {last} among them",
            str(where),
        )
    keep = slice(max(dropped, wanted.first_frame), last + 1)
    if len(pose.root_m[keep]) == 0:
        raise BadInput("clip-frames", "found nothing but a rest pose, expected a motion", str(where))
    return Pose(pose.root_m[keep].copy(), pose.rotations[keep].copy())


def _floor(pose: Pose, body: Body, fps: float, level: bool) -> Floor:
    positions, _ = joints_of(body, pose)
    return fit_floor(positions[:, list(TOES)], positions[:, list(ANKLES)], pose.root_m, fps, level)


def _turned(pose: Pose, turn: np.ndarray) -> Pose:
    """The whole motion turned about the world's origin."""
    local = pose.rotations.copy()
    local[:, 0] = rotations.multiply(turn, local[:, 0])
    return Pose(rotations.rotate(turn, pose.root_m), local)


def _ball_levels(positions: np.ndarray, floor: Floor) -> np.ndarray:
    """Heights (2,) of the balls of standing feet once the floor is level; a foot that never stands takes the other's,
    and two that never stand the lowest point reached."""
    heights = positions[:, list(TOES), 2]
    if not floor.planted.any():
        return np.repeat(heights.min(), 2)
    level = [np.median(heights[floor.planted[:, s], s]) if floor.planted[:, s].any() else np.inf for s in (0, 1)]
    return np.where(np.isinf(level), min(level), level)


def _facing_ahead(pose: Pose, floor_m: float) -> tuple[Pose, float]:
    """The motion moved so that its first frame is over the origin and faces +X, its floor at zero; and the heading that
    it had."""
    facing = float(rotations.heading(pose.rotations[0, 0]))
    shifted = Pose(pose.root_m - np.array([*pose.root_m[0, :2], floor_m]), pose.rotations)
    turned = _turned(shifted, rotations.about_z(-facing))
    return Pose(
        np.ascontiguousarray(turned.root_m), np.ascontiguousarray(rotations.continuity(turned.rotations))
    ), facing
