"""Measures of a run, from what an Observer has kept: the figures that `brace react` reports and `brace bench
--motion` sums up.
"""

from __future__ import annotations

import numpy as np

from behaviours.components import Phase
from behaviours.observing import Line, Track
from behaviours.overlap import overlaps_m, pair_name
from engine.body import support
from engine.body.kinematics import com_of, joints_of
from engine.body.limits import excess_rad
from engine.body.skeleton import WRISTS, Pose

GRAVITY = 9.80665
PHYSICS_HZ = 480.0
HIC_WINDOW_S = 0.015
OWN = (
    Phase.STARTLE,
    Phase.PROTECT,
    Phase.HOLD,
    Phase.RECOVER_BLEND,
    Phase.RECOVER_RETURN,
)  # ours, outside the physics alone


def ours(track: Track) -> np.ndarray:
    """(T,) bool: the ticks of protection and recovery."""
    return np.isin(track.phase, OWN)


def foot_slide_max_m(track: Track) -> float:
    """The farthest that any foot goes, along or off the ground, while it is flagged planted without a break."""
    positions, orientations = joints_of(track.body, track.pose)
    planted, worst = np.array(track.planted) & ours(track)[:, None], 0.0
    for side in range(2):
        for first, last in runs(planted[:, side]):
            soles = np.array(
                [support.sole_points(track.body, positions[k], orientations[k])[side] for k in range(first, last + 1)]
            )
            worst = max(worst, float(np.linalg.norm(soles - soles[0], axis=-1).max()))
    return worst


def runs(flags: np.ndarray) -> list[tuple[int, int]]:
    """First and last index of every stretch of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(flags, int), [0]])))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def distance_from_line(points_m: np.ndarray, start_m: np.ndarray, end_m: np.ndarray) -> np.ndarray:
    """(N,) how far points (N, 3) are from a straight line, from its start on: a damped overshoot goes on beyond its
    end.
    """
    axis = end_m - start_m
    square = float((axis * axis).sum())
    t = (
        np.maximum(((points_m - start_m) * axis).sum(axis=1) / square, 0.0)
        if square > 1e-12
        else np.zeros(len(points_m))
    )
    return np.linalg.norm(points_m - (start_m + t[:, None] * axis), axis=1)


def hand_line_deviation_max_m(lines: list[Line]) -> float:
    """How far a blend's source takes a wrist off the straight line between its two ends (thesis 4.3), where nothing
    is in the way.
    """
    return max(
        (
            float(distance_from_line(line.between_m[None, w], line.start_m[w], line.end_m[w])[0])
            for line in lines
            for side, w in enumerate(WRISTS)
            if line.on_line[side]
        ),
        default=0.0,
    )


def com_line_deviation_max_m(lines: list[Line]) -> float:
    """How far a blend's source takes the COM off the straight line between its two ends."""
    return max((float(distance_from_line(line.com_m[None], *line.com_ends_m)[0]) for line in lines), default=0.0)


def com_margin_min_m(track: Track) -> float | None:
    """The least margin of the COM inside the planted feet's polygon in protection and recovery; None without any."""
    positions, orientations = joints_of(track.body, track.pose)
    com, least = com_of(track.body, track.pose), None
    for k in np.flatnonzero(ours(track)):
        if track.planted[k].any():
            polygon = support.polygon_of(track.body, positions[k], orientations[k], track.planted[k])
            margin = float(support.margin_m(polygon, com[k, :2]))
            least = margin if least is None else min(least, margin)
    return least


def joint_limit_excess_max_rad(track: Track, clip_excess_rad: np.ndarray) -> float:
    """How far any joint goes beyond its limit and beyond what the clip itself (J,) oversteps it by, outside the
    physics.
    """
    chosen = ours(track)
    if not chosen.any():
        return 0.0
    over = excess_rad(track.body, np.array(track.rotations)[chosen]) - clip_excess_rad
    return float(max(0.0, over.max()))


def overlap_max_m(track: Track, clip_overlap_m: np.ndarray) -> tuple[float, str]:
    """How deep a hand or forearm is inside head, trunk or the other arm beyond what the clip itself (P,) has; and
    which.
    """
    chosen = ours(track)
    if not chosen.any():
        return 0.0, ""
    pose = Pose(*(part[chosen] for part in track.pose))
    over = (overlaps_m(track.body, pose) - np.maximum(clip_overlap_m, 0.0)).max(axis=0)
    return float(max(0.0, over.max())), pair_name(int(over.argmax()))


def seam_jumps(track: Track) -> tuple[float, float]:
    """The greatest jump of any joint at any seam: metres, and m/s between the one-sided velocities. Impulses are no
    seams.
    """
    if not track.seams:
        return 0.0, 0.0
    place = max(float(np.linalg.norm(s.taken_up_m - s.shown_m, axis=1).max()) for s in track.seams)
    speed = max(float(np.linalg.norm(s.after_mps - s.before_mps, axis=1).max()) for s in track.seams)
    return place, speed


def head_acceleration_g(track: Track) -> np.ndarray:
    """(S,) magnitude of the head's acceleration at the physics' own rate, in g, over all stretches under physics."""
    out = []
    for first, last in runs(np.array([len(v) > 0 for v in track.head_mps])):
        velocity = np.concatenate(track.head_mps[first : last + 1])
        out.append(np.linalg.norm(np.diff(velocity, axis=0), axis=1) * PHYSICS_HZ / GRAVITY)
    return np.concatenate(out) if out else np.zeros(0)


def hic15(acceleration_g: np.ndarray) -> float:
    """Head injury criterion over at most 15 ms: max of (mean a)^2.5 (t2 - t1), a in g, time in seconds (Versace
    1971).
    """
    total = np.concatenate([[0.0], np.cumsum(acceleration_g)]) / PHYSICS_HZ
    best = 0.0
    for steps in range(1, int(HIC_WINDOW_S * PHYSICS_HZ) + 1):
        if steps < len(total):
            window_s = steps / PHYSICS_HZ
            best = max(best, float((((total[steps:] - total[:-steps]) / window_s) ** 2.5).max()) * window_s)
    return best
