"""Thigh, shin, foot and toes, with balls at knee and ankle."""

from __future__ import annotations

import numpy as np

from engine.body import skeleton as sk
from engine.body.skeleton import Body
from engine.render.sculpture.parts import JOINT, SHELL, SHOE, Part, cut, outwards
from engine.render.surface import Shape, ball, blend, carve, ellipsoid, half_space, taper

KNEE_BALL, ANKLE_BALL = 0.0515, 0.0365


def leg_parts(body: Body, side: int) -> list[Part]:
    """Everything from the hip to the toes of one side."""
    knee, ankle = sk.KNEES[side], sk.ANKLES[side]
    upper, lower = body.offset_m[knee], body.offset_m[ankle]
    above = cut(thigh(upper, outwards(side)), upper, short_m=0.024, round_m=0.018)
    below = cut(shin(lower, outwards(side)), lower, short_m=0.020, round_m=0.014, start_m=0.024)
    foot, toes = foot_and_toes(body.sole_m[side], body.offset_m[sk.TOES[side]])
    return [
        Part(sk.HIPS[side], SHELL, above, 0.022),
        Part(knee, JOINT, ball((0.004, 0, 0), KNEE_BALL), 0.016),
        Part(knee, SHELL, below, 0.017),
        Part(ankle, JOINT, ball((0, 0, 0), ANKLE_BALL), 0.014),
        Part(ankle, SHOE, foot, 0.012),
        Part(sk.TOES[side], SHOE, toes, 0.012),
    ]


def thigh(bone: np.ndarray, out: float) -> Shape:
    """A long taper, fuller in front."""
    leg = taper((0.0, -0.002 * out, -0.015), 0.98 * bone, 0.081, 0.0505)
    quadriceps = ellipsoid(0.42 * bone + (0.018, 0.006 * out, 0), (0.066, 0.066, 0.15))
    return blend(0.04, leg, quadriceps)


def shin(bone: np.ndarray, out: float) -> Shape:
    """A shin with its calf behind."""
    leg = taper(0.03 * bone, 0.98 * bone, 0.0485, 0.0335)
    calf = ellipsoid(0.30 * bone + (-0.020, 0.004 * out, 0), (0.050, 0.050, 0.115))
    return blend(0.03, leg, calf)


def foot_and_toes(sole: np.ndarray, to_toe: np.ndarray) -> tuple[Shape, Shape]:
    """A heel, an instep and a ball on the ankle, and toes on theirs; both stand flat on the Body's own sole points."""
    heel, ball_of_foot, tip = (0.5 * (sole[2 * k] + sole[2 * k + 1]) for k in range(3))
    heel_half = max(0.5 * abs(sole[0][1] - sole[1][1]) + 0.006, 0.028)
    ball_half = 0.5 * abs(sole[2][1] - sole[3][1]) + 0.004
    ground = min(heel[2], ball_of_foot[2])
    foot = blend(
        0.03,
        ellipsoid(heel + (0.026, 0, 0.026), (0.036, heel_half, 0.034), 2.3),
        taper((-0.004, 0, -0.020), (0.8 * to_toe[0], 0.8 * to_toe[1], ground + 0.030), 0.037, 0.026),
        ellipsoid((to_toe[0] - 0.010, ball_of_foot[1], ground + 0.024), (0.046, ball_half, 0.028), 2.3),
    )
    under_toes, behind, ahead = ground - to_toe[2], 0.012, 0.5 * tip[0] + 0.003
    toes = ellipsoid((ahead - behind, 0.7 * tip[1], under_toes + 0.019), (ahead + behind, 0.97 * ball_half, 0.022), 2.4)
    return _flat(foot, ground), _flat(toes, under_toes)


def _flat(shape: Shape, ground: float) -> Shape:
    """Cut level at the ground, with a rounded edge."""
    return carve(0.008, shape, half_space((0, 0, ground), (0, 0, 1.0)))
