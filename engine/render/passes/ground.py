"""The floor and the paper behind it. Only the rectangle that shadows can reach pays for looking them up."""

from __future__ import annotations

import moderngl
import numpy as np

from engine.render.frame import Shadow
from engine.render.gpu import make_pass
from engine.render.scene import FloorStyle

SHADOW_UNIT = 1


class GroundPass:
    """Nine rectangles of floor: the shaded one in the middle, plain ones around it; together they tile it exactly."""

    def __init__(self, gl):
        self.plain, self.shaded = make_pass(gl, "floor"), make_pass(gl, "floor", SHADED=1)
        self.shaded["shadow_map"] = SHADOW_UNIT
        self.buffer = gl.buffer(reserve=9 * 6 * 2 * 4, dynamic=True)
        self.plain_array = gl.vertex_array(self.plain, [(self.buffer, "2f", "corner_m")])
        self.shaded_array = gl.vertex_array(self.shaded, [(self.buffer, "2f", "corner_m")])
        self.backdrop_array = gl.vertex_array(make_pass(gl, "backdrop"), [])
        self.plain_count = self.shaded_count = 0

    def upload(self, floor: FloorStyle, centre_m, shadow: Shadow | None) -> None:
        """Lays the rectangles around the centre (2,), as far as the floor fades."""
        low, high = np.subtract(centre_m, floor.fade_m), np.add(centre_m, floor.fade_m)
        inner_low = np.clip(shadow.floor_low_m, low, high) if shadow else low
        inner_high = np.clip(shadow.floor_high_m, low, high) if shadow else low
        xs, ys = (np.array([low[k], inner_low[k], inner_high[k], high[k]]) for k in range(2))
        cells = [(i, j) for i in range(3) for j in range(3) if (i, j) != (1, 1)] + [(1, 1)]
        corners = [_rectangle(xs[i], xs[i + 1], ys[j], ys[j + 1]) for i, j in cells]
        self.buffer.write(np.concatenate(corners).astype("f4").tobytes())
        self.plain_count, self.shaded_count = (48, 6) if floor.shown else (0, 0)

    def draw(self) -> None:
        """Floor first: the backdrop only fills what is still empty."""
        if self.plain_count:
            self.plain_array.render(moderngl.TRIANGLES, vertices=self.plain_count)
            self.shaded_array.render(moderngl.TRIANGLES, vertices=self.shaded_count, first=self.plain_count)
        self.backdrop_array.render(moderngl.TRIANGLES, vertices=3)


def _rectangle(x0, x1, y0, y1) -> np.ndarray:
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y0), (x1, y1), (x0, y1)])
