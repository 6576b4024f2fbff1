"""The floor and the paper behind it. Only the rectangle that shadows can reach pays for looking them up."""

from __future__ import annotations

import moderngl
import numpy as np

from engine.render.frame import Shadow
from engine.render.gpu import make_pass
from engine.render.passes.court import HALL_HIGH_M, HALL_LOW_M
from engine.render.scene import FloorStyle

SHADOW_UNIT = 1


class GroundPass:
    """Nine rectangles of floor: the shaded one in the middle, plain ones around it; together they tile it exactly."""

    def __init__(self, gl):
        self.buffer = gl.buffer(reserve=9 * 6 * 2 * 4, dynamic=True)
        self.arrays = {}
        for style, defines in (("plain", {}), ("gym", {"GYM": 1})):
            for shaded in (False, True):
                program = make_pass(gl, "floor", **defines, **({"SHADED": 1} if shaded else {}))
                if shaded:
                    program["shadow_map"] = SHADOW_UNIT
                self.arrays[style, shaded] = gl.vertex_array(program, [(self.buffer, "2f", "corner_m")])
        self.measured = gl.vertex_array(make_pass(gl, "floor_measure"), [(self.buffer, "2f", "corner_m")])
        self.backdrop_array = gl.vertex_array(make_pass(gl, "backdrop"), [])
        self.style, self.shown, self.has_shadow = "plain", False, False

    def upload(self, floor: FloorStyle, centre_m, shadow: Shadow | None) -> None:
        """Lays the rectangles around the centre (2,), as far as the floor fades; in the gymnasium from wall to wall."""
        self.style, self.shown, self.has_shadow = floor.style, floor.shown, shadow is not None
        low, high = np.subtract(centre_m, floor.fade_m), np.add(centre_m, floor.fade_m)
        if floor.style == "gym":
            low, high = HALL_LOW_M, HALL_HIGH_M
        inner_low = np.clip(shadow.floor_low_m, low, high) if shadow else low
        inner_high = np.clip(shadow.floor_high_m, low, high) if shadow else low
        xs, ys = (np.array([low[k], inner_low[k], inner_high[k], high[k]]) for k in range(2))
        cells = [(i, j) for i in range(3) for j in range(3) if (i, j) != (1, 1)] + [(1, 1)]
        corners = [_rectangle(xs[i], xs[i + 1], ys[j], ys[j + 1]) for i, j in cells]
        self.buffer.write(np.concatenate(corners).astype("f4").tobytes())

    def draw_measure(self) -> None:
        if self.shown:
            self.measured.render(moderngl.TRIANGLES, vertices=54)

    def draw(self) -> None:
        """Floor first: the backdrop only fills what is still empty."""
        if self.shown:
            self.arrays[self.style, False].render(moderngl.TRIANGLES, vertices=48)
            if self.has_shadow:
                self.arrays[self.style, True].render(moderngl.TRIANGLES, vertices=6, first=48)
        self.backdrop_array.render(moderngl.TRIANGLES, vertices=3)


def _rectangle(x0, x1, y0, y1) -> np.ndarray:
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y0), (x1, y1), (x0, y1)])
