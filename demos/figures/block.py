"""Fig. 3.6: what goes into the block rule and what comes out, with the running values."""

from __future__ import annotations

import numpy as np

from behaviours.rules.block import reach_m, swivel_rad
from behaviours.rules.controls import REACH_LEFT, SWIVEL_LEFT
from demos.figures.meeting import meet, palms_of, posed
from demos.figures.panel import degrees, panel
from demos.figures.press import Press
from demos.figures.sheet import Sheet, number
from demos.figures.stills import Look
from engine.body.kinematics import joints_of
from engine.body.limb_ik import arm_swivel
from engine.body.skeleton import SHOULDERS
from engine.core.debug_draw import DebugDraw
from engine.render.scene import CLIP_BLUE, RULES_YELLOW, Scene

LOOK = Look(-50.0, 10.0)
SIZE, AZIMUTH_DEG = 0.3, 20.0
DARK = (0.13, 0.15, 0.19)


def draw(press: Press) -> Sheet:
    m = meet(press.clip("stand"), 0.5, AZIMUTH_DEG, 10.0, 24.0, SIZE)
    task, controls = m.found.task, m.found.controls_initial
    b, arm_m = task.rules.block, _arm_m(m.body)
    palms, figure = palms_of(m.body, m.found.rules), posed(m.body, m.found.rules, RULES_YELLOW)
    tangent, target = np.array(m.threat.tangent), np.array(m.threat.line_point_m)
    draw, ends = DebugDraw(), [target - 1.15 * tangent, target]
    draw.arrow(ends[0], ends[1], DARK)
    for palm in palms:
        draw.point(palm, 0.022, DARK)
    ghost = posed(m.body, m.clip, CLIP_BLUE, 0.45)
    still = press.layers([Scene([ghost]), Scene([figure], draw=draw)], LOOK, 290, ends)
    reach = reach_m(controls[REACH_LEFT], b.reach_far_m, b.reach_near_m, arm_m, b.arm_share)
    inputs = [
        ("size", number(SIZE)),
        ("reach controls", number(controls[REACH_LEFT])),
        ("reach from the shoulder", f"{number(reach)} m"),
        ("swivel controls", number(controls[SWIVEL_LEFT])),
        ("swivel from down", degrees(swivel_rad(controls[SWIVEL_LEFT], b.swivel_small_rad, b.swivel_large_rad))),
        ("from the target at least", f"{number(task.rules.block.clearance_m)} m"),
        ("each to its side", f"{number(b.offset_m)} m"),
    ]
    positions, orientations = joints_of(m.body, m.found.rules)
    outputs = [("", "left, right")]
    outputs.append(
        ("palm from shoulder", _both([np.linalg.norm(palms[s] - positions[SHOULDERS[s]]) for s in range(2)], " m"))
    )
    outputs.append(("palm before target", _both([(target - palms[s]) @ tangent for s in range(2)], " m")))
    outputs.append(
        ("swivel reached", _both([np.degrees(arm_swivel(positions, orientations, s)) for s in range(2)], "°", 0))
    )
    sheet, x, y = panel(press.scale, "block", inputs, outputs, still)
    tail = np.add(still.at(ends[0]), (x, y))
    sheet.text(
        tail[0] + 4, tail[1] - 10, "line of approach", 13, align="right", valign="bottom", italic=True, halo=True
    )
    return sheet


def _arm_m(body) -> float:
    """Shoulder to wrist, stretched: the left one."""
    return float(sum(np.linalg.norm(body.offset_m[SHOULDERS[0] + k]) for k in (1, 2)))


def _both(values, unit: str, digits: int = 2) -> str:
    return ", ".join(number(float(value), digits) for value in values) + unit
