"""A character's stand from above, to scale: soles, support polygon, and where the centre of mass goes."""

from __future__ import annotations

import numpy as np

from demos.figures.meeting import Meeting
from demos.figures.sheet import Sheet
from engine.body.kinematics import joints_of
from engine.body.support import CONTACT_M, hull, sole_points
from engine.render.scene import RULES_YELLOW, SUSTAINED_ORANGE

GROUND, SOLE, RAISED, RADIUS = "#f2f4f7", "#d5dae2", "#f8f9fb", 9.0


def draw_plan(
    sheet: Sheet,
    meeting: Meeting,
    before_m,
    after_m,
    middle: tuple[float, float],
    unit: float,
    facing_right: bool = False,
) -> None:
    """Draws it around a place of the sheet, so many units to a metre, the character facing up the page or to its right.

    before_m, after_m: the centre of mass as the yellow and the orange circle; the arrow is the threat's travel.
    """
    found = meeting.found
    about = found.support_m.mean(axis=0)

    def at(points_m) -> np.ndarray:
        ahead, left = (np.reshape(points_m, (-1, 2)) - about).T
        right, up = (ahead, left) if facing_right else (-left, ahead)
        return np.column_stack([middle[0] + unit * right, middle[1] - unit * up])

    sheet.polygon(at(found.support_m), GROUND, "faint", 1.6)
    for sole in sole_points(meeting.body, *joints_of(meeting.body, found.sustained)):
        # a heel that is raised bears nothing: the polygon leaves it out, and it is drawn paler
        bears = sole[:, 2] <= sole[:, 2].min() + CONTACT_M
        for part, fill in ((sole, RAISED), (sole[bears], SOLE)):
            sheet.polygon(at(hull(np.ascontiguousarray(part[:, :2]))), fill, "hair", 1.0, layer=5)
    before, after = (at(np.asarray(point)[:2])[0] for point in (before_m, after_m))
    sheet.line([tuple(before), tuple(after)], "ink", 1.2, layer=6)
    sheet.circle(tuple(before), RADIUS, RULES_YELLOW, "ink", 1.2, layer=8)
    sheet.circle(tuple(after), RADIUS, SUSTAINED_ORANGE, "ink", 1.2, layer=8)
    travel = np.array(meeting.threat.direction[:2]) / np.hypot(*meeting.threat.direction[:2])
    tail, tip = (at(np.asarray(after_m)[:2] - metres * travel)[0] for metres in (0.34, 0.12))
    sheet.arrow(tuple(tail), tuple(tip), "ink", 1.8, 9)
