"""The net of the gymnasium: mesh, tapes, posts and antennae (FIVB, Rules of the Game 2021-2024, section 2)."""

from __future__ import annotations

import math

import moderngl
import numpy as np

from engine.render.gpu import make_pass
from engine.render.scene import FloorStyle

# the same hall and court as in shaders/include/hall.glsl and court.glsl
HALL_LOW_M, HALL_HIGH_M = np.array([-24.0, -13.0]), np.array([16.0, 13.0])
NET_X_M, NET_TOP_M, NET_DEEP_M, NET_HALF_M = -6.0, 2.43, 1.0, 4.75
POST_Y_M, POST_TOP_M, POST_RADIUS_M = 5.3, 2.55, 0.05
ANTENNA_Y_M, ANTENNA_TOP_M, ANTENNA_RADIUS_M = 4.5, NET_TOP_M + 0.8, 0.008
MESH, TAPE, POST, ANTENNA = range(4)


class CourtPass:
    """Scenery: neither casts shadows nor is part of masks."""

    def __init__(self, gl):
        self.gl = gl
        program = make_pass(gl, "court")
        solid, mesh = net_triangles()
        layout = ("3f 3f 3f", "vertex_m", "normal", "paint")
        buffers = [gl.buffer(part.astype("f4").tobytes()) for part in (solid, mesh)]
        self.arrays = [gl.vertex_array(program, [(buffer, *layout)]) for buffer in buffers]
        self.shown = False

    def upload(self, floor: FloorStyle) -> None:
        self.shown = floor.shown and floor.style == "gym"

    def draw(self, framebuffer: moderngl.Framebuffer) -> None:
        """Posts and tapes as solid things, then the mesh, which hides nothing behind it from later passes."""
        if not self.shown:
            return
        self.arrays[0].render(moderngl.TRIANGLES)
        self.gl.enable(moderngl.BLEND)
        self.gl.blend_func = (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA)
        framebuffer.depth_mask = False
        self.arrays[1].render(moderngl.TRIANGLES)
        framebuffer.depth_mask = True
        self.gl.disable(moderngl.BLEND)


def net_triangles() -> tuple[np.ndarray, np.ndarray]:
    """Corners (N, 9) of the solid parts and of the mesh: position, normal, place on the mesh and kind."""
    low, top = NET_TOP_M - NET_DEEP_M, NET_TOP_M
    solid = [
        _sheet(NET_HALF_M, top - 0.07, top, TAPE, 0.006),
        _sheet(NET_HALF_M, top - 0.07, top, TAPE, -0.006),
        _sheet(NET_HALF_M, low, low + 0.05, TAPE, 0.0),
    ]
    for side in (-1.0, 1.0):
        solid.append(_pole(side * POST_Y_M, 0.0, POST_TOP_M, POST_RADIUS_M, POST))
        solid.append(_pole(side * ANTENNA_Y_M, low, ANTENNA_TOP_M, ANTENNA_RADIUS_M, ANTENNA))
        for height in (top - 0.035, low + 0.025):  # what the net hangs on
            solid.append(_cord(side * NET_HALF_M, side * POST_Y_M, height))
    return np.concatenate(solid), _sheet(NET_HALF_M, low, top, MESH, 0.0)


def _sheet(half_m: float, low: float, high: float, kind: int, ahead_m: float) -> np.ndarray:
    """Across the court at the net, `ahead_m` before it."""
    corners = [(-half_m, low), (half_m, low), (half_m, high), (-half_m, low), (half_m, high), (-half_m, high)]
    return np.array([(NET_X_M + ahead_m, y, z, 1.0, 0.0, 0.0, y, z, kind) for y, z in corners])


def _cord(y0: float, y1: float, z: float) -> np.ndarray:
    sheet = _sheet(1.0, z - 0.006, z + 0.006, TAPE, 0.0)
    sheet[:, 1] = np.where(sheet[:, 1] < 0.0, y0, y1)
    return sheet


def _pole(y: float, low: float, high: float, radius: float, kind: int, sides: int = 12) -> np.ndarray:
    """An upright tube."""
    rows = []
    for k in range(sides):
        for turn, z in ((k, low), (k + 1, low), (k + 1, high), (k, low), (k + 1, high), (k, high)):
            c, s = math.cos(2.0 * math.pi * turn / sides), math.sin(2.0 * math.pi * turn / sides)
            rows.append((NET_X_M + radius * c, y + radius * s, z, c, s, 0.0, 0.0, z, kind))
    return np.array(rows)
