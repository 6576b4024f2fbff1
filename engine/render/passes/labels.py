"""Words on the picture: at points of the world, and captions in the corners. Drawn last, so they stay crisp."""

from __future__ import annotations

import moderngl
import numpy as np

from engine.render.camera import Camera, project
from engine.render.glyphs import GlyphAtlas
from engine.render.gpu import Instances, make_pass
from engine.render.scene import Scene

LABEL_PX, CAPTION_PX = 15, 17
CAPTION_COLOUR = (0.20, 0.23, 0.28, 1.0)
MARGIN_PX = 16
ATLAS_UNIT = 2


class LabelPass:
    """One textured square a letter."""

    def __init__(self, gl):
        self.gl = gl
        self.program = make_pass(gl, "glyph")
        self.program["atlas"] = ATLAS_UNIT
        corners = gl.buffer(np.array([(0, 0), (0, 1), (1, 0), (1, 1)], "f4").tobytes())
        attributes = ("box_px", "box_atlas", "colour")
        self.labels, self.captions = (
            Instances(
                gl, [self.program], (corners, "2f", "corner"), "4f 4f 4f", attributes, mode=moderngl.TRIANGLE_STRIP
            )
            for _ in range(2)
        )
        self.atlases: dict[int, tuple[GlyphAtlas, moderngl.Texture]] = {}
        self.scale = 1.0

    def upload(self, scene: Scene, camera: Camera, size_px, scale: float) -> None:
        self.scale = scale
        self.labels.upload(np.concatenate([np.zeros((0, 12)), *self._labels(scene, camera, size_px, scale)]))
        self.captions.upload(np.concatenate([np.zeros((0, 12)), *self._captions(scene, size_px, scale)]))

    def draw(self) -> None:
        for letters, font_px in ((self.labels, LABEL_PX), (self.captions, CAPTION_PX)):
            if letters.count:
                self._atlas(round(font_px * self.scale))[1].use(ATLAS_UNIT)
                letters.draw()

    def _labels(self, scene: Scene, camera: Camera, size_px, scale: float) -> list[np.ndarray]:
        if scene.draw is None or not scene.draw.labels:
            return []
        atlas, _ = self._atlas(round(LABEL_PX * scale))
        pixels, depth = project(camera, [label.position_m for label in scene.draw.labels], size_px)
        seen = zip(scene.draw.labels, pixels, depth, strict=True)
        return [
            atlas.laid_out(label.text, place[0] + 8 * scale, place[1] - 0.5 * atlas.line_px, label.colour)
            for label, place, far in seen if far > 0.05
        ]  # fmt: skip

    def _captions(self, scene: Scene, size_px, scale: float) -> list[np.ndarray]:
        if not scene.captions:
            return []
        atlas, _ = self._atlas(round(CAPTION_PX * scale))
        margin, placed = MARGIN_PX * scale, []
        used: dict[str, int] = {}
        for corner, text in scene.captions:
            lines = text.splitlines()
            row = used.get(corner, 0)
            used[corner] = row + len(lines)
            for count, line in enumerate(lines):
                down = (row + count) * atlas.line_px * 1.15
                y = margin + down if corner.startswith("top") else size_px[1] - margin - atlas.line_px - down
                x = margin if corner.endswith("left") else size_px[0] - margin - atlas.width_px(line)
                placed.append(atlas.laid_out(line, x, y, CAPTION_COLOUR))
        return placed

    def _atlas(self, font_px: int) -> tuple[GlyphAtlas, moderngl.Texture]:
        if font_px not in self.atlases:
            atlas = GlyphAtlas(font_px)
            texture = self.gl.texture(
                atlas.picture.shape[1::-1], 2, np.ascontiguousarray(atlas.picture).tobytes(), alignment=1
            )
            texture.filter = (self.gl.LINEAR, self.gl.LINEAR)
            self.atlases[font_px] = (atlas, texture)
        return self.atlases[font_px]
