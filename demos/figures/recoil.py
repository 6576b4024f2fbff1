"""Fig. 3.5: what goes into the recoil rule and what comes out, with the running values."""

from __future__ import annotations

from behaviours.rules.controls import RECOIL
from behaviours.rules.recoil import raise_clavicle, retract_arm
from demos.figures.meeting import meet, posed
from demos.figures.panel import degrees, on_its_feet, panel
from demos.figures.press import Press
from demos.figures.sheet import Sheet, number
from demos.figures.stills import Look
from engine.render.scene import CLIP_BLUE, RULES_YELLOW, Scene

LOOK = Look(-30.0, 6.0)
SIZE = 0.8


def draw(press: Press) -> Sheet:
    m = meet(press.clip("sway"), 0.5, 0.0, 10.0, 24.0, SIZE)
    task, control = m.found.task, float(m.found.controls_initial[RECOIL])
    greatest = task.rules.recoil
    rotations = task.start.rotations.copy()
    for side in range(2):
        raise_clavicle(rotations, side, control, greatest)
        retract_arm(rotations, side, control, greatest)
    after = posed(m.body, on_its_feet(m, rotations), RULES_YELLOW)
    before = posed(m.body, on_its_feet(m, task.start.rotations.copy()), CLIP_BLUE, 0.45)
    still = press.layers([Scene([before]), Scene([after])], LOOK, 270, cut_m=0.82)
    rows = (
        ("clavicle, raised", greatest.clavicle_rad[0]),
        ("clavicle, forward", greatest.clavicle_rad[1]),
        ("shoulder, sideways", greatest.shoulder_rad[0]),
        ("elbow, flexed", greatest.elbow_rad[1]),
    )
    inputs = [("size", number(SIZE)), ("recoil control", number(control))]
    inputs += [(f"greatest, {name}", degrees(angle)) for name, angle in rows]
    outputs = [(name, degrees(control * angle)) for name, angle in rows]
    outputs += [("shoulder, elbow", "until block acts")]
    return panel(press.scale, "recoil", inputs, outputs, still)[0]
