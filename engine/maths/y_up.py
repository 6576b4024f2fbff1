"""The axes of files: X to the left, Y up, Z ahead, as BVH files have them by custom and glTF files by rule.

Ours are X ahead, Y left, Z up; somebody who faces our +X faces +Z there. The change is a rotation, no mirror.
"""

from __future__ import annotations

import numpy as np


def y_up(vectors: np.ndarray) -> np.ndarray:
    """Our vectors (..., 3) in those axes."""
    return np.asarray(vectors)[..., [1, 2, 0]]


def y_up_rotations(quaternions: np.ndarray) -> np.ndarray:
    """Our rotations (..., 4), w x y z, in those axes: w stays, the axis goes along."""
    return np.asarray(quaternions)[..., [0, 2, 3, 1]]
