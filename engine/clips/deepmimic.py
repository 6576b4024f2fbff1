"""Motions of DeepMimic's humanoid (Peng et al. 2018) as JSON: one row of 44 numbers a frame, Y up, metres.

A row is how long the frame lasts, then the root's place and orientation, then joint after joint a quaternion w x y z
local to its parent, or for knees and elbows one angle about the joint's Z. The file holds no skeleton: it is always the
same humanoid, which stands in its rest pose with its arms hanging, faces +X and has its left at -Z."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from engine.clips.tracks import Tracks
from engine.core.errors import BadInput
from engine.maths import rotations


class Joint(NamedTuple):
    """One joint of the humanoid: where it is in its parent's frame, and how many numbers of a row turn it."""

    name: str
    parent: str | None
    offset_m: tuple[float, float, float]
    numbers: int  # 4: a quaternion, 1: an angle about Z


# in the order of a row's numbers; wrists are never turned, but end the forearms
HUMANOID = (
    Joint("pelvis", None, (0.0, 0.0, 0.0), 4),
    Joint("chest", "pelvis", (0.0, 0.236151, 0.0), 4),
    Joint("head", "chest", (0.0, 0.223894, 0.0), 4),
    Joint("right_hip", "pelvis", (0.0, 0.0, 0.084887), 4),
    Joint("right_knee", "right_hip", (0.0, -0.421546, 0.0), 1),
    Joint("right_ankle", "right_knee", (0.0, -0.40987, 0.0), 4),
    Joint("right_upper_arm", "chest", (-0.02405, 0.2435, 0.18311), 4),
    Joint("right_elbow", "right_upper_arm", (0.0, -0.274788, 0.0), 1),
    Joint("left_hip", "pelvis", (0.0, 0.0, -0.084887), 4),
    Joint("left_knee", "left_hip", (0.0, -0.421546, 0.0), 1),
    Joint("left_ankle", "left_knee", (0.0, -0.40987, 0.0), 4),
    Joint("left_upper_arm", "chest", (-0.02405, 0.2435, -0.18311), 4),
    Joint("left_elbow", "left_upper_arm", (0.0, -0.274788, 0.0), 1),
    Joint("right_wrist", "right_elbow", (0.0, -0.258947, 0.0), 0),
    Joint("left_wrist", "left_elbow", (0.0, -0.258947, 0.0), 0),
)
ROW = 1 + 3 + sum(joint.numbers for joint in HUMANOID)
SHORTEST = 0.3  # a quaternion shorter than this says no direction
UNEVEN = 0.02  # frames whose lengths differ by more than this share of their median are no steady motion


def read_deepmimic(path: str | Path) -> Tracks:
    """One motion. BadInput names what was found and what was expected."""
    path = Path(path)
    rows = _rows(path)
    names = [joint.name for joint in HUMANOID]
    turns = np.zeros((len(rows), len(HUMANOID), 4))
    turns[..., 0] = 1.0
    at = 4
    for j, joint in enumerate(HUMANOID):
        numbers = rows[:, at : at + joint.numbers]
        at += joint.numbers
        if joint.numbers == 4:
            turns[:, j] = _unit(numbers, joint.name, path)
        elif joint.numbers == 1:
            turns[:, j] = rotations.from_axis_angle(np.array([0.0, 0.0, 1.0]), numbers[:, 0])
    parents = np.array([names.index(joint.parent) if joint.parent else -1 for joint in HUMANOID])
    offsets = np.array([joint.offset_m for joint in HUMANOID])
    return Tracks(
        "deepmimic", tuple(names), parents, offsets, rows[:, 1:4], turns, _rate(rows, path), scale_to_m=1.0, level=True
    )


def _bad(path: Path, found: str, expected: str) -> BadInput:
    return BadInput("deepmimic", f"found {found}, expected {expected}", str(path))


def _rows(path: Path) -> np.ndarray:
    """(F, 44) the frames."""
    try:
        said: Any = json.loads(path.read_bytes())
    except OSError as trouble:
        raise _bad(path, f"no readable file ({trouble.strerror})", "a motion") from None
    except ValueError as trouble:  # neither JSON nor text
        raise _bad(path, f"no JSON ({str(trouble)[:60]})", 'a motion {"Loop": ..., "Frames": [...]}') from None
    frames = said.get("Frames") if isinstance(said, dict) else None
    if not isinstance(frames, list) or not frames:
        raise _bad(path, 'no "Frames"', "a list of frames under that name")
    for number, frame in enumerate(frames):
        if not isinstance(frame, list) or len(frame) != ROW:
            found = f"{len(frame)} numbers" if isinstance(frame, list) else f"{str(frame)[:20]!r}"
            raise _bad(path, f"{found} in frame {number}", f"{ROW}")
    try:
        rows = np.array(frames, float)
    except (TypeError, ValueError):
        raise _bad(path, "something else than numbers in a frame", f"{ROW} numbers") from None
    if not np.isfinite(rows).all():
        frame = int(np.argwhere(~np.isfinite(rows))[0, 0])
        raise _bad(path, f"a number that is not finite in frame {frame}", "finite numbers")
    return rows


def _unit(quaternions: np.ndarray, name: str, path: Path) -> np.ndarray:
    """The rotations meant: between far keys these files hold plain means of quaternions, shorter than one."""
    shortest = float(np.linalg.norm(quaternions, axis=1).min())
    if shortest < SHORTEST:
        raise _bad(path, f"a quaternion of length {shortest:.3g} at {name}", "unit quaternions w x y z")
    return rotations.normalise(quaternions)


def _rate(rows: np.ndarray, path: Path) -> float:
    """Frames a second. The last frame's length says nothing: nothing follows it."""
    lasts_s = rows[:-1, 0] if len(rows) > 1 else rows[:, 0]
    usual_s = float(np.median(lasts_s))
    if not 0.001 <= usual_s <= 1.0 or np.abs(lasts_s - usual_s).max() > UNEVEN * usual_s:
        raise _bad(path, f"frames of {lasts_s.min():.4g} to {lasts_s.max():.4g} s", "one length from 0.001 to 1 s")
    # written with a rounded length, such as 0.016666 s
    return float(round(1.0 / usual_s, 2))
