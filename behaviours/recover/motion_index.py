"""The clip library made searchable: where every joint is and how it moves, at every sixtieth of a second of every clip.

Zordan et al. (2005) compare a window of the simulation with every window of a library: joint positions and velocities,
weighted by the mass of the body parts. Here is what that needs of the library's side, as plain arrays; the comparison
itself is in `behaviours.recover.search`. An index belongs to one body: its clips have been moved onto it before.
"""

from __future__ import annotations

import contextlib
import hashlib
import zipfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from behaviours.components import SAMPLES, STRIDE_TICKS
from behaviours.recover.windows import FEATURES, features_of_all, joint_shares
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_into
from engine.body.skeleton import HEAD, HIPS, JOINT_COUNT, Body
from engine.clips.cache import cache_folder, write_whole
from engine.clips.clip import Clip
from engine.clips.playback import planted_at, sample_into
from engine.clips.retarget import legs_m
from engine.maths.kernel import njit

LYING, RISEN = 0.4, 0.9  # height of the hips in shares of the leg


@dataclass(frozen=True, eq=False)
class MotionIndex:
    """N moments of some clips, in the order of clips and time. A window ends at a moment; it is named by that row."""

    key: str  # of all that it was made from
    clip: np.ndarray  # (N,) number of the clip
    time_s: np.ndarray  # (N,) clip time
    joints_m: np.ndarray  # (N, J, 3) in the clip's own frame, floor at zero
    joints_mps: np.ndarray  # (N, J, 3)
    standing: np.ndarray  # (N,) a window that can be entered on a foot that stands, with motion left to play
    rising: np.ndarray  # (N,) lies, and will stand: the start of a get-up
    share: np.ndarray  # (J,) each joint's share of the body's mass
    trees: dict[str, Prefilter] = field(repr=False)


@dataclass(frozen=True, eq=False)
class Prefilter:
    """The k-d tree over the rows of one kind."""

    rows: np.ndarray
    tree: cKDTree | None  # None: there are no such rows


def index_clips(
    clips: tuple[Clip, ...], body: Body, ahead_s: float, least_left_s: float, velocity_s: float
) -> MotionIndex:
    """The index of clips that all have this body; from the cache if the same was built before.

    ahead_s: how far after its window a motion is entered. least_left_s: of a clip that does not go round, after that.
    velocity_s: how a velocity counts beside a place, as in `windows.difference`.
    """
    share = joint_shares(body)
    key = _key(clips, ahead_s, least_left_s)
    arrays = _load(key) or _build(clips, body, ahead_s, least_left_s)
    _save(key, arrays)
    features = np.empty((len(arrays["clip"]), FEATURES))
    features_of_all(arrays["joints_m"], arrays["joints_mps"], share, velocity_s, features)
    trees = {kind: _prefilter(features, arrays[kind]) for kind in ("standing", "rising")}
    return MotionIndex(key, share=share, trees=trees, **arrays)


def _prefilter(features: np.ndarray, wanted: np.ndarray) -> Prefilter:
    rows = np.flatnonzero(wanted)
    return Prefilter(rows, cKDTree(features[rows]) if len(rows) else None)


def _build(clips: tuple[Clip, ...], body: Body, ahead_s: float, least_left_s: float) -> dict[str, np.ndarray]:
    """The arrays of an index, by the names of their fields."""
    legs = legs_m(body)
    parts = [_moments(clip, legs, ahead_s, least_left_s) for clip in clips]
    arrays = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    arrays["clip"] = np.repeat(np.arange(len(clips)), [len(part["time_s"]) for part in parts])
    return arrays


def _moments(clip: Clip, legs: float, ahead_s: float, least_left_s: float) -> dict[str, np.ndarray]:
    """The moments of one clip that have a whole window before them."""
    first = (SAMPLES - 1) * STRIDE_TICKS + 1
    ticks = np.arange(1, int(clip.duration_s / TICK_S) + 1, STRIDE_TICKS)
    time_s = ticks * TICK_S
    joints_m, before_m = np.empty((2, len(ticks), JOINT_COUNT, 3))
    joints_over_time(clip, time_s, joints_m)
    joints_over_time(clip, time_s - TICK_S, before_m)
    hips = joints_m[:, list(HIPS), 2].mean(axis=1) / legs
    whole = ticks >= first
    left = np.full(len(ticks), True) if clip.loops else time_s + ahead_s + least_left_s <= clip.duration_s
    stands = np.array([planted_at(clip, t).any() and planted_at(clip, t + ahead_s).any() for t in time_s], bool)
    # the highest that the hips will yet come
    to_come = np.maximum.accumulate(hips[::-1])[::-1] if len(hips) else hips
    lies = (hips < LYING) & (joints_m[:, HEAD, 2] < LYING * legs)
    return {
        "time_s": time_s,
        "joints_m": joints_m,
        "joints_mps": (joints_m - before_m) / TICK_S,
        "standing": whole & left & stands & ~lies,
        "rising": whole & lies & (to_come > RISEN),
    }


def joints_over_time(clip: Clip, time_s: np.ndarray, joints_m: np.ndarray) -> None:
    """Writes where the joints are at these clip times: (N, J, 3)."""
    pose = clip.pose
    _joints_over_time(pose.root_m, pose.rotations, clip.fps, clip.loop, clip.body.offset_m, time_s, joints_m)


@njit(cache=True)
def _joints_over_time(root_m, rotations, fps, loop, offset_m, time_s, joints_m):
    at, local, turned = np.empty(3), np.empty((JOINT_COUNT, 4)), np.empty((JOINT_COUNT, 4))
    for n in range(len(time_s)):
        sample_into(root_m, rotations, fps, loop, time_s[n], at, local)
        joints_into(offset_m, at, local, joints_m[n], turned)


def _key(clips: tuple[Clip, ...], ahead_s: float, least_left_s: float) -> str:
    """A name for what an index is made from: the clips in their order (bodies and all), what decides, and this code."""
    content = hashlib.sha256(f"{ahead_s!r} {least_left_s!r}".encode())
    content.update(Path(__file__).read_bytes())
    for clip in clips:
        content.update(clip.key.encode())
    return content.hexdigest()


def _path(key: str) -> Path:
    return cache_folder() / "indexed" / f"{key[:40]}.npz"


def _load(key: str) -> dict[str, np.ndarray] | None:
    """What was built before under this key; None if it is not there, or cannot be read."""
    try:
        with open(_path(key), "rb") as file:
            arrays = np.load(file, allow_pickle=False)
            return {name: arrays[name] for name in arrays.files}
    except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile):
        return None


def _save(key: str, arrays: dict[str, Any]) -> None:
    """Keeps it. A cache that cannot be written is no fault."""
    path = _path(key)
    if path.is_file():
        return
    with contextlib.suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, lambda file: np.savez(file, **arrays))
