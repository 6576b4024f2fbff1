"""Fig. 3.4: what goes into the turn rule and what comes out, with the running values."""

from __future__ import annotations

import numpy as np

from behaviours.rules.controls import TURN
from behaviours.rules.lean import SPINE
from behaviours.rules.turn import turn_angles, turn_away
from demos.figures.meeting import meet, posed
from demos.figures.panel import degrees, on_its_feet, panel, vector
from demos.figures.press import Press
from demos.figures.sheet import Sheet, number
from demos.figures.stills import Look
from engine.body.skeleton import HEAD, JOINTS
from engine.render.scene import CLIP_BLUE, RULES_YELLOW, Scene

LOOK = Look(-25.0, 12.0)
SIZE, AZIMUTH_DEG = 1.0, 40.0
REMAINS = ("back", "waist", "pelvis")


def draw(press: Press) -> Sheet:
    m = meet(press.clip("stand"), 0.5, AZIMUTH_DEG, 10.0, 24.0, SIZE)
    task, control = m.found.task, float(m.found.controls_initial[TURN])
    maxima, wanted = task.rules.lean_turn, float(task.choices.turn_rad)
    rotations = task.start.rotations.copy()
    turn_away(rotations, wanted, control, maxima)
    after = posed(m.body, on_its_feet(m, rotations), RULES_YELLOW)
    before = posed(m.body, on_its_feet(m, task.start.rotations.copy()), CLIP_BLUE, 0.45)
    head, travel = before.positions[HEAD] + (0.0, 0.0, 0.1), np.array(m.threat.direction)
    arrow = [head - 0.85 * travel, head - 0.25 * travel]
    still = press.layers([Scene([before]), Scene([after])], LOOK, 270, arrow)
    inputs = [
        ("travel $\\vec{D}$", vector(travel)),
        ("size", number(SIZE)),
        ("turn control", number(control)),
        ("to face away", degrees(wanted)),
        ("greatest Z, neck", degrees(maxima.neck_rad[2])),
    ]
    inputs += [
        (
            f"{joint}, {number(100 * getattr(maxima, f'{joint}_share'), 0)} % of the rest",
            degrees(getattr(maxima, f"{joint}_rad")[2]),
        )
        for joint in REMAINS
    ]
    angles = turn_angles(wanted, control, maxima)
    outputs = [("", "Z")] + [
        (JOINTS[joint], degrees(angle)) for joint, angle in zip(reversed(SPINE), reversed(angles), strict=True)
    ]
    outputs.append(("all together", degrees(sum(angles))))
    sheet, x, y = panel(press.scale, "turn away", inputs, outputs, still)
    tail, tip = (np.add(still.at(point), (x, y)) for point in arrow)
    sheet.arrow(tuple(tail), tuple(tip), "ink", 2.4, 11)
    sheet.text(tail[0], tail[1] - 8, "$\\vec{D}$", 20, align="center", valign="bottom", halo=True)
    return sheet
