"""Lines, arrows, points and polygons: what behaviours believe, and the plan of a character's balance."""

from __future__ import annotations

import moderngl
import numpy as np

from engine.core.debug_draw import DebugDraw
from engine.render.gpu import SQUARE, Instances, make_pass
from engine.render.passes.decals import LIFT_M
from engine.render.scene import Balance, Scene

LINE_PX, ARROW_PX, OUTLINE_PX = 2.2, 2.8, 2.0
ARROW_HEAD_PX = 13.0
HIDDEN_STRENGTH = 0.22  # how much of a mark is still seen through what stands before it


class MarkPass:
    """Strokes of constant width, discs, and flat polygons."""

    def __init__(self, gl):
        self.gl = gl
        strip = moderngl.TRIANGLE_STRIP
        bar = np.array([(0, -1), (1, -1), (0, 1), (1, 1)], "f4")
        self.stroke, self.dot = make_pass(gl, "stroke"), make_pass(gl, "dot")
        self.strokes = Instances(
            gl, [self.stroke], (gl.buffer(bar.tobytes()), "2f", "corner"),
            "3f 3f 4f 2f", ("start_m", "end_m", "colour", "width_px"), mode=strip,
        )  # fmt: skip
        self.dots = Instances(
            gl,
            [self.dot],
            (gl.buffer(SQUARE.tobytes()), "2f", "corner"),
            "3f 4f 1f",
            ("centre_m", "colour", "radius_m"),
            mode=strip,
        )
        self.patch = make_pass(gl, "patch")
        self.patch_buffer = gl.buffer(reserve=4096, dynamic=True)
        self.patch_count = 0

    def upload(self, scene: Scene, scale: float) -> None:
        """scale: framebuffer pixels per window unit, so that lines are as thick on any screen."""
        draw = scene.draw or DebugDraw()
        strokes = [_line(line.points_m, line.colour, LINE_PX) for line in draw.lines]
        strokes += [row for arrow in draw.arrows for row in _arrow(arrow.points_m, arrow.colour)]
        strokes += [row for polygon in draw.polygons for row in _outline(polygon.points_m, polygon.colour)]
        strokes += [row for balance in scene.balances for row in _balance_strokes(balance)]
        bars = np.array(strokes, "f4").reshape(-1, 12)
        bars[:, 10:] *= scale
        self.strokes.upload(bars)
        dots = [(*point.position_m, *point.colour, point.radius_m) for point in draw.points]
        self.dots.upload(np.array(dots, "f4").reshape(-1, 8))
        fans = [_fan(polygon.points_m, polygon.colour * (1, 1, 1, 0.35)) for polygon in draw.polygons if polygon.filled]
        fans += [_fan(_on_floor(balance.support_m), (*balance.colour[:3], 0.26)) for balance in scene.balances]
        self._upload_patches(np.concatenate([np.zeros((0, 7)), *fans]))

    def draw_patches(self) -> None:
        if self.patch_count:
            array = self.gl.vertex_array(self.patch, [(self.patch_buffer, "3f 4f", "vertex_m", "colour")])
            array.render(moderngl.TRIANGLES, vertices=self.patch_count)

    def draw(self, hidden: bool = False) -> None:
        """Everything but patches; `hidden` for the pass that draws, faintly, what the depth test otherwise rejects."""
        for program, instances in ((self.stroke, self.strokes), (self.dot, self.dots)):
            program["strength"] = HIDDEN_STRENGTH if hidden else 1.0
            instances.draw()

    def _upload_patches(self, corners: np.ndarray) -> None:
        data = corners.astype("f4").tobytes()
        if len(data) > self.patch_buffer.size:
            self.patch_buffer = self.gl.buffer(reserve=2 * len(data), dynamic=True)
        self.patch_count = len(corners)
        if data:
            self.patch_buffer.write(data)


def _line(points_m, colour, width_px: float, end_px: float | None = None) -> tuple[float, ...]:
    return (*points_m[0], *points_m[1], *colour, width_px, width_px if end_px is None else end_px)


def _arrow(points_m, colour) -> list[tuple[float, ...]]:
    """A shaft, and a head that is as long as it is plain to see: 8 cm, or a third of a short arrow."""
    tail, tip = points_m
    length_m = float(np.linalg.norm(tip - tail))
    neck = tip - (tip - tail) * min(0.08 / max(length_m, 1e-9), 0.34)
    return [_line((tail, neck), colour, ARROW_PX), _line((neck, tip), colour, ARROW_HEAD_PX, 0.0)]


def _outline(points_m, colour) -> list[tuple[float, ...]]:
    return [_line(pair, colour, OUTLINE_PX) for pair in zip(points_m, np.roll(points_m, -1, axis=0), strict=True)]


def _balance_strokes(balance: Balance) -> list[tuple[float, ...]]:
    """The polygon's outline, and a plumb line from the centre of mass to the floor."""
    corners = _on_floor(balance.support_m)
    rows = _outline(corners, (*balance.colour[:3], 1.0)) if len(corners) > 2 else []
    if balance.com_m is not None:
        com = np.asarray(balance.com_m, float)
        rows.append(_line((com, com * (1, 1, 0)), (*(0.55 * np.asarray(balance.colour[:3])), 1.0), 1.4))
    return rows


def _on_floor(corners) -> np.ndarray:
    corners = np.asarray(corners, float)
    corners = corners.reshape(-1, corners.shape[-1] if corners.ndim > 1 else 2)[:, :2]
    return np.column_stack([corners, np.full(len(corners), 2 * LIFT_M)])


def _fan(points_m, colour) -> np.ndarray:
    """Triangles (3 K, 7) of a convex polygon, position and colour."""
    points = np.asarray(points_m, float)
    corners = [points[k] for middle in range(1, len(points) - 1) for k in (0, middle, middle + 1)]
    return np.array([(*corner, *colour) for corner in corners]).reshape(-1, 7)
