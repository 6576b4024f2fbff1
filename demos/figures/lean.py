"""Fig. 3.3: what goes into the lean rule and what comes out, with the running values."""

from __future__ import annotations

import numpy as np

from behaviours.rules.controls import LEAN
from behaviours.rules.lean import lean_angles, lean_away
from demos.figures.meeting import meet, posed
from demos.figures.panel import degrees, on_its_feet, panel, vector
from demos.figures.press import Press
from demos.figures.sheet import Sheet, number
from demos.figures.stills import Look
from engine.body.skeleton import HEAD
from engine.render.scene import CLIP_BLUE, RULES_YELLOW, Scene

LOOK = Look(-55.0, 8.0)
SPEED_MPS, AZIMUTH_DEG = 28.0, 30.0
JOINTS = ("neck", "back", "waist", "pelvis")


def draw(press: Press) -> Sheet:
    m = meet(press.clip("stand"), 0.5, AZIMUTH_DEG, 10.0, SPEED_MPS)
    task, control = m.found.task, float(m.found.controls_initial[LEAN])
    start, maxima = task.start, task.rules.lean_turn
    rotations = start.rotations.copy()
    lean_away(rotations, start.orientations, start.heading_rad, m.threat.direction, control, maxima, 1.0, 0.0, -1.0)
    after = posed(m.body, on_its_feet(m, rotations), RULES_YELLOW)
    before = posed(m.body, on_its_feet(m, start.rotations.copy()), CLIP_BLUE, 0.45)
    head, travel = before.positions[HEAD] + (0.0, 0.0, 0.1), np.array(m.threat.direction)
    arrow = [head - 1.0 * travel, head - 0.3 * travel]
    still = press.layers([Scene([before]), Scene([after])], LOOK, 320, arrow)
    inputs = [
        ("travel $\\vec{D}$", vector(travel)),
        ("speed", f"{number(SPEED_MPS, 1)} m/s"),
        ("lean control", number(control)),
        ("greatest X and Y, neck", _pair(maxima.neck_rad)),
        ("back", _pair(maxima.back_rad)),
        ("waist", _pair(maxima.waist_rad)),
        ("pelvis", _pair(maxima.pelvis_rad)),
    ]
    angles = [lean_angles(m.threat.direction, getattr(maxima, f"{joint}_rad"), control) for joint in JOINTS]
    outputs = [("", "X, Y")] + [(joint, _pair(both)) for joint, both in zip(JOINTS, angles, strict=True)]
    sheet, x, y = panel(press.scale, "lean away", inputs, outputs, still)
    tail, tip = (np.add(still.at(point), (x, y)) for point in arrow)
    sheet.arrow(tuple(tail), tuple(tip), "ink", 2.4, 11)
    sheet.text(tail[0], tail[1] - 8, "$\\vec{D}$", 20, align="center", valign="bottom", halo=True)
    return sheet


def _pair(angles) -> str:
    return f"{degrees(angles[0])}, {degrees(angles[1])}"
