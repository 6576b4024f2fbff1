"""Stance paper, fig. 3: the degrees of freedom of the full skeleton, on the neutral stance."""

from __future__ import annotations

import numpy as np

from behaviours.stance.freedoms import FREEDOMS, ROOT, count
from behaviours.stance.shape import shape
from behaviours.stance.solve import solve_shape
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet
from demos.figures.stance_shots import STANCE
from demos.figures.stills import Look, Still
from engine.body.anthropometry import standard_body
from engine.body.skeleton import HEAD, JOINT_COUNT, LEFT_HIP, PARENT, PELVIS, WAIST
from engine.core.debug_draw import DebugDraw
from engine.render.scene import Figure, Scene

LOOK = Look(0.0, 3.0)
STILL, PAGE, EDGE = 430, 760, 16.0  # widths of still and page; where the words begin
ROW = 30.0  # least distance of two words
INKED = (0.15, 0.17, 0.2)
ARMS_OUT_RAD = 0.35  # so that no arm hides a hip


def draw(press: Press) -> Sheet:
    body = standard_body()
    stance = solve_shape(body, shape(arm_out_left_rad=ARMS_OUT_RAD, arm_out_right_rad=ARMS_OUT_RAD))
    scene = Scene([Figure(body, stance.joints_m, stance.orientations, STANCE, 0.4)], draw=_bones(stance.joints_m))
    still = press.still(scene, LOOK, STILL, shadows=False)
    sheet = Sheet(still.size[1] + 40, press.scale, PAGE)
    left = 0.5 * (PAGE - STILL)
    sheet.picture(still, left, 0)
    # seen from the front the character's left is on the right
    middle = [joint for joint in FREEDOMS if WAIST <= joint <= HEAD]
    right_side = [joint for joint in FREEDOMS if _is_left(joint)]
    _words(sheet, still, left, stance.joints_m, [*middle[::-1], PELVIS], EDGE, "left")
    _words(sheet, still, left, stance.joints_m, right_side, PAGE - EDGE, "right")
    words = f"root {ROOT} + joints {count() - ROOT} = {count()} degrees of freedom; limbs twice, left and right"
    sheet.text(0.5 * PAGE, still.size[1] + 10, words, BODY, align="center")
    return sheet


def _is_left(joint: int) -> bool:
    return HEAD < joint < HEAD + 5 or LEFT_HIP <= joint < LEFT_HIP + 4


def _bones(joints_m: np.ndarray) -> DebugDraw:
    marks = DebugDraw()
    for joint in range(JOINT_COUNT):
        if PARENT[joint] >= 0:
            marks.line(joints_m[PARENT[joint]], joints_m[joint], INKED)
        if joint in FREEDOMS or joint == PELVIS:
            marks.point(joints_m[joint], 0.017, INKED)
    return marks


def _words(sheet: Sheet, still: Still, left: float, joints_m, joints, edge: float, align: str) -> None:
    """One word for each joint in a column at the edge, from the top down, with a line to its joint."""
    places = [np.add(still.at(joints_m[joint]), (left, 0.0)) for joint in joints]
    order = np.argsort([place[1] for place in places], kind="stable")
    y = 0.0
    for k in order:
        joint, (at_x, at_y) = joints[k], places[k]
        name, axes = FREEDOMS.get(joint, ("root", "XYZ"))
        y = max(at_y, y + ROW)
        words = f"{name}  {' '.join(axes)}{', place' if joint == PELVIS else ''}"
        sheet.text(edge, y, words, BODY, align=align, valign="center", halo=True)
        out = 1.0 if align == "left" else -1.0
        end = edge + out * (sheet.width_of(words) + 8.0)
        sheet.line([(end, y), (end + out * 26.0, y), (at_x - out * 6.0, at_y)], "hair", 1.2, layer=3)
    sheet.text(
        edge, max(0.0, float(min(p[1] for p in places)) - 34), "once" if align == "left" else "each twice",
        SMALL, "faint", align, italic=True,
    )  # fmt: skip
