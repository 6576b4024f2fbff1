"""Where the floor is under a clip: a plane through the places where its feet stood.

Captured floors are not level: over a straight walk of four metres they climb by up to six centimetres, because the
capture volume was tilted. One tilted plane for the clip explains that, and taking it out turns the whole motion
rigidly, so that a planted foot stays planted. Left and right foot may stand at different levels (their marker models
differ by up to two centimetres): each foot gets its own."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.clips.contacts import BALL_NEAR_M, planted, slow_limit, speeds
from engine.maths import rotations

WINDOW_S = 1.0
ROUNDS = 4
# how far the footprints must be spread before their heights say much about a slope, and the greatest slope believed
SPREAD_M, STEEPEST = 0.25, 0.05
# more than the levels of two standing feet differ by
FEET_APART_M = 0.03
UP = np.array([0.0, 0.0, 1.0])


class Floor(NamedTuple):
    """The plane z = level + slope . (x, y), for the ball of each foot."""

    ball_level_m: np.ndarray  # (2,) at the world's origin
    ankle_level_m: np.ndarray  # (2,)
    slope: np.ndarray  # (2,) rise per metre along x and y
    planted: np.ndarray  # (F, 2)


def fit_floor(ball_m: np.ndarray, ankle_m: np.ndarray, pelvis_m: np.ndarray, fps: float, level: bool = False) -> Floor:
    """The floor under balls and ankles (F, 2, 3) that were captured at some rate. Feet that never stand take the
    other's level. `level`: the floor is known to have no slope."""
    stands = _first_guess(ball_m, pelvis_m, fps)
    for _ in range(ROUNDS):
        levels, slope = _plane(ball_m, stands, 0.0 if level else STEEPEST)
        rise = np.sum(ankle_m[..., :2] * slope, axis=-1)
        ankle_levels = _ankle_levels(ankle_m[..., 2] - rise, stands)
        ball, ankle = ball_m.copy(), ankle_m.copy()
        ball[..., 2] -= np.sum(ball_m[..., :2] * slope, axis=-1) + levels
        ankle[..., 2] -= rise + ankle_levels
        stands = planted(ball, ankle, pelvis_m, fps)
    return Floor(levels, ankle_levels, slope, stands)


def level_from_floor(slope: np.ndarray) -> np.ndarray:
    """The least rotation (4,) that makes a plane of this slope level."""
    normal = np.array([-slope[0], -slope[1], 1.0])
    return rotations.between(normal / np.linalg.norm(normal), UP)


def _first_guess(ball_m: np.ndarray, pelvis_m: np.ndarray, fps: float) -> np.ndarray:
    """Slow feet near the lowest level that any foot had within a second: no plane needed yet."""
    lowest = ball_m[..., 2].min(axis=1)
    reach = round(WINDOW_S * fps)
    around = np.array([lowest[max(0, f - reach) : f + reach + 1].min() for f in range(len(lowest))])
    slow = speeds(ball_m, fps) < slow_limit(pelvis_m, fps)[:, None]
    near = ball_m[..., 2] < around[:, None] + BALL_NEAR_M
    # a clip in which nothing is ever slow still has a floor: under its lowest foot
    return near & slow if (near & slow).any() else near


def _plane(ball_m: np.ndarray, stands: np.ndarray, steepest: float) -> tuple[np.ndarray, np.ndarray]:
    """Levels (2,) of the two balls and one slope (2,), least squares with the slope held back as if by footprints
    spread SPREAD_M, the farthest outliers (toes that push off, heels that strike) left out."""
    if not stands.any():
        # someone who never stands (a slide, a fall) has the floor at the lowest point reached
        return np.repeat(ball_m[..., 2].min(), 2), np.zeros(2)
    frame, side = np.nonzero(stands)
    at, height = ball_m[frame, side, :2], ball_m[frame, side, 2]
    centre = at.mean(axis=0)
    kept = counted = np.ones(len(height), bool)
    for _ in range(4):
        columns = np.column_stack([side == 0, side == 1, at - centre]).astype(float)[kept]
        normal = np.einsum("ni,nj->ij", columns, columns)
        normal[[2, 3], [2, 3]] += kept.sum() * SPREAD_M**2
        # a foot that never stands leaves its level open: a whisper of weight ties it to zero until it is replaced below
        normal[[0, 1], [0, 1]] += 1e-9
        solved = np.linalg.solve(normal, np.einsum("ni,n->i", columns, height[kept]))
        slope = solved[2:] * min(1.0, steepest / max(float(np.linalg.norm(solved[2:])), 1e-9))
        residual = height - np.where(side == 0, solved[0], solved[1]) - np.sum((at - centre) * slope, axis=-1)
        apart = solved[0] - solved[1]
        if abs(apart) > FEET_APART_M and len(np.unique(side[counted])) == 2:
            # feet of one person stand at one level, give or take their markers: one far above the other only hangs low
            counted = side == (1 if apart > 0.0 else 0)
        kept = counted & (np.abs(residual) < max(0.01, 2.5 * float(np.median(np.abs(residual[counted])))))
    flattened = height - np.sum((at - centre) * slope, axis=-1)
    level = np.array([np.median(flattened[side == s]) if (side == s).any() else np.nan for s in (0, 1)])
    level = np.where(np.isnan(level) | (level > np.nanmin(level) + FEET_APART_M), np.nanmin(level), level)
    return level - np.sum(centre * slope), slope


def _ankle_levels(height: np.ndarray, stands: np.ndarray) -> np.ndarray:
    """Where each ankle is while its foot stands flat: the low end of its heights while the foot stands."""
    level = np.array([np.percentile(height[stands[:, s], s], 25.0) if stands[:, s].any() else np.nan for s in (0, 1)])
    if np.isnan(level).all():
        return np.repeat(height.min(), 2)
    lowest = np.nanmin(level)
    return np.where(np.isnan(level) | (level > lowest + FEET_APART_M), lowest, level)
