"""The drawn panel of a rule (figs. 3.3 - 3.6): what goes in, the pose before and after, what comes out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from demos.figures.meeting import Meeting
from demos.figures.sheet import BODY, SMALL, TITLE, Sheet, number
from demos.figures.stills import Still
from engine.body.kinematics import joints_of
from engine.body.limb_ik import KEEP, apply_leg
from engine.body.skeleton import ANKLES, Pose
from engine.render.scene import CLIP_BLUE, RULES_YELLOW

INPUTS, OUTPUTS = (12, 270), (718, 270)  # left edge and width of both boxes
MIDDLE = (330, 340)
ROW, HEAD_ROW = 25.0, 34.0

Rows = Sequence[tuple[str, str]]


def panel(scale: float, rule: str, inputs: Rows, outputs: Rows, still: Still) -> tuple[Sheet, float, float]:
    """The sheet, and where its still was put, for what is to be drawn on it."""
    height = max(still.size[1] + 60, 2 * HEAD_ROW + ROW * max(len(inputs), len(outputs)) + 40)
    sheet = Sheet(height, scale)
    x, y = MIDDLE[0] + 0.5 * (MIDDLE[1] - still.size[0]), 34 + 0.5 * (height - 60 - still.size[1])
    sheet.text(500, 8, rule, TITLE + 3, align="center", bold=True)
    middle = 0.5 * height
    for (left, width), title, rows in ((INPUTS, "input", inputs), (OUTPUTS, "output", outputs)):
        tall = HEAD_ROW + ROW * len(rows) + 10
        top = middle - 0.5 * tall
        sheet.box(left, top, width, tall, "#f7f8fa", "hair", 8)
        sheet.text(left + 14, top + 9, title, BODY, "faint", italic=True)
        for k, (name, value) in enumerate(rows):
            row_y = top + HEAD_ROW + ROW * (k + 0.5)
            sheet.text(left + 14, row_y, name, BODY, valign="center")
            sheet.text(left + width - 14, row_y, value, BODY, align="right", valign="center")
    sheet.arrow((INPUTS[0] + INPUTS[1] + 8, middle), (MIDDLE[0] + 6, middle), "faint", 2.0, 11)
    sheet.arrow((MIDDLE[0] + MIDDLE[1] - 6, middle), (OUTPUTS[0] - 8, middle), "faint", 2.0, 11)
    sheet.picture(still, x, y)
    sheet.legend(12, height - 16, [(CLIP_BLUE, "before"), (RULES_YELLOW, "after")], SMALL)
    return sheet, x, y


def on_its_feet(meeting: Meeting, rotations: np.ndarray) -> Pose:
    """The start pose turned like this, its feet put back to where they stood."""
    body, start = meeting.body, meeting.found.task.start
    stood, foot = joints_of(body, Pose(start.root_m, start.rotations))
    positions, orientations = joints_of(body, Pose(start.root_m, rotations))
    for side, ankle in enumerate(ANKLES):
        apply_leg(body, rotations, positions, orientations, side, tuple(stood[ankle]), tuple(foot[ankle]), KEEP, 0.0)
    return Pose(start.root_m, rotations)


def degrees(radians: float) -> str:
    """An angle as it is written."""
    return f"{number(float(np.degrees(radians)), 1)}°"


def vector(v) -> str:
    return "(" + ", ".join(number(float(c)) for c in v) + ")"
