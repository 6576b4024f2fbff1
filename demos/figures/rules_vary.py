"""Fig. 3.2: the rules' pose as the threat's position, size and speed vary; left the clip's pose that all start from."""

from __future__ import annotations

from typing import Any

from demos.figures.meeting import meet, posed
from demos.figures.press import Press
from demos.figures.sheet import SMALL, TITLE, Sheet, number
from demos.figures.stills import Look
from engine.render.scene import CLIP_BLUE, RULES_YELLOW, Scene

LOOK = Look(-32.0, 9.0)
PITCH_M = 1.42
TIME_S = 0.95
USUAL: dict[str, Any] = {"azimuth_deg": 25.0, "size": 0.5, "speed_mps": 26.25}
ROWS = (
    ("position", "right to left", "azimuth_deg", (-70.0, -35.0, 0.0, 35.0, 70.0), 0, "°"),
    ("size", "small to large", "size", (0.0, 0.25, 0.5, 0.75, 1.0), 2, ""),
    ("speed", "slow to fast", "speed_mps", (22.8, 24.5, 26.25, 28.0, 29.7), 1, " m/s"),
)
LEFT, TOP, ROW_GAP = 190, 40, 44


def draw(press: Press) -> Sheet:
    clip = press.clip("walk", "stand")
    rows = [[meet(clip, TIME_S, **USUAL | {key: value}) for value in values] for _, _, key, values, _, _ in ROWS]
    strips = [press.strip([_scene(m) for m in row], LOOK, 1000 - LEFT, PITCH_M) for row in rows]
    sheet = Sheet(TOP + sum(strip.size[1] + ROW_GAP for strip in strips), press.scale)
    y = float(TOP)
    for (word, way, _, values, digits, unit), row, strip in zip(ROWS, rows, strips, strict=True):
        sheet.picture(strip, LEFT, y)
        sheet.text(LEFT + 4, y - 26, f"{word}, {way}", TITLE, italic=True)
        for k, (value, meeting) in enumerate(zip(values, row, strict=True)):
            x, _ = strip.at(k, meeting.found.rules.root_m)
            sheet.text(LEFT + x, y + strip.size[1] + 1, number(value, digits) + unit, SMALL, "faint", "center")
        y += strip.size[1] + ROW_GAP
    first = rows[0][0]
    start = press.strip([Scene([posed(first.body, first.clip, CLIP_BLUE)])], LOOK, LEFT - 10, PITCH_M)
    sheet.picture(start, 0, TOP + 0.5 * (y - TOP - ROW_GAP - start.size[1]))
    sheet.legend(8, sheet.height - 20, [(CLIP_BLUE, "clip"), (RULES_YELLOW, "rules alone")])
    return sheet


def _scene(meeting) -> Scene:
    return Scene([posed(meeting.body, meeting.found.rules, RULES_YELLOW)])
