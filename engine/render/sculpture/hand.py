"""A relaxed hand: palm, four fingers apart, and a thumb. The skeleton ends at the wrist, so their curl is carved in."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from engine.render.surface import Shape, blend, taper

HAND_M = 0.189  # of the reference adult, wrist to fingertip; everything below is scaled from it
KNUCKLES = 0.475  # share of that at which the fingers begin
PHALANGES = (0.45, 0.31, 0.24)


class Finger(NamedTuple):
    """Lengths in metres of the reference hand, angles in degrees."""

    across_m: float  # of its knuckle, towards the thumb
    length_m: float
    thick: float
    splay_deg: float  # towards the thumb
    curl_deg: tuple[float, float, float]  # of each phalanx against the palm, towards it


FINGERS = (
    Finger(0.0300, 0.091, 0.98, 5.0, (8.0, 20.0, 28.0)),
    Finger(0.0100, 0.101, 1.0, 1.5, (11.0, 25.0, 34.0)),
    Finger(-0.0103, 0.094, 0.96, -2.5, (14.0, 29.0, 39.0)),
    Finger(-0.0292, 0.075, 0.85, -8.0, (17.0, 33.0, 43.0)),
)


def hand(tip: np.ndarray, inward: float) -> Shape:
    """In the wrist's frame. tip (3,): fingertip of the flat hand; inward: +1 or -1, where along Y the palm looks."""
    size = float(np.linalg.norm(tip)) / HAND_M
    down = tip / np.linalg.norm(tip)

    def at(across_m: float, inward_m: float, along_m: float) -> np.ndarray:
        return size * (np.array([across_m, inward * inward_m, 0.0]) + along_m * down)

    knuckles = [at(f.across_m, 0.001, KNUCKLES * HAND_M) for f in FINGERS]
    palm = [
        taper(at(0.48 * f.across_m, 0.0, -0.010), knuckle, 0.0158 * size, 0.0108 * size)
        for f, knuckle in zip(FINGERS, knuckles, strict=True)
    ]
    ball_of_thumb = taper(at(0.014, 0.006, 0.020), at(0.036, 0.013, 0.060), 0.0150 * size, 0.0128 * size)
    thumb = blend(
        0.006 * size,
        taper(at(0.036, 0.013, 0.060), at(0.0505, 0.019, 0.090), 0.0118 * size, 0.0098 * size),
        taper(at(0.0505, 0.019, 0.090), at(0.0565, 0.024, 0.116), 0.0096 * size, 0.0072 * size),
    )
    fingers = [_finger(f, knuckle, size, down, inward) for f, knuckle in zip(FINGERS, knuckles, strict=True)]
    flesh = blend(0.014 * size, blend(0.020 * size, *palm), ball_of_thumb)
    return blend(0.005 * size, blend(0.012 * size, flesh, thumb), *fingers)


def _finger(finger: Finger, knuckle: np.ndarray, size: float, down: np.ndarray, inward: float) -> Shape:
    """Three bones, each curled further towards the palm than the one before."""
    splay, joint, radius = math.radians(finger.splay_deg), knuckle, 0.0094 * finger.thick * size
    bones = []
    for share, curl_deg in zip(PHALANGES, finger.curl_deg, strict=True):
        curl = math.radians(curl_deg)
        towards = math.cos(curl) * down + np.array([math.sin(splay), inward * math.sin(curl), 0.0])
        end = joint + share * finger.length_m * size * towards / np.linalg.norm(towards)
        thinner = 0.91 * radius
        bones.append(taper(joint, end, radius, thinner))
        joint, radius = end, thinner
    return blend(0.0015 * size, *bones)
