"""What a blow does to the head, from the physics' own rate: peak acceleration and HIC, as measured ones are given."""

from __future__ import annotations

import numpy as np

from behaviours.measure.measures import runs
from behaviours.measure.observing import Track

GRAVITY = 9.80665
PHYSICS_HZ = 480.0
HIC_WINDOW_S = 0.015


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
