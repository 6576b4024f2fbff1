"""What a motion file says, before anyone has asked what it means: a tree of named joints and how each turned in every
frame.

Readers (bvh, acclaim, npz) end file conventions here: radians, quaternions, one tree. What stays the file's own is its
length unit and its axes, which `engine.clips.mapping` finds out from the figure itself.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from engine.core.errors import BadInput
from engine.maths import rotations


@dataclass(frozen=True)
class Tracks:
    """One motion as its file tells it. J source joints, parents before children; F frames."""

    format: str  # "bvh", "asf/amc" or "npz"
    names: tuple[str, ...]
    parents: np.ndarray  # (J,) row of the parent, -1 for the root, which is row 0
    offsets: np.ndarray  # (J, 3) each joint in its parent's frame in the rest pose, file units and axes
    root: np.ndarray  # (F, 3) the root in the world, file units and axes
    rotations: np.ndarray  # (F, J, 4) w x y z, local to parent; all identities are the rest pose
    fps: float
    # joint row -> (3,) where its last bone ends, in its frame
    tips: dict[int, np.ndarray] = field(default_factory=dict)
    scale_to_m: float | None = None  # metres for one file unit, where the format says so
    captured: bool = True  # a motion of ours is not: it has no glitches to mend
    level: bool = False  # the format promises a level floor, and that motion and rest pose share their up axis
    notes: tuple[str, ...] = ()  # what the reader had to decide, in plain words


def world_of(tracks: Tracks) -> tuple[np.ndarray, np.ndarray]:
    """Where every source joint is and how it is turned, in the file's own units and axes: (F, J, 3) and (F, J, 4)."""
    positions = np.empty((len(tracks.root), len(tracks.names), 3))
    orientations = np.empty((len(tracks.root), len(tracks.names), 4))
    for joint, parent in enumerate(tracks.parents):
        if parent < 0:
            positions[:, joint], orientations[:, joint] = tracks.root, tracks.rotations[:, joint]
            continue
        turned = rotations.rotate(orientations[:, parent], tracks.offsets[joint])
        positions[:, joint] = positions[:, parent] + turned
        orientations[:, joint] = rotations.multiply(orientations[:, parent], tracks.rotations[:, joint])
    return positions, orientations


def rest_positions(tracks: Tracks) -> np.ndarray:
    """(J, 3) the joints in the rest pose with the root at the origin, file units and axes."""
    rest = np.zeros((len(tracks.names), 3))
    for joint, parent in enumerate(tracks.parents):
        if parent >= 0:
            rest[joint] = rest[parent] + tracks.offsets[joint]
    return rest


def ancestors(tracks: Tracks, joint: int) -> list[int]:
    """The rows from a joint to the root, the joint first."""
    path = []
    while joint >= 0:
        path.append(joint)
        joint = int(tracks.parents[joint])
    return path


def read_lines(path: Path) -> list[str]:
    """The lines of a text file whatever ends them (LF, CRLF, CR, or a mixture). BadInput if it is no text or not
    there."""
    try:
        raw = path.read_bytes()
    except OSError as trouble:
        raise BadInput(
            "clip-unreadable", f"found no readable file ({trouble.strerror}), expected a clip", str(path)
        ) from None
    if b"\0" in raw:
        raise BadInput("clip-not-text", "found binary data, expected a text file", str(path))
    text = raw.decode("utf-8-sig", errors="replace")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if not text.strip():
        raise BadInput("clip-empty", "found an empty file, expected a clip", str(path))
    return lines


def numbers(tokens: list[str], where: str) -> list[float]:
    """Finite numbers from words. BadInput names the first word that is none."""
    try:
        row = [float(token) for token in tokens]
    except ValueError:
        bad = next(token for token in tokens if not _is_number(token))
        raise BadInput("clip-number", f"found {bad[:40]!r}, expected a number", where) from None
    # inf - inf and nan are the only ways for this to differ from zero
    if sum(row) - sum(row) != 0.0:
        bad = next(token for token in tokens if not np.isfinite(float(token)))
        raise BadInput("clip-number", f"found {bad[:40]!r}, expected a finite number", where)
    return row


def _is_number(token: str) -> bool:
    try:
        float(token)
    except ValueError:
        return False
    return True
