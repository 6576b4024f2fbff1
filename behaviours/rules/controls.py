"""Rule control parameters (Hermens 2006, 3.2.1, table 3.1): how strongly each rule acts, from what the threat is
like.
"""

from __future__ import annotations

import numpy as np

CONTROLS = ("lean", "turn", "recoil", "reach_left", "reach_right", "swivel_left", "swivel_right")
CONTROL_COUNT = len(CONTROLS)
LEAN, TURN, RECOIL, REACH_LEFT, REACH_RIGHT, SWIVEL_LEFT, SWIVEL_RIGHT = range(CONTROL_COUNT)


def controls_from_threat(speed_norm: float, size_norm: float) -> np.ndarray:
    """The seven controls in [0, 1], in the order of CONTROLS: lean from the speed, all others from the size."""
    controls = np.full(CONTROL_COUNT, min(1.0, max(0.0, float(size_norm))))
    controls[LEAN] = min(1.0, max(0.0, float(speed_norm)))
    return controls
