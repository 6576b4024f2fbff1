"""Fig. 3.8: the elbow's swivel angle about shoulder - wrist, from the shoulder's down (dashed).

Drawn is the angle that the arm has: what the rule asks for, as far as shoulder and wrist have room for it.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.rules.block import swivel_rad
from behaviours.settings import Settings
from demos.figures.meeting import meet, posed
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet, number
from demos.figures.stills import Look
from engine.body.kinematics import joints_of
from engine.body.limb_ik import DOWN, arm_swivel, arm_zero
from engine.body.skeleton import ELBOWS, LEFT, SHOULDERS, WRISTS
from engine.maths import vector
from engine.render.scene import RULES_YELLOW, Scene

SIZES = (0.0, 1.0)
WIDTH, GAP, BAND = 330, 40, 58
BLOCK = Settings().block
ASIDE_DEG = -34.0  # the photographer stands this far from the line shoulder - wrist, to tell the two apart
ACCENT = "#b3261e"


def draw(press: Press) -> Sheet:
    clip = press.clip("sway")
    meetings = [meet(clip, 0.5, 0.0, 8.0, 22.8, size) for size in SIZES]
    stills = [
        press.layers([Scene([posed(m.body, m.found.rules, RULES_YELLOW)])], _along_arm(m), WIDTH, cut_m=0.95)
        for m in meetings
    ]
    height = max(still.size[1] for still in stills)
    sheet = Sheet(height + BAND, press.scale, 2 * (WIDTH + GAP))
    for k, (m, still, size) in enumerate(zip(meetings, stills, SIZES, strict=True)):
        corner = (k * (WIDTH + GAP) + 8, height - still.size[1])
        sheet.picture(still, *corner)
        _angle(sheet, still, corner, m)
        words = "small threat: reach out" if size == 0 else "large threat: stay small"
        sheet.text(corner[0] + 0.5 * WIDTH, height + 10, words, BODY, align="center")
        asked_deg = math.degrees(swivel_rad(size, BLOCK.swivel_small_rad, BLOCK.swivel_large_rad))
        under = f"the rule asks for {number(asked_deg, 0)}°"
        sheet.text(corner[0] + 0.5 * WIDTH, height + 32, under, SMALL, align="center")
    return sheet


def _along_arm(m) -> Look:
    """From where the circle of the elbow looks round."""
    positions, _ = joints_of(m.body, m.found.rules)
    x, y, z = positions[WRISTS[LEFT]] - positions[SHOULDERS[LEFT]]
    return Look(math.degrees(math.atan2(y, x)) + ASIDE_DEG, 0.5 * math.degrees(math.atan2(z, math.hypot(x, y))))


def _angle(sheet: Sheet, still, corner, m) -> None:
    """The circle that the left elbow can sweep, the dashed zero, and the angle that it has."""
    positions, orientations = joints_of(m.body, m.found.rules)
    shoulder, elbow, wrist = (positions[j[LEFT]] for j in (SHOULDERS, ELBOWS, WRISTS))
    along = np.array(vector.unit(vector.subtract(wrist, shoulder), (1.0, 0.0, 0.0)))
    centre = shoulder + along * ((elbow - shoulder) @ along)
    radius = float(np.linalg.norm(elbow - centre))
    zero = np.array(arm_zero(orientations, LEFT, DOWN, tuple(along)))
    zero = zero - along * (zero @ along)
    zero /= np.linalg.norm(zero)
    out = (elbow - centre) / radius
    side = out - zero * (out @ zero)
    side /= np.linalg.norm(side)
    angle = math.acos(float(np.clip(out @ zero, -1.0, 1.0)))

    def place(turn, far=1.0):
        return np.add(
            still.many(centre + far * radius * (np.outer(np.cos(turn), zero) + np.outer(np.sin(turn), side))), corner
        )

    sheet.line(place(np.linspace(0, 2 * math.pi, 80)).tolist(), "faint", 1.1)
    sheet.line(place(np.linspace(0, angle, 40)).tolist(), ACCENT, 2.6)
    middle = np.add(still.at(centre), corner)
    sheet.line([tuple(middle), tuple(place([0.0], 1.25)[0])], "ink", 1.6, dashed=True)
    sheet.line([tuple(middle), tuple(place([angle])[0])], ACCENT, 1.8)
    for joint, name, align in ((shoulder, "shoulder", "right"), (wrist, "wrist", "left"), (elbow, "elbow", "left")):
        x, y = np.add(still.at(joint), corner)
        sheet.circle((x, y), 4, fill="white", edge="ink", line=1.6)
        sheet.text(x + (8 if align == "left" else -8), y - 3, name, SMALL, align=align, valign="bottom", halo=True)
    degrees = math.degrees(arm_swivel(positions, orientations, LEFT))
    x, y = place([0.5 * angle], 1.0 + 36.0 / max(np.hypot(*(place([angle])[0] - middle)), 1.0))[0]
    sheet.text(x, y, f"{number(degrees, 0)}°", 19, ACCENT, "center", "center", halo=True)
