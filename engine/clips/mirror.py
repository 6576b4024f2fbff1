"""Left and right exchanged: the same motion seen in a mirror that stands along the X axis."""

from __future__ import annotations

import hashlib
from dataclasses import replace

import numpy as np

from engine.body.skeleton import JOINTS, MIRRORED, Body, Pose
from engine.clips.clip import Clip

# a mirror at Y = 0 turns points' Y over, and of a rotation's axis what is not Y
FLIP_POINT, FLIP_ROTATION = np.array([1.0, -1.0, 1.0]), np.array([1.0, -1.0, 1.0, -1.0])
# of a joint's swing X, swing Y and twist Z only Y keeps its sense
FLIPPED_LIMITS = np.array([True, False, True])
# inner and outer sole points stay inner and outer; they only change their foot
SIDES_SWAPPED = np.array([1, 0])


def mirror_pose(pose: Pose) -> Pose:
    """The mirrored pose, of one frame or any number."""
    return Pose(np.asarray(pose.root_m) * FLIP_POINT, np.asarray(pose.rotations)[..., MIRRORED, :] * FLIP_ROTATION)


def mirror_body(body: Body) -> Body:
    """The mirrored subject: a longer left leg becomes a longer right one."""
    order = np.argsort(MIRRORED[body.part_joint], kind="stable")
    low, high = body.limit_low_rad[MIRRORED], body.limit_high_rad[MIRRORED]
    return Body(
        offset_m=body.offset_m[MIRRORED] * FLIP_POINT,
        head_top_m=body.head_top_m * FLIP_POINT,
        palm_m=body.palm_m[SIDES_SWAPPED] * FLIP_POINT,
        fingertip_m=body.fingertip_m[SIDES_SWAPPED] * FLIP_POINT,
        sole_m=body.sole_m[SIDES_SWAPPED] * FLIP_POINT,
        part_joint=MIRRORED[body.part_joint][order],
        part_mass_kg=body.part_mass_kg[order],
        part_com_m=body.part_com_m[order] * FLIP_POINT,
        part_inertia_kgm2=body.part_inertia_kgm2[order] * np.multiply.outer(FLIP_POINT, FLIP_POINT),
        limit_low_rad=np.where(FLIPPED_LIMITS, -high, low),
        limit_high_rad=np.where(FLIPPED_LIMITS, -low, high),
    )


def mirror_clip(clip: Clip) -> Clip:
    """The mirrored clip: body, motion, contacts and the path of its loop."""
    pose = mirror_pose(clip.pose)
    planted = {"left": clip.report.planted["right"], "right": clip.report.planted["left"]}
    glitches = [
        {**glitch, "joints": [_other_side(name) for name in glitch["joints"]]} for glitch in clip.report.glitches
    ]
    return replace(
        clip,
        name=f"{clip.name} mirrored",
        pose=Pose(np.ascontiguousarray(pose.root_m), np.ascontiguousarray(pose.rotations)),
        body=mirror_body(clip.body),
        planted=np.ascontiguousarray(clip.planted[:, SIDES_SWAPPED]),
        loop=clip.loop._replace(y_m=-clip.loop.y_m, yaw_rad=-clip.loop.yaw_rad),
        report=replace(
            clip.report,
            name=f"{clip.name} mirrored",
            planted=planted,
            glitches=glitches,
            facing_deg=-clip.report.facing_deg,
        ),
        key=hashlib.sha256(f"mirrored {clip.key}".encode()).hexdigest(),
    )


def _other_side(joint: str) -> str:
    return JOINTS[MIRRORED[JOINTS.index(joint)]] if joint in JOINTS else joint
