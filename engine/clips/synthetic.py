"""`sway`: a person who stands, shifts weight and breathes. Made here from a few sines, so that everything works without
any file.

Every angle and path is a sum of harmonics of one period, so the clip goes round without a seam. The feet never move:
the pelvis is what sways, and the legs follow in closed form (two bones, law of cosines)."""

from __future__ import annotations

import hashlib

import numpy as np

from engine.body.anthropometry import standard_body, stature_m
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
    PELVIS,
    SHOULDERS,
    WAIST,
    WRISTS,
    Body,
    Pose,
)
from engine.clips.clip import Clip, ImportReport, Loop
from engine.maths import rotations

FPS, PERIOD_S = 60.0, 8.0
# the loop needs a frame or two either side of its ends to fade in and to interpolate
SPARE_FRAMES = 3
STANCE_HALF_WIDTH_M, TOE_OUT_RAD = 0.12, np.radians(8.0)
# share of the straight leg that hips and ankles are apart, upright
LEG_REACH = 0.985
SIDE_M, FORE_M, DIP_M = 0.030, 0.008, 0.004
VERSION = "1"


def sway(sex: str = "male", body_mass_kg: float | None = None) -> Clip:
    """The clip; a standard body of 1.75 m. Both feet planted throughout, looping over eight seconds."""
    body = standard_body(1.75, sex=sex, mass_kg=body_mass_kg)
    frames = round(PERIOD_S * FPS) + 2 * SPARE_FRAMES
    phase = 2.0 * np.pi * np.arange(frames) / (PERIOD_S * FPS)
    local = _upper_body(phase)
    root_m = _pelvis_path(phase, body)
    local[:, PELVIS] = _euler(phase, x=2.0 * np.sin(phase), y=1.0 + 0.4 * np.sin(2 * phase), z=2.5 * np.sin(phase))
    for side in (0, 1):
        _stand(local, root_m, body, side)
    pose = Pose(root_m, rotations.continuity(local))
    planted = np.ones((frames, 2), bool)
    loop = Loop(float(SPARE_FRAMES), SPARE_FRAMES + PERIOD_S * FPS, float(SPARE_FRAMES))
    key = hashlib.sha256(f"sway {VERSION} {sex} {body_mass_kg}".encode()).hexdigest()
    return Clip("sway", FPS, pose, body, planted, loop, _report(body, frames), key)


def _euler(
    phase: np.ndarray, x: np.ndarray | float = 0.0, y: np.ndarray | float = 0.0, z: np.ndarray | float = 0.0
) -> np.ndarray:
    """Rotations (F, 4) about X, then Y, then Z of the parent, degrees."""
    angles = np.stack(np.broadcast_arrays(np.zeros_like(phase), z, y, x), axis=-1)[:, 1:]
    return rotations.from_euler("ZYX", np.radians(angles))


def _pelvis_path(phase: np.ndarray, body: Body) -> np.ndarray:
    """(F, 3): over the origin at phase 0, out to the left, back, out to the right."""
    leg = -(body.offset_m[KNEES[0], 2] + body.offset_m[ANKLES[0], 2])
    height = -body.sole_m[0, 0, 2] + LEG_REACH * leg - body.offset_m[HIPS[0], 2]
    side = SIDE_M * (np.sin(phase) + 0.15 * np.sin(3 * phase))
    fore = FORE_M * (np.sin(2 * phase) + 0.5 * np.sin(3 * phase))
    return np.stack([fore, side, height - DIP_M * np.sin(phase) ** 2], axis=-1)


def _upper_body(phase: np.ndarray) -> np.ndarray:
    """(F, 21, 4): the trunk stays over the feet while the pelvis sways, the chest breathes twice a period, the arms
    hang."""
    local = np.tile([1.0, 0.0, 0.0, 0.0], (len(phase), JOINT_COUNT, 1))
    breath = 0.5 - 0.5 * np.cos(2 * phase)
    local[:, WAIST] = _euler(phase, x=-1.6 * np.sin(phase), y=0.5, z=-1.2 * np.sin(phase))
    local[:, BACK] = _euler(phase, x=-1.0 * np.sin(phase), y=1.5 - 1.2 * breath, z=-1.0 * np.sin(phase + 0.2))
    local[:, NECK] = _euler(phase, x=0.5 * np.sin(phase), y=2.0 + 0.5 * breath, z=2.5 * np.sin(phase + 0.9))
    local[:, HEAD] = _euler(phase, y=-4.0 + 0.5 * breath, z=2.0 * np.sin(phase + 0.9))
    for side, out in enumerate((1.0, -1.0)):
        swing = np.sin(phase - 0.6)
        local[:, CLAVICLES[side]] = _euler(phase, x=out * 1.8 * breath)
        local[:, SHOULDERS[side]] = _euler(phase, x=out * (7.0 - 0.8 * breath), y=1.0 - out * 0.8 * swing, z=-out * 6.0)
        local[:, ELBOWS[side]] = _euler(phase, y=-14.0 + out * 0.7 * swing, z=-out * 10.0)
        local[:, WRISTS[side]] = _euler(phase, x=out * 2.0, y=-3.0)
    return local


def _stand(local: np.ndarray, root_m: np.ndarray, body: Body, side: int) -> None:
    """Writes hip, knee and ankle of one leg so that its foot stays flat where it stands."""
    out = 1.0 if side == 0 else -1.0
    thigh, shin = -body.offset_m[KNEES[side], 2], -body.offset_m[ANKLES[side], 2]
    foot = rotations.about_z(np.full(len(root_m), out * TOE_OUT_RAD))
    ankle = np.array([0.0, out * STANCE_HALF_WIDTH_M, -body.sole_m[side, 0, 2]])
    hip = root_m + rotations.rotate(local[:, PELVIS], body.offset_m[HIPS[side]])
    reach = np.linalg.norm(ankle - hip, axis=-1)
    # the leg's own frame: up along hip - ankle, the knee towards where the toes point
    up = (hip - ankle) / reach[:, None]
    ahead = rotations.rotate(foot, np.array([1.0, 0.0, 0.0]))
    ahead = ahead - up * np.sum(up * ahead, axis=-1, keepdims=True)
    ahead /= np.linalg.norm(ahead, axis=-1, keepdims=True)
    leg = rotations.from_matrix(np.stack([ahead, np.cross(up, ahead), up], axis=-1))
    at_hip = np.arccos((thigh**2 + reach**2 - shin**2) / (2.0 * thigh * reach))
    at_ankle = np.arccos((shin**2 + reach**2 - thigh**2) / (2.0 * shin * reach))
    upper = rotations.multiply(leg, rotations.from_euler("Y", -at_hip[:, None]))
    lower = rotations.multiply(leg, rotations.from_euler("Y", at_ankle[:, None]))
    local[:, HIPS[side]] = rotations.multiply(rotations.conjugate(local[:, PELVIS]), upper)
    local[:, KNEES[side]] = rotations.multiply(rotations.conjugate(upper), lower)
    local[:, ANKLES[side]] = rotations.multiply(rotations.conjugate(lower), foot)


def _report(body: Body, frames: int) -> ImportReport:
    leg = -(body.offset_m[KNEES[0], 2] + body.offset_m[ANKLES[0], 2])
    return ImportReport(
        name="sway",
        format="synthetic",
        frames=frames,
        fps=FPS,
        duration_s=(frames - 1) / FPS,
        source_joints=JOINT_COUNT,
        scale_to_m=1.0,
        up_axis="+Z",
        leg_length_m=float(leg),
        height_m=stature_m(body.offset_m),
        floor_m=0.0,
        floor_slope=0.0,
        facing_deg=0.0,
        rest_frames_dropped=0,
        glitches=[],
        planted={side: [[0, frames - 1]] for side in ("left", "right")},
        missing_joints=[],
        hinge_residual_deg=0.0,
        position_error_m=0.0,
        notes=["made by Brace itself"],
    )
