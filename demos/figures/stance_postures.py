"""Stance paper, fig. 5: a continuous range of postures, Alberts' thirteen words over one number."""

from __future__ import annotations

from behaviours.stance.shape_sets.posture import WORDS
from behaviours.stance.solve import solve_stance
from demos.figures.press import Press
from demos.figures.sheet import Sheet, number
from demos.figures.stance_shots import row_of, shot
from demos.figures.stills import Look
from engine.body.anthropometry import standard_body

LOOK = Look(-78.0, 4.0)
PITCH_M = 0.6
LETTERS = 13.0


def draw(press: Press) -> Sheet:
    body = standard_body()
    stances = [solve_stance(body, "posture", intensity) for intensity in WORDS.values()]
    scenes = [shot(body, stance, balance=False) for stance in stances]
    notes = [number(intensity) for intensity in WORDS.values()]
    return row_of(press, scenes, LOOK, PITCH_M, list(WORDS), notes, letters=LETTERS)[1]
