"""Fig. 2.1: eccentricity, the angle between the facing direction F and the direction to the threat T."""

from __future__ import annotations

import math

import numpy as np

from demos.figures.meeting import meet, posed
from demos.figures.press import Press
from demos.figures.sheet import BODY, Sheet, number
from demos.figures.stills import Look
from engine.body.skeleton import HEAD
from engine.render.scene import CLIP_BLUE, Ball, Scene

LOOK = Look(-90.0, 86.0)
AZIMUTH_DEG = 50.0
FAR_M, FACING_M, ARC_M = 1.75, 1.75, 0.95
ACCENT = "#b3261e"


def draw(press: Press) -> Sheet:
    m = meet(press.clip("sway"), 0.5, AZIMUTH_DEG, 0.0, 25.0)
    figure = posed(m.body, m.clip, CLIP_BLUE, 0.995)  # nothing casts a shadow in a plan
    head = figure.positions[HEAD] + (0.0, 0.0, 0.1)
    turn = math.radians(AZIMUTH_DEG)
    towards = np.array([math.cos(turn), math.sin(turn), 0.0])
    scene = Scene([figure], [Ball(head + FAR_M * towards, alpha=0.995)])
    ends = [head + FACING_M * np.array([1.0, 0.0, 0.0]), head + (FAR_M - 0.14) * towards]
    still = press.still(scene, LOOK, 560, [*ends, head - (0.4, 0.45, 0.0)], 0.05, shadows=False)
    sheet = Sheet(still.size[1], press.scale, 560)
    sheet.picture(still, 0, 0)
    start = still.at(head)
    for end, name in zip(ends, ("F", "T"), strict=True):
        tip = still.at(end)
        sheet.arrow(start, tip, "ink", 2.2, 13)
        middle = np.add(start, 0.66 * np.subtract(tip, start))
        sheet.text(
            middle[0] + (-22 if name == "T" else 0),
            middle[1] + (-18 if name == "T" else 26),
            f"$\\mathbf{{{name}}}$",
            24,
            align="center",
            valign="center",
            halo=True,
        )
    angles = np.linspace(0.0, turn, 40)
    sheet.line(
        still.many(head + ARC_M * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])).tolist(), ACCENT, 2.2
    )
    x, y = still.at(head + 1.12 * ARC_M * np.array([math.cos(turn / 2), math.sin(turn / 2), 0.0]))
    sheet.text(x, y, f"$\\theta = {number(AZIMUTH_DEG, 0)}°$", 21, ACCENT, valign="center", halo=True)
    sheet.text(
        12,
        sheet.height - 14,
        "facing $\\mathbf{F}$, direction to the threat $\\mathbf{T}$, eccentricity $\\theta$",
        BODY,
        "faint",
        valign="bottom",
    )
    return sheet
