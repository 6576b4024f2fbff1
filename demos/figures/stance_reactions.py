"""Stance paper, fig. 6: reactions to an object, the red dot: two ways to recoil from it, two ways to be drawn to it."""

from __future__ import annotations

from behaviours.stance.solve import StanceResult, solve_stance
from demos.figures.press import Press
from demos.figures.sheet import Sheet
from demos.figures.stance_shots import around_dot, row_of, shot
from demos.figures.stills import Look
from engine.body.anthropometry import standard_body

LOOK = Look(-18.0, 8.0)
PITCH_M = 1.2
OBJECT_M = (0.6, 0.42, 1.25)
WAYS = (
    ("recoil-mild", "recoil, mild"),
    ("recoil-strong", "recoil, strong"),
    ("interest", "interest, eager"),
    ("interest-curious", "interest, curious"),
)


def draw(press: Press) -> Sheet:
    body = standard_body()
    stances = [solve_stance(body, name, 1.0, object_m=OBJECT_M) for name, _ in WAYS]
    scenes = [shot(body, stance, OBJECT_M) for stance in stances]
    notes = [states_of(stance) for stance in stances]
    return row_of(press, scenes, LOOK, PITCH_M, [word for _, word in WAYS], notes, around_dot(OBJECT_M))[1]


def states_of(stance: StanceResult) -> str:
    """The state set in two short lines."""
    states = stance.shape.states
    collars = " ".join(f"{axis} {state}," for axis, state in (("Y", states.collar_y), ("Z", states.collar_z)))
    return f"coronal {states.coronal_class}, sagittal {states.sagittal_class}\ncollars {collars.rstrip(',')}"
