"""Humanoid motions as numpy archives (.npz): the position and rotation of each of fifteen bodies in the world, Z up,
metres. Archives that we wrote ourselves hold our own joints and are told by their schema: `engine.clips.own_npz`.

The bodies are those of the humanoid of DeepMimic (Peng et al. 2018): every body frame is parallel to the world when the
figure stands with its arms hanging, facing +X. The files store no tree and no joint offsets; both follow from the
bodies."""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np

from engine.clips.own_npz import is_own, read_own_npz
from engine.clips.tracks import Tracks
from engine.core.errors import BadInput
from engine.maths import rotations

PARENT_OF: dict[str, str] = {
    "torso": "pelvis", "head": "torso",
    "right_upper_arm": "torso", "right_lower_arm": "right_upper_arm", "right_hand": "right_lower_arm",
    "left_upper_arm": "torso", "left_lower_arm": "left_upper_arm", "left_hand": "left_lower_arm",
    "right_thigh": "pelvis", "right_shin": "right_thigh", "right_foot": "right_shin",
    "left_thigh": "pelvis", "left_shin": "left_thigh", "left_foot": "left_shin",
}  # fmt: skip
ROOT = "pelvis"
NEEDED = ("fps", "body_names", "body_positions", "body_rotations")


def read_npz(path: str | Path) -> Tracks:
    """The bodies of one archive as a tree of joints. BadInput names the array, what was found and what was expected."""
    path = Path(path)
    if is_own(path):
        return read_own_npz(path)
    arrays = _load(path)
    names = _body_names(arrays, path)
    positions, turns = _bodies(arrays, names, path)
    positions, turns, fps, notes = _without_repeats(positions, turns, _rate(arrays, path))
    parents = np.array([names.index(PARENT_OF[name]) if name != ROOT else -1 for name in names])
    offsets, locals_ = np.zeros((len(names), 3)), turns.copy()
    for row, parent in enumerate(parents):
        if parent >= 0:
            # the stored figures are rounded; the median over the frames is the bone
            offsets[row] = np.median(
                rotations.unrotate(turns[:, parent], positions[:, row] - positions[:, parent]), axis=0
            )
            locals_[:, row] = rotations.multiply(rotations.conjugate(turns[:, parent]), turns[:, row])
    return Tracks("npz", tuple(names), parents, offsets, positions[:, 0], locals_, fps, scale_to_m=1.0, notes=notes)


def _bad(path: Path, found: str, expected: str) -> BadInput:
    return BadInput("npz", f"found {found}, expected {expected}", str(path))


def _load(path: Path) -> dict[str, np.ndarray]:
    try:
        with open(path, "rb") as file:
            archive = np.load(file, allow_pickle=False)
            if not isinstance(archive, np.lib.npyio.NpzFile):
                raise _bad(path, "a single array", "an archive of several")
            missing = [name for name in NEEDED if name not in archive]
            if missing:
                raise _bad(path, f"no array {missing[0]!r}", f"a motion with {', '.join(NEEDED)}")
            return {name: archive[name] for name in NEEDED}
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as trouble:
        raise _bad(path, f"no readable npz archive ({str(trouble)[:60]})", "a motion saved by numpy") from None


def _rate(arrays: dict[str, np.ndarray], path: Path) -> float:
    fps = arrays["fps"]
    if fps.size != 1 or fps.dtype.kind not in "iuf" or not 1.0 <= float(fps.reshape(())) <= 1000.0:
        raise _bad(path, f"fps {fps!r}", "one number from 1 to 1000")
    return float(fps.reshape(()))


def _body_names(arrays: dict[str, np.ndarray], path: Path) -> list[str]:
    """The names in file order, which must have the pelvis first and parents before children."""
    names = [str(name) for name in arrays["body_names"].reshape(-1)]
    wanted = [ROOT, *PARENT_OF]
    if sorted(names) != sorted(wanted):
        odd = sorted(set(names) ^ set(wanted)) or ["a name twice"]
        raise _bad(path, f"body_names that differ by {', '.join(odd)}", f"{len(wanted)}: {', '.join(wanted)}")
    for row, name in enumerate(names):
        if name != ROOT and names.index(PARENT_OF[name]) > row:
            raise _bad(path, f"{name!r} before {PARENT_OF[name]!r}", "parents first")
    return names


def _bodies(arrays: dict[str, np.ndarray], names: list[str], path: Path) -> tuple[np.ndarray, np.ndarray]:
    positions, turns = arrays["body_positions"], arrays["body_rotations"]
    frames = len(positions) if positions.ndim else 0
    for label, array, width in (("body_positions", positions, 3), ("body_rotations", turns, 4)):
        if frames == 0 or array.shape != (frames, len(names), width) or array.dtype.kind not in "fiu":
            raise _bad(
                path, f"{label} of shape {array.shape}", f"({frames or 'frames'}, {len(names)}, {width}) numbers"
            )
        if not np.isfinite(array).all():
            frame, body = np.argwhere(~np.isfinite(array))[0][:2]
            raise _bad(path, f"{label} not finite in frame {frame} at {names[body]!r}", "finite numbers")
    off = np.abs(np.linalg.norm(turns, axis=-1) - 1.0).max()
    if off > 0.01:
        raise _bad(path, f"quaternions whose length is off by {off:.3g}", "unit quaternions w x y z")
    return positions.astype(float), rotations.normalise(turns)


def _without_repeats(
    positions: np.ndarray, turns: np.ndarray, fps: float
) -> tuple[np.ndarray, np.ndarray, float, tuple[str, ...]]:
    """A motion brought to a higher rate by storing every frame n times would move in jerks: one of each is kept, at fps
    / n."""
    same = (np.abs(np.diff(positions, axis=0)).max(axis=(1, 2)) < 1e-7) & (
        np.abs(np.diff(turns, axis=0)).max(axis=(1, 2)) < 1e-7
    )
    for times in (4, 3, 2):
        repeats = np.arange(1, len(positions)) % times != 0
        if len(positions) >= 4 * times and same[repeats].all() and not same.all():
            note = f"every frame is stored {times} times at {fps:g} fps; read as {fps / times:g} fps"
            return positions[::times], turns[::times], fps / times, (note,)
    return positions, turns, fps, ()
