"""Stance paper, fig. 1: four reach postures that satisfy the same constraint; structure differs, not degree."""

from __future__ import annotations

from behaviours.stance.solve import solve_stance
from demos.figures.press import Press
from demos.figures.sheet import Sheet, number
from demos.figures.stance_shots import around_dot, row_of, shot
from demos.figures.stills import Look
from engine.body.anthropometry import standard_body

LOOK = Look(-70.0, 6.0)
PITCH_M = 1.25
TARGET_M = (0.56, -0.28, 1.4)
WAYS = (
    ("reach", "plain"),
    ("reach-beauty-line", "beauty line"),
    ("reach-eager", "eager"),
    ("reach-reluctant", "reluctant"),
)


def draw(press: Press) -> Sheet:
    body = standard_body()
    stances = [solve_stance(body, name, 1.0, reach_right_m=TARGET_M) for name, _ in WAYS]
    scenes = [shot(body, stance, TARGET_M) for stance in stances]
    notes = [f"wrist off by {number(1000.0 * float(stance.wrist_error_m[1]), 1)} mm" for stance in stances]
    return row_of(press, scenes, LOOK, PITCH_M, [word for _, word in WAYS], notes, around_dot(TARGET_M))[1]
