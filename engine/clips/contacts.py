"""When a foot stands on the floor.

A foot is planted while its ball or its ankle is near the level at which that foot stands and hardly moves. The ball
alone would miss the heel strike, the ankle alone the push-off."""

from __future__ import annotations

import numpy as np

BALL_NEAR_M, ANKLE_NEAR_M = 0.055, 0.045
SLOW_MPS = 0.55
# a runner's foot is never quite at rest: it counts as slow below this share of the body's own speed
SLOW_SHARE_OF_TRAVEL = 0.25
SHORTEST_PLANT_S, SHORTEST_STEP_S = 0.05, 0.05


def speeds(points_m: np.ndarray, fps: float) -> np.ndarray:
    """(F, ..., 3) -> (F, ...) metres a second, from the difference across about a thirtieth of a second around each
    frame."""
    reach = max(1, round(fps / 60.0))
    frames = np.arange(len(points_m))
    after, before = np.minimum(frames + reach, len(points_m) - 1), np.maximum(frames - reach, 0)
    span_s = np.maximum(after - before, 1) / fps
    moved = np.linalg.norm(points_m[after] - points_m[before], axis=-1)
    return moved / span_s.reshape(-1, *[1] * (moved.ndim - 1))


def slow_limit(pelvis_m: np.ndarray, fps: float) -> np.ndarray:
    """(F, 3) -> (F,) the speed in metres a second under which a foot counts as standing."""
    half_s = max(1, round(0.25 * fps))
    frames = np.arange(len(pelvis_m))
    after, before = np.minimum(frames + half_s, len(pelvis_m) - 1), np.maximum(frames - half_s, 0)
    travelled = np.linalg.norm((pelvis_m[after] - pelvis_m[before])[:, :2], axis=-1)
    return np.maximum(SLOW_MPS, SLOW_SHARE_OF_TRAVEL * travelled * fps / np.maximum(after - before, 1))


def planted(ball_m: np.ndarray, ankle_m: np.ndarray, pelvis_m: np.ndarray, fps: float) -> np.ndarray:
    """Which foot stands: (F, 2) bool from balls and ankles (F, 2, 3) and the pelvis (F, 3), heights counted from the
    levels at which that ball and that ankle are when their foot stands flat."""
    limit = slow_limit(pelvis_m, fps)[:, None]
    by_ball = (ball_m[..., 2] < BALL_NEAR_M) & (speeds(ball_m, fps) < limit)
    by_ankle = (ankle_m[..., 2] < ANKLE_NEAR_M) & (speeds(ankle_m, fps) < limit)
    stands = by_ball | by_ankle
    for side in (0, 1):
        stands[:, side] = without_short(stands[:, side], False, SHORTEST_STEP_S * fps)
        stands[:, side] = without_short(stands[:, side], True, SHORTEST_PLANT_S * fps)
    return stands


def runs(flags: np.ndarray) -> list[tuple[int, int]]:
    """The first and last frame of every unbroken stretch of True in (F,)."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return [(int(first), int(after) - 1) for first, after in zip(edges[::2], edges[1::2], strict=True)]


def without_short(flags: np.ndarray, value: bool, frames: float) -> np.ndarray:
    """(F,) with stretches of `value` shorter than `frames` turned over, except at the ends of the clip, where they may
    go on."""
    out = flags.copy()
    for first, last in runs(flags == value):
        if last - first + 1 < frames and first > 0 and last < len(flags) - 1:
            out[first : last + 1] = not value
    return out
