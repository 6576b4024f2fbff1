"""What a film knows beside its pictures: distances, whose each pixel is, where joints and balls are.

distances   folder of 16 bit PNGs, millimetres along the view, 0 where nothing is
mask        folder of 8 bit PNGs: 0 nothing, 1 floor, 2 + n the n-th character, 128 + n the n-th ball
tracks      one .npz: `time_s` (F,), `joints` (21,) names, `joints_m` (F, C, 21, 3) in the world, `joints_px`
            (F, C, 21, 2) on the pictures and `joints_depth_m` (F, C, 21) along the view, `ball_m` (F, B, 3) and
            `ball_px` (F, B, 2) with NaN where there is no such ball, `eye_m`, `target_m` (F, 3) and vertical
            `fov_rad` of the camera, `size_px`, `fps`
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator

import numpy as np

from demos.filming import Moment, Shot
from engine.body.skeleton import JOINTS
from engine.core.files import whole_file
from engine.render.camera import Camera, project
from engine.render.capture import check_output
from engine.render.capture.pictures import check_folder_output, checked_measures, write_png_folder
from engine.render.measures import NOTHING
from engine.render.renderer import Renderer
from engine.render.scene import Ball, Figure

FARTHEST_MM = 65535


class GroundTruth:
    """Gathers while a film is drawn, writes when it is done: each of the three appears whole, or not at all."""

    def __init__(self, shot: Shot, depth: str | None, mask: str | None, tracks: str | None):
        """Paths, None for what is not wanted. BadInput or EnvironmentTrouble where one cannot be written."""
        self.shot, self.depth, self.mask, self.tracks = shot, depth, mask, tracks
        for folder in filter(None, (depth, mask)):
            check_folder_output(folder)
        if tracks:
            check_output(tracks)
        self._depths: list[bytes] = []
        self._masks: list[bytes] = []
        self._seen: list[tuple[float, list[Figure], list[Ball], Camera]] = []

    def witness(self, renderer: Renderer) -> Callable[[Moment, Camera], None]:
        """What `film_pictures` tells each frame to."""

        def take(now: Moment, camera: Camera) -> None:
            alive = [figure for figure in now.scene.figures if figure.alpha >= 1.0]
            self._seen.append((now.time_s, alive, list(now.scene.balls), camera))
            if self.depth or self.mask:
                measures = renderer.measure(now.scene, camera, self.shot.size_px)
                self._depths.append(_packed(in_millimetres(measures.depth_m, measures.mask)))
                self._masks.append(_packed(measures.mask))

        return take

    def write(self) -> Iterator[str]:
        """Writes all that was asked for; gives each path when it is there."""
        for path, frames, kind in ((self.depth, self._depths, np.uint16), (self.mask, self._masks, np.uint8)):
            if path:
                width, height = self.shot.size_px
                unpacked = (np.frombuffer(zlib.decompress(one), kind).reshape(height, width) for one in frames)
                write_png_folder(path, unpacked, self.shot.fps, checked=checked_measures)
                yield path
        if self.tracks:
            with whole_file(self.tracks) as part, open(part, "wb") as file:
                np.savez_compressed(file, allow_pickle=False, **self._arrays())
            yield self.tracks

    def _arrays(self) -> dict[str, np.ndarray]:
        size_px = self.shot.size_px
        cameras = [camera for *_, camera in self._seen]
        joints_m = np.array([[figure.positions for figure in figures] for _, figures, _, _ in self._seen])
        balls = max(len(thrown) for _, _, thrown, _ in self._seen)
        ball_m = np.full((len(self._seen), balls, 3), np.nan)
        for row, (_, _, thrown, _) in zip(ball_m, self._seen, strict=True):
            for place, ball in zip(row, thrown, strict=False):
                place[:] = ball.position_m
        seen = [project(camera, joints, size_px) for camera, joints in zip(cameras, joints_m, strict=True)]
        balls_px = [project(camera, places, size_px)[0] for camera, places in zip(cameras, ball_m, strict=True)]
        return {
            "time_s": np.array([time_s for time_s, *_ in self._seen]),
            "joints": np.array(JOINTS),
            "joints_m": joints_m,
            "joints_px": np.array([pixels for pixels, _ in seen]).reshape(*joints_m.shape[:3], 2),
            "joints_depth_m": np.array([depth for _, depth in seen]).reshape(joints_m.shape[:3]),
            "ball_m": ball_m,
            "ball_px": np.array(balls_px).reshape(len(cameras), balls, 2),
            "eye_m": np.array([camera.eye for camera in cameras]),
            "target_m": np.array([camera.target for camera in cameras]),
            "fov_rad": np.array(cameras[0].fov_rad),
            "size_px": np.array(size_px),
            "fps": np.array(self.shot.fps),
        }


def in_millimetres(depth_m: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """(H, W) uint16, 0 where nothing is; farther than it can tell is the farthest it can."""
    there = mask != NOTHING
    depth_mm = np.round(np.where(there, depth_m, 0.0) * 1000.0)
    return np.where(there, np.clip(depth_mm, 1, FARTHEST_MM), 0).astype(np.uint16)


def _packed(picture: np.ndarray) -> bytes:
    """Small enough to keep a film's worth."""
    return zlib.compress(np.ascontiguousarray(picture).tobytes(), 1)
