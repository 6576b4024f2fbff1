"""Stance paper, fig. 7: four intensities of the strong recoil, the last one extrapolated past a full instance."""

from __future__ import annotations

from behaviours.stance.solve import solve_stance
from demos.figures.press import Press
from demos.figures.sheet import Sheet, number
from demos.figures.stance_reactions import LOOK, OBJECT_M, PITCH_M
from demos.figures.stance_shots import around_dot, row_of, shot
from engine.body.anthropometry import standard_body

INTENSITIES = (0.3, 0.6, 1.0, 1.3)


def draw(press: Press) -> Sheet:
    body = standard_body()
    scenes = [shot(body, solve_stance(body, "recoil-strong", a, object_m=OBJECT_M), OBJECT_M) for a in INTENSITIES]
    words = [number(a, 1) for a in INTENSITIES]
    return row_of(press, scenes, LOOK, PITCH_M, words, dots_m=around_dot(OBJECT_M))[1]
