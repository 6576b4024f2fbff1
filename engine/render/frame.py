"""What every pass of a frame shares, packed as `shaders/include/frame.glsl` reads it; the key light and its shadow."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.render.camera import Camera, clip_from_world, half_tangents
from engine.render.scene import Scene, extent_points

FRAME_BINDING = 0
# from the viewer's upper left when one looks down -X, high enough that shadows stay near the feet
TO_LIGHT = np.array([0.42, 0.46, 0.95]) / np.linalg.norm([0.42, 0.46, 0.95])
SHADOW_TEXEL_M = 0.005
SHADOW_MARGIN_M = 0.25


class Shadow(NamedTuple):
    """The light's view of everything that casts a shadow."""

    from_world: np.ndarray  # (4, 4) world to texture coordinates and depth, 0..1
    size_px: int
    texel_m: float
    floor_low_m: np.ndarray  # (2,) the rectangle of floor that shadows can fall on
    floor_high_m: np.ndarray  # (2,)


def fit_shadow(scene: Scene) -> Shadow | None:
    """The smallest stable map over all casters; None where nothing casts. Ghosts cast no shadow.

    Size and place move in steps, so that edges do not crawl while the casters move.
    """
    solid = Scene(
        figures=[figure for figure in scene.figures if figure.alpha >= 1.0],
        balls=[ball for ball in scene.balls if ball.alpha >= 1.0],
    )
    points = extent_points(solid)
    if len(points) == 0:
        return None
    right = np.cross((0.0, 0.0, 1.0), TO_LIGHT)
    right /= np.linalg.norm(right)
    up = np.cross(TO_LIGHT, right)
    seen = points @ np.stack([right, up, -TO_LIGHT], axis=1)
    low, high = seen.min(axis=0) - SHADOW_MARGIN_M, seen.max(axis=0) + SHADOW_MARGIN_M
    span_m = np.ceil(2.0 * max(high[0] - low[0], high[1] - low[1])) / 2.0
    size_px = int(np.clip(2 ** round(np.log2(span_m / SHADOW_TEXEL_M)), 512, 2048))
    texel_m = span_m / size_px
    centre = np.round(0.5 * (low[:2] + high[:2]) / texel_m) * texel_m
    from_world = np.eye(4)
    for row, axis, start, span in (
        (0, right, centre[0] - 0.5 * span_m, span_m),
        (1, up, centre[1] - 0.5 * span_m, span_m),
        (2, -TO_LIGHT, low[2], high[2] - low[2]),
    ):
        from_world[row, :3] = axis / span
        from_world[row, 3] = -start / span
    fallen = points[:, :2] - points[:, 2:] * TO_LIGHT[:2] / TO_LIGHT[2]
    return Shadow(
        from_world, size_px, texel_m, fallen.min(axis=0) - SHADOW_MARGIN_M, fallen.max(axis=0) + SHADOW_MARGIN_M
    )


def frame_bytes(scene: Scene, camera: Camera, size_px, shadow: Shadow | None, mirrored: bool = True) -> bytes:
    """The uniform block, std140: every member is a column-major mat4 or a vec4."""
    right, up, forward = camera.axes()
    across, upwards = half_tangents(camera, size_px)
    centre = scene.floor.centre_m or camera.target[:2]
    width, height = size_px
    block = [
        clip_from_world(camera, size_px).T.ravel(),
        (shadow.from_world if shadow else np.eye(4)).T.ravel(),
        (*camera.eye, 1.0),
        (*TO_LIGHT, float(shadow is not None)),
        (width, height, 1.0 / width, 1.0 / height),
        (*centre, scene.floor.fade_m, float(scene.floor.lines)),
        (1.0 / shadow.size_px if shadow else 1.0, shadow.texel_m if shadow else 0.0, _in_gym(scene), float(mirrored)),
        (*up, upwards),
        (*right, across),
        (*forward, 0.0),
    ]
    return np.concatenate([np.asarray(member, "f4").ravel() for member in block]).tobytes()


def _in_gym(scene: Scene) -> float:
    """1 in the gymnasium. A floor that is not shown leaves only paper."""
    return float(scene.floor.shown and scene.floor.style == "gym")
