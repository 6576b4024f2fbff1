"""Fig. 3.7: both arms reach for the line of approach, from above: as far from their own shoulders, so one is nearer."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from demos.figures.meeting import arriving, meet, palms_of, posed
from demos.figures.press import Press
from demos.figures.sheet import BODY, Sheet, number
from demos.figures.stills import Look
from engine.body.kinematics import joints_of
from engine.body.skeleton import SHOULDERS
from engine.render.scene import RULES_YELLOW, Scene

LOOK = Look(-90.0, 86.0)
AZIMUTH_DEG, SIZE = -40.0, 0.35
SIDES = ("left", "right")
ACCENT = "#b3261e"


def draw(press: Press) -> Sheet:
    m = meet(press.clip("stand"), 0.5, AZIMUTH_DEG, 4.0, 22.8, SIZE)
    rules = m.found.rules
    palms, shoulders = palms_of(m.body, rules), joints_of(m.body, rules)[0][list(SHOULDERS)]
    tangent, target = np.array(m.threat.tangent), np.array(m.threat.line_point_m)
    line = [target - 1.35 * tangent, target]
    # nothing casts a shadow in a plan
    figure, ball = posed(m.body, rules, RULES_YELLOW, 0.995), replace(arriving(m, 0.15), alpha=0.995)
    still = press.still(Scene([figure], [ball]), LOOK, 560, [*line, line[0] - (0.0, 0.1, 0.0)], 0.05, shadows=False)
    sheet = Sheet(still.size[1] + 34, press.scale, 560)
    sheet.picture(still, 0, 0)
    sheet.arrow(still.at(line[0]), still.at(line[1]), ACCENT, 1.8, 10)
    x, y = still.at(line[0])
    sheet.text(x - 6, y + 4, "line of approach", BODY, ACCENT, "right", italic=True, halo=True)
    for side, (shoulder, palm) in enumerate(zip(shoulders, palms, strict=True)):
        _reach(sheet, still, shoulder, palm, SIDES[side])
    return sheet


def _reach(sheet: Sheet, still, shoulder, palm, side: str) -> None:
    """The arc about a shoulder on which its palm lies, and how long the reach is."""
    start, end = np.array(still.at(shoulder)), np.array(still.at(palm))
    radius, middle = np.hypot(*(end - start)), np.arctan2(*(end - start)[::-1])
    angles = np.linspace(middle - 0.55, middle + 0.55, 40)
    arc = start + radius * np.column_stack([np.cos(angles), np.sin(angles)])
    sheet.line(arc.tolist(), "ink", 1.3, dashed=True)
    sheet.line([tuple(start), tuple(end)], "ink", 1.8)
    for place in (start, end):
        sheet.circle(tuple(place), 4.5, fill="white", edge="ink", line=1.8)
    away = -1 if side == "left" else 1
    label = 0.5 * (start + end) + (0, 26 * away)
    text = f"{side}, {number(float(np.linalg.norm(np.subtract(palm, shoulder))))} m"
    sheet.text(label[0], label[1], text, BODY, align="center", valign="center", halo=True)
