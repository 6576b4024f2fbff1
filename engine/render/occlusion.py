"""What of a body hides the sky from the rest of it: a dozen capsules, told to the vertex shader with the joints."""

from __future__ import annotations

import numpy as np

from engine.body import skeleton as sk
from engine.body.skeleton import Body
from engine.maths import rotations
from engine.render.scene import Figure

# from joint, to joint (-1: the tip of a head or hand), radius in shares of the stature
_SPANS = (
    (sk.PELVIS, sk.WAIST, 0.068),
    (sk.WAIST, sk.BACK, 0.066),
    (sk.BACK, sk.NECK, 0.070),
    (sk.HEAD, -1, 0.048),
    *[
        span
        for side in (sk.LEFT, sk.RIGHT)
        for span in (
            (sk.SHOULDERS[side], sk.ELBOWS[side], 0.026),
            (sk.ELBOWS[side], sk.WRISTS[side], 0.020),
            (sk.WRISTS[side], -1, 0.021),
            (sk.HIPS[side], sk.KNEES[side], 0.041),
            (sk.KNEES[side], sk.ANKLES[side], 0.027),
            (sk.ANKLES[side], sk.TOES[side], 0.020),
        )
    ],
)
CAPSULES = len(_SPANS)
_FROM, _TO = (np.array([span[k] for span in _SPANS]) for k in range(2))
_RADIUS = np.array([span[2] for span in _SPANS])
_BARE = np.flatnonzero(_TO < 0)


def occluders(figures: list[Figure]) -> np.ndarray:
    """(N, 2 * CAPSULES, 4): for each capsule its start and its radius, then its end and nothing. World metres."""
    out = np.zeros((len(figures), CAPSULES, 2, 4))
    for figure, rows in zip(figures, out, strict=True):
        positions, orientations = np.asarray(figure.positions), np.asarray(figure.orientations)
        rows[:, 0, :3] = positions[_FROM]
        rows[:, 1, :3] = positions[_TO]
        rows[_BARE, 1, :3] = positions[_FROM[_BARE]] + rotations.rotate(orientations[_FROM[_BARE]], _tips(figure.body))
        rows[:, 0, 3] = _RADIUS * _size_m(figure.body)
    return out.reshape(len(figures), 2 * CAPSULES, 4)


def _tips(body: Body) -> np.ndarray:
    """Ends of head and hands that no joint marks, a radius short, in the order of the spans."""
    return np.array([0.5 * body.head_top_m, 0.7 * body.fingertip_m[0], 0.7 * body.fingertip_m[1]])


def _size_m(body: Body) -> float:
    """About the stature."""
    return 2.0 * float(np.abs(body.offset_m[[sk.LEFT_KNEE, sk.LEFT_ANKLE], 2]).sum())
