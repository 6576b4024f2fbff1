"""Fig. 3.1: left the hierarchy of joints, right the identity pose and the global frame."""

from __future__ import annotations

import numpy as np

from demos.figures.meeting import posed
from demos.figures.press import Press
from demos.figures.sheet import Sheet
from demos.figures.stills import Look
from engine.body.anthropometry import standard_body
from engine.body.footing import lowest_sole_m
from engine.body.kinematics import joints_of
from engine.body.skeleton import ELBOWS, JOINTS, KNEES, PARENT, Pose
from engine.core.debug_draw import DebugDraw
from engine.maths import quaternion
from engine.render.scene import BLEND_GREY, Scene

LOOK = Look(28.0, 12.0)
AXES = (("X", (0.62, 0.0, 0.0), "#c22f2b"), ("Y", (0.0, 0.62, 0.0), "#2e8b40"), ("Z", (0.0, 0.0, 0.62), "#2a5fc4"))
# where each joint's box stands: column and row of the tree, the character seen from the front
PLACES = {
    "head": (3, 0), "neck": (3, 1), "back": (3, 2.6), "waist": (3, 4.2), "pelvis": (3, 5.4),
    "right_clavicle": (2, 1.6), "right_shoulder": (1, 2.2), "right_elbow": (1, 3.6), "right_wrist": (1, 5.0),
    "left_clavicle": (4, 1.6), "left_shoulder": (5, 2.2), "left_elbow": (5, 3.6), "left_wrist": (5, 5.0),
    "right_hip": (2, 6.3), "right_knee": (2, 7.5), "right_ankle": (2, 8.7), "right_toe": (2, 9.9),
    "left_hip": (4, 6.3), "left_knee": (4, 7.5), "left_ankle": (4, 8.7), "left_toe": (4, 9.9),
}  # fmt: skip
BOX, COLUMN, ROW, LEFT, TOP = (102, 30), 110, 68, -92, 30
HINGES = {JOINTS[j] for j in ELBOWS + KNEES}
HINGE_FILL, JOINT_FILL = "#fde7c8", "#eef1f5"


def draw(press: Press) -> Sheet:
    figure = identity()
    draw = DebugDraw()
    for joint, parent in enumerate(PARENT):
        if parent >= 0:
            draw.line(figure.positions[parent], figure.positions[joint], (0.15, 0.17, 0.2))
    for place in figure.positions:
        draw.point(place, 0.022, (0.15, 0.17, 0.2))
    tips = [np.array(axis) for _, axis, _ in AXES]
    still = press.still(Scene([figure], draw=draw), LOOK, 400, [*tips, *(1.12 * tip for tip in tips)])
    sheet = Sheet(max(TOP + 10.9 * ROW, still.size[1] + 20), press.scale)
    _tree(sheet)
    x, y = 590, 0.5 * (sheet.height - still.size[1])
    sheet.picture(still, x, y)
    origin = np.add(still.at((0.0, 0.0, 0.0)), (x, y))
    for name, axis, colour in AXES:
        tip = np.add(still.at(axis), (x, y))
        sheet.arrow(tuple(origin), tuple(tip), colour, 2.4, 11)
        label = np.add(still.at(1.13 * np.array(axis)), (x, y))
        sheet.text(label[0], label[1], f"${name}$", 20, colour, "center", "center", halo=True)
    return sheet


def identity():
    """The standing body with every joint unturned, its soles on the floor."""
    body, rotations = standard_body(), np.tile(quaternion.IDENTITY, (len(JOINTS), 1))
    low = lowest_sole_m(body, *joints_of(body, Pose(np.zeros(3), rotations)))
    return posed(body, Pose(np.array([0.0, 0.0, -low]), rotations), BLEND_GREY, 0.55)


def _tree(sheet: Sheet) -> None:
    for joint, parent in enumerate(PARENT):
        if parent >= 0:
            sheet.line([_middle(JOINTS[parent]), _middle(JOINTS[joint])], "faint", 1.4, layer=2)
    for name in JOINTS:
        x, y = _middle(name)
        fill = HINGE_FILL if name in HINGES else JOINT_FILL
        sheet.box(x - BOX[0] / 2, y - BOX[1] / 2, *BOX, fill, "faint" if name != "pelvis" else "ink", 8, layer=3)
        sheet.text(x, y - 0.5, name.replace("_", " "), 14.5, align="center", valign="center", bold=name == "pelvis")
    sheet.legend(
        22, sheet.height - 18, [(HINGE_FILL, "hinge"), (JOINT_FILL, "three axes, within anatomical limits")], 13.5
    )


def _middle(name: str) -> tuple[float, float]:
    column, row = PLACES[name]
    return LEFT + COLUMN * column + 60, TOP + ROW * row
