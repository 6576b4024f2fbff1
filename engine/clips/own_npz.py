"""Our own motion archives (.npz), written and read: one character on the canonical skeleton, and all that was thrown.

World: right-handed, Z up, X ahead, Y left, metres; quaternions w x y z. F frames, 21 joints, P body parts, B balls.

| array | what |
|---|---|
| `schema` | "brace-motion 1" |
| `mocap_framerate`, `gender` | frames a second; "male" or "female": as in AMASS (Mahmood et al. 2019) |
| `joint_names` (21), `parents` (21) | the canonical joints, parents first, -1 for the pelvis |
| `offsets_m` (21, 3) | each joint in its parent's frame |
| `head_top_m` (3) | the crown, in the head's frame |
| `fingertip_m`, `toe_tip_m` (2, 3) | left and right, in the wrists' and toes' frames |
| `part_joint`, `part_mass_kg` (P), `part_com_m` (P, 3) | the body's masses, and where in the frames of which joints |
| `root_m` (F, 3), `rotations_wxyz` (F, 21, 4) | the motion: the pelvis in the world; rotations local to their parents |
| `joints_m` (F, 21, 3), `orientations_wxyz` (F, 21, 4) | the same in the world |
| `amass_joint_names` (22), `amass_joints_m` (F, 22, 3) | world joints by the names and in the order of AMASS's body |
| `time_s`, `phase` (F), `phase_names`, `planted` (F, 2) | when; what the character is about; which foot stands |
| `ball_radius_m`, `ball_mass_kg` (B), `ball_seen` (B, F) | what was thrown, and in which frames it is there |
| `ball_m` (B, F, 3), `ball_wxyz` (B, F, 4) | where it is and how it is turned |

AMASS has one joint in the spine that we lack: `spine2` is half way from waist to back. Its pose parameters are missing
on purpose: they are those of another body at rest in another pose.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from engine.body.kinematics import joints_of
from engine.body.skeleton import HEAD, JOINT_COUNT, JOINTS, PARENT, TOES, WRISTS, Body, Pose, joint_index
from engine.clips.tracks import Tracks
from engine.core.errors import BadInput
from engine.maths import rotations

SCHEMA = "brace-motion 1"

AMASS_JOINTS = {
    "pelvis": "pelvis", "left_hip": "left_hip", "right_hip": "right_hip", "spine1": "waist",
    "left_knee": "left_knee", "right_knee": "right_knee", "spine2": ("waist", "back"),
    "left_ankle": "left_ankle", "right_ankle": "right_ankle", "spine3": "back",
    "left_foot": "left_toe", "right_foot": "right_toe", "neck": "neck",
    "left_collar": "left_clavicle", "right_collar": "right_clavicle", "head": "head",
    "left_shoulder": "left_shoulder", "right_shoulder": "right_shoulder",
    "left_elbow": "left_elbow", "right_elbow": "right_elbow", "left_wrist": "left_wrist", "right_wrist": "right_wrist",
}  # fmt: skip


def motion_arrays(body: Body, pose: Pose, fps: float, sex: str) -> dict[str, np.ndarray]:
    """The arrays of the table above that a motion alone gives; the caller adds those of its run."""
    positions, orientations = joints_of(body, pose)
    return {
        "schema": np.array(SCHEMA),
        "mocap_framerate": np.array(float(fps)),
        "gender": np.array(sex),
        "joint_names": np.array(JOINTS),
        "parents": PARENT.astype(np.int64),
        "offsets_m": body.offset_m,
        "head_top_m": body.head_top_m,
        "fingertip_m": body.fingertip_m,
        "toe_tip_m": body.sole_m[:, 4:].mean(axis=1),
        "part_joint": body.part_joint.astype(np.int64),
        "part_mass_kg": body.part_mass_kg,
        "part_com_m": body.part_com_m,
        "root_m": pose.root_m,
        "rotations_wxyz": pose.rotations,
        "joints_m": positions,
        "orientations_wxyz": orientations,
        "amass_joint_names": np.array(list(AMASS_JOINTS)),
        "amass_joints_m": amass_joints_m(positions),
    }


def amass_joints_m(positions: np.ndarray) -> np.ndarray:
    """World joints (..., 22, 3) in AMASS's order from ours (..., 21, 3)."""
    named = [(ours,) if isinstance(ours, str) else ours for ours in AMASS_JOINTS.values()]
    rows = [[joint_index(name) for name in names] for names in named]
    return np.stack([positions[..., row, :].mean(axis=-2) for row in rows], axis=-2)


def npz_bytes(arrays: Mapping[str, np.ndarray]) -> bytes:
    """A compressed archive; the same arrays give the same bytes, since numpy writes no dates."""
    whole = io.BytesIO()
    np.savez_compressed(whole, allow_pickle=False, **dict(arrays))
    return whole.getvalue()


def is_own(path: Path) -> bool:
    """Whether an archive says that it is one of these. A file that is none at all is for others to complain about."""
    try:
        with zipfile.ZipFile(path) as archive:
            return "schema.npy" in archive.namelist()
    except (OSError, zipfile.BadZipFile):
        return False


def read_own_npz(path: Path) -> Tracks:
    """The motion of one archive. BadInput names the array, what was found and what was expected."""
    try:
        with np.load(path, allow_pickle=False) as archive:
            schema = str(archive["schema"])
            if schema != SCHEMA:
                raise _bad(path, f"schema {schema[:40]!r}", repr(SCHEMA))
            fps = float(_array(archive, path, "mocap_framerate", ()))
            offsets = _array(archive, path, "offsets_m", (JOINT_COUNT, 3))
            root = _array(archive, path, "root_m", (None, 3))
            turns = _array(archive, path, "rotations_wxyz", (len(root), JOINT_COUNT, 4))
            tips = _tips(archive, path)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as trouble:
        raise _bad(path, f"no readable npz archive ({str(trouble)[:60]})", "one written by brace export") from None
    if not 1.0 <= fps <= 1000.0:
        raise _bad(path, f"mocap_framerate {fps:g}", "1 to 1000")
    off = np.abs(np.linalg.norm(turns, axis=-1) - 1.0).max()
    if off > 0.01:
        raise _bad(path, f"quaternions whose length is off by {off:.3g}", "unit quaternions w x y z")
    turns, scale = rotations.normalise(turns), 1.0
    return Tracks("npz", JOINTS, PARENT.copy(), offsets, root, turns, fps, tips, scale, captured=False)


def _tips(archive, path: Path) -> dict[int, np.ndarray]:
    tips = {HEAD: _array(archive, path, "head_top_m", (3,))}
    for name, joints in (("fingertip_m", WRISTS), ("toe_tip_m", TOES)):
        tips |= dict(zip(joints, _array(archive, path, name, (2, 3)), strict=True))
    return tips


def _array(archive, path: Path, name: str, shape: tuple[int | None, ...]) -> np.ndarray:
    """One array of finite numbers of that shape; None is any length but zero."""
    if name not in archive:
        raise _bad(path, f"no array {name!r}", f"those of {SCHEMA!r}")
    array = archive[name]
    fits = array.ndim == len(shape) and all(
        found == wanted or (wanted is None and found > 0) for found, wanted in zip(array.shape, shape, strict=True)
    )
    if not fits or array.dtype.kind not in "fiu":
        wanted = ", ".join("frames" if length is None else str(length) for length in shape)
        raise _bad(path, f"{name} of shape {array.shape}", f"({wanted}) numbers")
    if not np.isfinite(array).all():
        raise _bad(path, f"{name} with values that are not finite", "finite numbers")
    return array.astype(float)


def _bad(path: Path, found: str, expected: str) -> BadInput:
    return BadInput("npz", f"found {found}, expected {expected}", str(path))
