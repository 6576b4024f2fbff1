"""`brace bench --render`: frames of one character in the gymnasium, without a screen, at the quality that it picks."""

from __future__ import annotations

import time
from collections.abc import Iterator
from statistics import median
from typing import NamedTuple

import numpy as np

from demos.filming import LOOK_AT_M, studio
from engine.render.camera import Camera, orbit_camera
from engine.render.quality import BEST, Governor, Quality, target_fps
from engine.render.renderer import Renderer
from engine.render.scene import Scene

SIZES_PX = ((1280, 720), (640, 360))
PICKING_FRAMES, MEASURED_FRAMES = 90, 30
PICKED = "what it picks"


class FrameTime(NamedTuple):
    """Medians over some frames of one size."""

    what: str
    size_px: tuple[int, int]
    quality: str
    frame_s: float  # by the wall's clock: what others do on this machine counts too
    busy_s: float  # of all processor cores together, of this process alone

    @property
    def fps(self) -> float:
        return 1.0 / self.frame_s

    @property
    def wanted_fps(self) -> float:
        return target_fps(self.size_px)


def bench() -> Iterator[FrameTime]:
    """For each size: at the level that the governor settles on, then at the best one."""
    scene, camera = one_character()
    with studio() as renderer:
        for size_px in SIZES_PX:
            picked = settled(renderer, scene, camera, size_px)
            for what, quality in ((PICKED, picked), ("the best", BEST)):
                yield timed(renderer, scene, camera, size_px, what, quality)


def one_character() -> tuple[Scene, Camera]:
    """The `sway` scenario as a ball is about to arrive, from where films are taken."""
    from demos.filming import CAMERAS, Shot, moments
    from demos.running import open_scenario, start

    simulation = start(*open_scenario("sway"))
    *_, last = moments(simulation.world, simulation.step, 120, Shot(fps=120.0))
    return last.scene, orbit_camera((*last.centre_m[:2], LOOK_AT_M), *CAMERAS["quarter"])


def settled(renderer: Renderer, scene: Scene, camera: Camera, size_px: tuple[int, int]) -> Quality:
    """Where a window of that size ends up after a few seconds."""
    governor = Governor()
    renderer.quality = governor.quality
    drawn_s(renderer, scene, camera, size_px)  # meshes and shaders are made at the first frame
    for _ in range(PICKING_FRAMES):
        before = governor.quality
        renderer.quality = governor.took(drawn_s(renderer, scene, camera, size_px)[0], size_px)
        if renderer.quality is not before:
            drawn_s(renderer, scene, camera, size_px)
    return governor.quality


def timed(renderer: Renderer, scene: Scene, camera: Camera, size_px, what: str, quality: Quality) -> FrameTime:
    renderer.quality = quality
    drawn_s(renderer, scene, camera, size_px)
    times = np.array([drawn_s(renderer, scene, camera, size_px) for _ in range(MEASURED_FRAMES)])
    return FrameTime(what, size_px, quality.name, median(times[:, 0]), median(times[:, 1]))


def drawn_s(renderer: Renderer, scene: Scene, camera: Camera, size_px) -> tuple[float, float]:
    """Seconds that one whole frame takes, and processor seconds."""
    begun_s, busy_s = time.perf_counter(), time.process_time()
    renderer.draw(scene, camera, size_px)
    renderer.finish()
    return time.perf_counter() - begun_s, time.process_time() - busy_s


def lines_of(rows: list[FrameTime]) -> list[str]:
    """The table."""
    head = f"{'one character, gymnasium':<28} {'quality':>8} {'a frame':>9} {'processor':>10} "
    return [head + f"{'frames/s':>9} {'wanted':>7}"] + [
        f"{f'{row.size_px[0]} x {row.size_px[1]}, {row.what}':<28} {row.quality:>8} {1e3 * row.frame_s:>6.1f} ms "
        f"{1e3 * row.busy_s:>7.1f} ms {row.fps:>9.0f} {row.wanted_fps:>7.0f}"
        for row in rows
    ]
