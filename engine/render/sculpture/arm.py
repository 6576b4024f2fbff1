"""Upper arm, forearm and hand, with balls at elbow and wrist."""

from __future__ import annotations

import numpy as np

from engine.body import skeleton as sk
from engine.body.skeleton import Body
from engine.render.sculpture.parts import JOINT, SHELL, Part, cut, outwards
from engine.render.surface import Shape, ball, blend, ellipsoid, taper

ELBOW_BALL, WRIST_BALL = 0.0385, 0.0265


def arm_parts(body: Body, side: int) -> list[Part]:
    """Everything from the shoulder to the fingertips of one side."""
    elbow, wrist = sk.ELBOWS[side], sk.WRISTS[side]
    upper, lower = body.offset_m[elbow], body.offset_m[wrist]
    above = cut(upper_arm(upper, outwards(side)), upper, short_m=0.017, round_m=0.014)
    below = cut(forearm(lower, outwards(side)), lower, short_m=0.012, round_m=0.012, start_m=0.017)
    return [
        Part(sk.SHOULDERS[side], SHELL, above, 0.017),
        Part(elbow, JOINT, ball((0, 0, 0), ELBOW_BALL), 0.0135),
        Part(elbow, SHELL, below, 0.0145),
        Part(wrist, JOINT, ball((0, 0, 0), WRIST_BALL), 0.011),
        Part(wrist, SHELL, _hand(body.palm_m[side], body.fingertip_m[side], -outwards(side)), 0.0085, 0.0125),
    ]


def upper_arm(bone: np.ndarray, out: float, drop_m: float = 0.0) -> Shape:
    """Deltoid, biceps and triceps around a tapering arm, whose top is put that much lower."""
    arm = taper((0, 0.008 * out, -0.004 - drop_m), 0.97 * bone, 0.052, 0.0385)
    deltoid = ellipsoid(0.16 * bone + (0, 0.010 * out, -0.8 * drop_m), (0.054, 0.047, 0.075))
    biceps = ellipsoid(0.48 * bone + (0.008, 0.002 * out, 0), (0.044, 0.042, 0.085))
    return blend(0.03, arm, deltoid, biceps)


def forearm(bone: np.ndarray, out: float) -> Shape:
    """It swells below the elbow and thins to the wrist."""
    arm = taper(0.04 * bone, 0.98 * bone, 0.038, 0.0262, flat=(1.06, 1.0, 1.0))
    swell = ellipsoid(0.27 * bone + (0.006, 0.004 * out, 0), (0.042, 0.039, 0.085))
    return blend(0.03, arm, swell)


def _hand(palm: np.ndarray, tip: np.ndarray, inward: float) -> Shape:
    """A mitten: palm, gently curled fingers together, and a thumb that points forwards. Palms face the thighs."""
    knuckles, wide = palm + 0.40 * (tip - palm), (1.9, 0.78, 1.0)
    middle = knuckles + 0.55 * (tip - knuckles) + (0.0, 0.004 * inward, 0.0)
    end = knuckles + 0.90 * (tip - knuckles) + (0.0, 0.017 * inward, 0.0)
    root = 0.20 * tip + (0.018, 0.003 * inward, 0)
    thumb = 0.40 * tip + (0.047, 0.012 * inward, 0)
    thumb_tip = 0.57 * tip + (0.054, 0.017 * inward, 0)
    return blend(
        0.012,
        ellipsoid(0.96 * palm, (0.041, 0.0175, 0.285 * float(np.linalg.norm(tip))), 2.8),
        taper(knuckles, middle, 0.0185, 0.0165, flat=wide),
        taper(middle, end, 0.0165, 0.0125, flat=wide),
        taper(root, thumb, 0.0165, 0.0125),
        taper(thumb, thumb_tip, 0.0125, 0.0095),
    )
