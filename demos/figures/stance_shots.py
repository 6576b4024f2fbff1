"""Stances as they are photographed for the stance paper's figures: one body, over the origin, facing +X."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from behaviours.stance.measures import measures
from behaviours.stance.solve import StanceResult
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet
from demos.figures.stills import Look, Strip
from engine.body.skeleton import Body
from engine.core.debug_draw import DebugDraw
from engine.render.scene import Balance, Colour, Figure, Scene

STANCE: Colour = (0.62, 0.70, 0.80)  # neither clip, rules nor reaction: a colour of its own
DOT: Colour = (0.85, 0.12, 0.10)
DOT_RADIUS_M = 0.045
WIDTH = 1000.0  # of a sheet, in its own units


def shot(body: Body, stance: StanceResult, dot_m=None, balance: bool = True) -> Scene:
    """One stance, the ground that bears it, where its weight is, and the red dot that it is about."""
    marks = DebugDraw()
    if dot_m is not None:
        marks.point(dot_m, DOT_RADIUS_M, DOT)
    scene = Scene([Figure(body, stance.joints_m, stance.orientations, STANCE)], draw=marks)
    if balance:
        found = measures(body, stance)
        scene.balances = [Balance(found.support_m, stance.com_m, stance.plan.balance_m, STANCE)]
    return scene


def row_of(
    press: Press, scenes: Sequence[Scene], look: Look, pitch_m: float, words: Sequence[str], notes: Sequence[str] = (),
    dots_m=(), letters: float = BODY,
) -> tuple[Strip, Sheet]:  # fmt: skip
    """Stances side by side on a sheet, each with its word below it and a note in small print."""
    strip = press.strip(list(scenes), look, WIDTH, pitch_m, dots_m)
    lines = max((1 + note.count("\n") for note in notes), default=0)
    sheet = Sheet(strip.size[1] + 36 + 19 * lines, press.scale)
    sheet.picture(strip, 0, 0)
    for k, word in enumerate(words):
        x, _ = strip.at(k, (0.0, 0.0, 0.0))
        sheet.text(x, strip.size[1] + 19, word, letters, align="center", valign="baseline")
        if notes:
            sheet.text(x, strip.size[1] + 30, notes[k], SMALL, "faint", "center")
    return strip, sheet


def around_dot(dot_m, radius_m: float = DOT_RADIUS_M) -> np.ndarray:
    """(2, 3) corners of what a still must show of a dot."""
    return np.asarray(dot_m, float) + radius_m * np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
