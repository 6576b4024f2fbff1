"""A file's length unit and axes, found out from the figure itself: no motion file says reliably which way is up or how
long a unit is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.clips.rig import Rig
from engine.clips.tracks import Tracks, rest_positions
from engine.maths import rotations

# metres for one unit: metre, decimetre, centimetre, millimetre, inch, foot, and the CMU database's 1/0.45 inch
UNITS_M = (1.0, 0.1, 0.01, 0.001, 0.0254, 0.3048, 0.0254 / 0.45)
USUAL_LEG_M, SHORTEST_LEG_M, LONGEST_LEG_M = 0.83, 0.45, 1.15


@dataclass(frozen=True)
class Axes:
    """How to turn the file's coordinates into ours (Z up, metres; in the rest pose X ahead and Y to the left)."""

    scale_to_m: float
    up: str  # the file's own up axis, such as "+Y"
    world_from_file: np.ndarray  # (4,) for the motion
    rest_from_file: np.ndarray  # (4,) for the rest pose
    notes: tuple[str, ...]


def find_axes(tracks: Tracks, rig: Rig) -> Axes:
    """Scale from the length of the legs; up from the rest pose and, where they disagree, from the motion; ahead from
    the hips."""
    rest = rest_positions(tracks)
    leg = leg_length(rest, rig)
    scale, notes = _scale(leg, tracks.scale_to_m)
    feet, trunk = rest[list(rig.ankle)].mean(axis=0), rest[rig.spine[-1]]
    up = _nearest_axis(trunk - feet)
    left = rest[rig.hip[0]] - rest[rig.hip[1]]
    left = _nearest_axis(left - up * np.sum(left * up))
    rest_from_file = _from_up_and_left(up, left)
    # someone who crawls or lies all through would else be taken for a turned file
    world_up = up if tracks.level else _world_up(tracks, rig, up)
    if np.array_equal(world_up, up):
        world_from_file = rest_from_file
    else:
        world_from_file = _from_up_and_left(world_up, _nearest_axis(np.cross(world_up, np.roll(np.abs(world_up), 1))))
        notes = (*notes, "the rest pose and the motion have different up axes")
    return Axes(scale, _axis_name(world_up), world_from_file, rest_from_file, notes)


def leg_length(rest: np.ndarray, rig: Rig) -> float:
    """Hip to knee to ankle, the mean of both legs, file units."""
    bones = [(rig.hip[s], rig.knee[s]) for s in (0, 1)] + [(rig.knee[s], rig.ankle[s]) for s in (0, 1)]
    return float(sum(np.linalg.norm(rest[b] - rest[a]) for a, b in bones) / 2.0)


def _scale(leg: float, told: float | None) -> tuple[float, tuple[str, ...]]:
    """The unit that the format names, if it gives a human leg; else the usual unit that comes nearest; else the leg is
    made usual."""
    if told is not None and SHORTEST_LEG_M < leg * told < LONGEST_LEG_M:
        return told, ()
    unit = min(UNITS_M, key=lambda u: abs(np.log(max(leg, 1e-9) * u / USUAL_LEG_M)))
    if SHORTEST_LEG_M < leg * unit < LONGEST_LEG_M:
        return unit, ()
    return USUAL_LEG_M / leg, (f"no known unit makes a leg of {leg:.3g} human; scaled to {USUAL_LEG_M} m",)


def _nearest_axis(v: np.ndarray) -> np.ndarray:
    axis = np.zeros(3)
    k = int(np.argmax(np.abs(v)))
    axis[k] = 1.0 if v[k] >= 0.0 else -1.0
    return axis


def _axis_name(axis: np.ndarray) -> str:
    k = int(np.argmax(np.abs(axis)))
    return ("+" if axis[k] > 0 else "-") + "XYZ"[k]


def _from_up_and_left(up: np.ndarray, left: np.ndarray) -> np.ndarray:
    """The rotation (4,) that takes up to Z and left to Y."""
    return rotations.from_matrix(np.stack([np.cross(left, up), left, up]))


def _world_up(tracks: Tracks, rig: Rig, rest_up: np.ndarray) -> np.ndarray:
    """The rest pose's up, unless the trunk spends the clip along another axis: then the file was turned at its root."""
    carried = tracks.rotations[:, 0]
    for row in [*_path(tracks, rig.pelvis)]:
        carried = rotations.multiply(carried, tracks.rotations[:, row])
    usual = rotations.rotate(carried, rest_up).mean(axis=0)
    return rest_up if np.sum(usual * rest_up) > 0.35 or np.abs(usual).max() < 0.7 else _nearest_axis(usual)


def _path(tracks: Tracks, row: int) -> list[int]:
    """The rows below the root down to `row`."""
    path: list[int] = []
    while tracks.parents[row] >= 0:
        path.insert(0, row)
        row = int(tracks.parents[row])
    return path
