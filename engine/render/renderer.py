"""One frame, top to bottom: shadows, solid things, floor, marks, ghosts, words. Behind any context, window or not."""

from __future__ import annotations

from typing import NamedTuple

import moderngl
import numpy as np

from engine.core.errors import EnvironmentTrouble
from engine.render.camera import Camera
from engine.render.context import Context, check_gl
from engine.render.frame import FRAME_BINDING, Shadow, fit_shadow, frame_bytes
from engine.render.gpu import make_pass
from engine.render.measures import Measures, measures_of, measuring_target
from engine.render.passes import balls, figures
from engine.render.passes.balls import BallPass
from engine.render.passes.court import CourtPass
from engine.render.passes.decals import DecalPass
from engine.render.passes.figures import FigurePass
from engine.render.passes.ground import SHADOW_UNIT, GroundPass
from engine.render.passes.labels import LabelPass
from engine.render.passes.marks import MarkPass
from engine.render.quality import BEST, Quality
from engine.render.scene import Scene

PICTURE_UNIT = 3
FRAME_BYTES = 2 * 64 + 8 * 16


class Targets(NamedTuple):
    """What is drawn into. The dummies are there because depth is only copied along with a colour."""

    key: tuple[tuple[int, int], int, float]  # size of the finished picture, samples, scale
    sampled: moderngl.Framebuffer  # multisampled colour and depth
    averaged: moderngl.Framebuffer  # one sample a pixel; the finished picture itself where the scale is 1
    smaller: moderngl.Texture  # what `averaged` holds where it is not
    picture: moderngl.Framebuffer  # the finished picture
    ghosts: moderngl.Framebuffer  # the same colour, a depth of its own for one ghost at a time
    solid_depth: moderngl.Framebuffer
    ghost_depth: moderngl.Framebuffer


class Renderer:
    """Draws scenes on a context; the finished picture waits (see read_rgb) until the context presents it.

    `quality` may be changed between frames.
    """

    def __init__(self, context: Context, quality: Quality = BEST):
        self.context, self.gl, self.quality = context, context.gl, quality
        self.frame = self.gl.buffer(reserve=FRAME_BYTES, dynamic=True)
        self.figures, self.balls, self.ground = FigurePass(self.gl), BallPass(self.gl), GroundPass(self.gl)
        self.court = CourtPass(self.gl)
        self.decals, self.marks, self.labels = DecalPass(self.gl), MarkPass(self.gl), LabelPass(self.gl)
        enlarge = make_pass(self.gl, "enlarge")
        enlarge["drawn"] = PICTURE_UNIT
        self.enlarge = self.gl.vertex_array(enlarge, [])
        self.shadow_maps: dict[int, tuple[moderngl.Framebuffer, moderngl.Texture]] = {}
        self.targets: Targets | None = None
        check_gl(self.gl, "setting up the renderer")

    def draw(self, scene: Scene, camera: Camera, size_px: tuple[int, int] | None = None) -> None:
        """One frame at the context's size or at another. A window of no size (minimised) draws nothing."""
        width, height = size_px or self.context.size_px
        if width <= 0 or height <= 0:
            return
        targets = self._targets_of((int(width), int(height)))
        shadow = fit_shadow(scene)
        self._upload(scene, camera, targets.picture.size, shadow)
        self.frame.bind_to_uniform_block(FRAME_BINDING)
        self._draw_shadow(shadow).use(SHADOW_UNIT)
        self._draw_solid(targets)
        self._draw_marks(targets)
        self._draw_ghosts(targets)
        self._finish(targets)
        check_gl(self.gl, "drawing a frame")

    def present(self) -> None:
        """Shows the last picture where the context has a screen."""
        if self.targets is not None:
            self.context.present(self.targets.picture)

    @property
    def finished(self) -> moderngl.Framebuffer:
        """The last picture, to paint on before it is shown. ValueError before the first."""
        if self.targets is None:
            raise ValueError("nothing has been drawn yet")
        return self.targets.picture

    def finish(self) -> None:
        """Waits until all that was asked for has been drawn."""
        self.gl.finish()

    def read_rgb(self) -> np.ndarray:
        """(H, W, 3) uint8 of the last picture, top row first."""
        if self.targets is None:
            raise ValueError("nothing has been drawn yet")
        width, height = self.targets.picture.size
        pixels = np.frombuffer(self.targets.picture.read(components=3, alignment=1), np.uint8)
        return np.ascontiguousarray(pixels.reshape(height, width, 3)[::-1])

    def measure(self, scene: Scene, camera: Camera, size_px: tuple[int, int]) -> Measures:
        """Depths and owners of the pixels of the picture that `draw` would make of the same; see `Measures`."""
        self._upload(scene, camera, size_px, fit_shadow(scene))
        self.frame.bind_to_uniform_block(FRAME_BINDING)
        target = measuring_target(self.gl, size_px)
        target.use()
        target.clear(depth=1.0)
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self.gl.depth_func = "<="
        self.figures.draw_solid(figures.MEASURE)
        self.balls.draw_solid(balls.MEASURE)
        self.gl.disable(moderngl.CULL_FACE)
        self.ground.draw_measure()
        measures = measures_of(target)
        check_gl(self.gl, "measuring a frame")
        return measures

    def _upload(self, scene: Scene, camera: Camera, size_px, shadow: Shadow | None) -> None:
        self.frame.write(frame_bytes(scene, camera, size_px, shadow, self.quality.mirrored))
        self.figures.upload(scene.figures, camera, size_px, self.quality.coarser)
        self.balls.upload(scene.balls, camera.eye)
        self.ground.upload(scene.floor, scene.floor.centre_m or camera.target[:2], shadow)
        self.court.upload(scene.floor)
        self.decals.upload(scene)
        self.marks.upload(scene, self.context.scale)
        self.labels.upload(scene, camera, size_px, self.context.scale)

    def _draw_shadow(self, shadow: Shadow | None) -> moderngl.Texture:
        """The depths that the key light sees, all far where nothing casts a shadow."""
        target, depths = self._shadow_map(shadow.size_px if shadow else 512)
        target.use()
        target.clear(depth=1.0)
        if shadow:
            self.gl.enable_only(moderngl.DEPTH_TEST)
            self.gl.depth_func = "<"
            self.figures.draw_shadow()
            self.balls.draw_shadow()
        return depths

    def _draw_solid(self, targets: Targets) -> None:
        targets.sampled.use()
        targets.sampled.clear(1.0, 1.0, 1.0, 1.0, depth=1.0)
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self.gl.depth_func = "<="
        self.figures.draw_solid()
        self.balls.draw_solid()
        self.gl.disable(moderngl.CULL_FACE)
        self.ground.draw()
        self.court.draw(targets.sampled)

    def _draw_marks(self, targets: Targets) -> None:
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.gl.blend_func = (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA)
        targets.sampled.depth_mask = False
        self.decals.draw_contacts()
        self.marks.draw_patches()
        self.decals.draw_marks()
        self.gl.depth_func = ">"
        self.marks.draw(hidden=True)
        self.gl.depth_func = "<="
        targets.sampled.depth_mask = True
        self.marks.draw()

    def _draw_ghosts(self, targets: Targets) -> None:
        """Far to near. Each ghost first finds its own nearest surface, then blends that alone: no bones shine through,
        and ghosts that stand in each other both stay whole, because each is tested against solid things only."""
        for ghost in self.figures.ghosts:
            self.gl.copy_framebuffer(targets.ghost_depth, targets.solid_depth)
            self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
            targets.ghosts.color_mask = (False,) * 4
            targets.ghosts.use()
            self.figures.draw_ghost(ghost)
            targets.ghosts.color_mask = (True,) * 4
            targets.ghosts.use()
            self.gl.enable(moderngl.BLEND)
            self.figures.draw_ghost(ghost)
        targets.sampled.use()
        self.gl.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE | moderngl.BLEND)
        self.balls.draw_ghosts()

    def _finish(self, targets: Targets) -> None:
        """Averages the samples, enlarges where fewer pixels were drawn, and writes words over the result."""
        self.gl.copy_framebuffer(targets.averaged, targets.sampled)
        targets.picture.use()
        if targets.averaged is not targets.picture:
            self.gl.enable_only(moderngl.NOTHING)
            targets.smaller.use(PICTURE_UNIT)
            self.enlarge.render(moderngl.TRIANGLES, vertices=3)
        self.gl.enable_only(moderngl.BLEND)
        self.labels.draw()

    def _shadow_map(self, size_px: int) -> tuple[moderngl.Framebuffer, moderngl.Texture]:
        if size_px not in self.shadow_maps:
            depth = self.gl.depth_texture((size_px, size_px))
            depth.compare_func, depth.repeat_x, depth.repeat_y = "<=", False, False
            depth.filter = (moderngl.LINEAR, moderngl.LINEAR)
            self.shadow_maps[size_px] = (self.gl.framebuffer(depth_attachment=depth), depth)
        return self.shadow_maps[size_px]

    def _targets_of(self, size_px: tuple[int, int]) -> Targets:
        """The framebuffers, made anew when size or quality change."""
        wanted = (size_px, min(self.quality.samples, self.gl.max_samples), self.quality.scale)
        if self.targets is None or self.targets.key != wanted:
            try:
                self.targets = make_targets(self.gl, *wanted)
            except moderngl.Error as trouble:
                raise EnvironmentTrouble(
                    "gl-memory", f"cannot make a picture of {size_px[0]} x {size_px[1]}: {trouble}"
                ) from trouble
        return self.targets


def make_targets(gl: moderngl.Context, size_px: tuple[int, int], samples: int, scale: float) -> Targets:
    """All framebuffers for a finished picture of one size."""
    drawn_px = (max(1, round(scale * size_px[0])), max(1, round(scale * size_px[1])))
    colour = gl.renderbuffer(drawn_px, 4, samples=samples)
    depth, ghost_depth = (gl.depth_renderbuffer(drawn_px, samples=samples) for _ in range(2))
    dummies = [gl.renderbuffer(drawn_px, 1, samples=samples) for _ in range(2)]
    picture = gl.framebuffer([gl.texture(size_px, 4)])
    smaller = gl.texture(drawn_px, 4)
    smaller.repeat_x = smaller.repeat_y = False
    return Targets(
        (size_px, samples, scale),
        sampled=gl.framebuffer([colour], depth),
        averaged=picture if drawn_px == size_px else gl.framebuffer([smaller]),
        smaller=smaller,
        picture=picture,
        ghosts=gl.framebuffer([colour], ghost_depth),
        solid_depth=gl.framebuffer([dummies[0]], depth),
        ghost_depth=gl.framebuffer([dummies[1]], ghost_depth),
    )
