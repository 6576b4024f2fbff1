"""Stance paper, fig. 8: where the free hip can be, and which of those places is taken. The running lower body.

i) The free foot and the root hip are known; the free hip is somewhere on a circle about the line between them. ii) The
hip vector as the pelvis's orientation asks for it meets the circle's plane at the cross; the nearest point of the
circle is taken.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from behaviours.stance import footprints, lower_body
from behaviours.stance.shape import LEFT_FOOT, shape
from behaviours.stance.solve import StanceResult, solve_shape
from demos.figures.press import Press
from demos.figures.sheet import BODY, TITLE, Sheet
from demos.figures.stills import Look, framed
from engine.body.anthropometry import standard_body
from engine.body.skeleton import ANKLES, HIPS, KNEES, LEFT, RIGHT
from engine.render.camera import Camera, project

WHOLE, CLOSE = Look(52.0, 12.0), Look(30.0, 34.0)  # panels i and ii
PANELS = ((24.0, 400.0), (500.0, 470.0))  # left edge and width of each
TOP = 44.0
ROOT, FREE = LEFT, RIGHT
ASKED = shape(
    dominant=LEFT_FOOT, knee_left_rad=0.35, knee_right_rad=0.75, pelvis_y_rad=-0.3, pelvis_z_rad=0.3, balance_x=0.3
)  # fmt: skip
WIDTH_M = 0.62
LEG, CIRCLE, WANTED = "#5b6573", "#2a5fc4", "#b3261e"


class Geometry(NamedTuple):
    """The four points, and the circle of the free hip. World metres."""

    root_hip: np.ndarray
    free_hip: np.ndarray
    free_ankle: np.ndarray
    centre: np.ndarray  # of the circle
    axis: np.ndarray  # (3,) unit, from the root hip to the free ankle
    radius_m: float
    crossing: np.ndarray  # where the wanted hip vector, extended, meets the circle's plane


class Panel(NamedTuple):
    """A view of the world on a part of the sheet."""

    sheet: Sheet
    camera: Camera
    corner: tuple[float, float]
    size: tuple[float, float]

    def at(self, point_m) -> tuple[float, float]:
        return self.path([point_m])[0]

    def path(self, points_m) -> list[tuple[float, float]]:
        places = project(self.camera, np.reshape(np.asarray(points_m, float), (-1, 3)), self.size)[0]
        return [(float(x) + self.corner[0], float(y) + self.corner[1]) for x, y in places]


def draw(press: Press) -> Sheet:
    body = standard_body()
    stance = solve_shape(body, ASKED, footprints.stand(body, width_m=WIDTH_M))
    found = geometry(stance)
    ring = circle(found)
    legs = np.array([stance.joints_m[chain[side]] for side in (ROOT, FREE) for chain in (HIPS, KNEES, ANKLES)])
    soles = np.vstack([[*corner, 0.0] for corner in support_corners(body, stance)])
    sheet = Sheet(TOP + 520.0, press.scale)
    whole = _panel(sheet, WHOLE, np.vstack([legs, ring, soles]), 0)
    close = _panel(sheet, CLOSE, np.vstack([ring, found.root_hip[None], found.crossing[None]]), 1)
    _first(whole, stance, found, ring, soles)
    _second(close, found, ring)
    return sheet


def geometry(stance: StanceResult) -> Geometry:
    """The points of figure 8 of a solved stance whose root is the left leg."""
    asked = stance.plan.lower
    hips = lower_body.hips_of(asked, stance.balance_rad)
    root_hip, free_hip, ankle = np.array(hips[ROOT]), np.array(hips[FREE]), asked.ankle_m[FREE]
    axis = (ankle - root_hip) / np.linalg.norm(ankle - root_hip)
    along = float((free_hip - root_hip) @ axis)
    centre = root_hip + along * axis
    crossing = root_hip + asked.hip_vector * along / float(asked.hip_vector @ axis)
    return Geometry(root_hip, free_hip, ankle, centre, axis, float(np.linalg.norm(free_hip - centre)), crossing)


def circle(found: Geometry, points: int = 121) -> np.ndarray:
    """(points, 3) all places of the free hip."""
    first = found.free_hip - found.centre
    second = np.cross(found.axis, first)
    turn = np.linspace(0.0, 2.0 * np.pi, points)[:, None]
    return found.centre + np.cos(turn) * first + np.sin(turn) * second


def support_corners(body, stance: StanceResult) -> np.ndarray:
    """(n, 2) of both soles together."""
    from behaviours.stance.measures import measures

    return measures(body, stance).support_m


def _panel(sheet: Sheet, look: Look, points_m: np.ndarray, which: int) -> Panel:
    left, width = PANELS[which]
    camera, size = framed(look, points_m, width, 0.03)
    room = sheet.height - TOP - 30.0
    if size[1] > room:
        camera, size = framed(look, points_m, width * room / size[1], 0.03)
    return Panel(sheet, camera, (left + 0.5 * (width - size[0]), TOP + 0.5 * (room - size[1])), size)


def _first(panel: Panel, stance: StanceResult, found: Geometry, ring: np.ndarray, soles: np.ndarray) -> None:
    sheet = panel.sheet
    sheet.text(PANELS[0][0], 8, "i)", TITLE, italic=True)
    sheet.polygon(panel.path(soles), "#eef1f5", "hair", 1.2)
    for side in (ROOT, FREE):
        chain = [stance.joints_m[joints[side]] for joints in (HIPS, KNEES, ANKLES)]
        sheet.line(panel.path(chain), LEG, 7.0 if side == ROOT else 4.0, layer=6)
    sheet.line(panel.path(ring), CIRCLE, 2.2)
    sides = (
        ("A", found.free_ankle, found.root_hip, 0.6, 14), ("B", found.root_hip, found.free_hip, 0.5, 0),
        ("C", found.free_ankle, found.free_hip, 0.75, -16),
    )  # fmt: skip
    for name, start, end, share, aside in sides:
        sheet.line(panel.path([start, end]), "ink", 1.8, dashed=True, layer=7)
        x, y = panel.at((1.0 - share) * start + share * end)
        sheet.text(x + aside, y - 14 * (aside == 0), name, BODY + 3, "ink", "center", "center", italic=True, halo=True)
    x, y = panel.at(ring[np.argmax([place[0] for place in panel.path(ring)])])
    sheet.text(x + 10, y, "all places of the free hip", BODY, CIRCLE, valign="center")
    ankle = stance.joints_m[ANKLES[ROOT]]
    _dots(panel, ((found.root_hip, "root hip", 1), (found.free_hip, "free hip", -1)))
    _dots(panel, ((found.free_ankle, "free ankle", -1), (ankle, "root ankle", 1)))


def _second(panel: Panel, found: Geometry, ring: np.ndarray) -> None:
    sheet = panel.sheet
    sheet.text(PANELS[1][0], 8, "ii)", TITLE, italic=True)
    sheet.polygon(panel.path(ring), "#dfe7f7", CIRCLE, 2.2)
    sheet.line(panel.path([found.root_hip, found.crossing]), WANTED, 2.0)
    x, y = panel.at(0.5 * (found.root_hip + found.crossing))
    sheet.text(x, y - 8, "hip vector as asked for", BODY, WANTED, "center", "bottom", halo=True)
    cross = panel.at(found.crossing)
    for way in (1.0, -1.0):
        sheet.line([(cross[0] - 8, cross[1] - way * 8), (cross[0] + 8, cross[1] + way * 8)], WANTED, 2.6, layer=9)
    sheet.arrow(cross, panel.at(found.free_hip), "ink", 1.8, 11)
    sheet.line(panel.path([found.root_hip, found.free_hip]), LEG, 4.0, layer=6)
    sheet.line(panel.path([found.centre, found.free_hip]), "faint", 1.2, dashed=True)
    sheet.line(panel.path([found.root_hip, found.centre]), "ink", 1.8, dashed=True)
    x, y = panel.at(0.5 * (found.root_hip + found.centre))
    sheet.text(x + 12, y, "A", BODY + 3, valign="center", italic=True, halo=True)
    _dots(panel, ((found.root_hip, "root hip", 1), (found.free_hip, "free hip", -1), (found.centre, "", 1)))


def _dots(panel: Panel, named: Sequence[tuple[np.ndarray, str, int]]) -> None:
    """Points with their words to the right (1) or to the left (-1)."""
    for point, words, way in named:
        x, y = panel.at(point)
        panel.sheet.circle((x, y), 5.0, fill="white", edge="ink", line=1.8, layer=9)
        panel.sheet.text(x + 12 * way, y, words, BODY, align="left" if way > 0 else "right", valign="center", halo=True)
