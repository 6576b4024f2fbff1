"""Stills of the running system for figures: the real renderer on white paper, through a lens that keeps sizes alike."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from engine.body.skeleton import PELVIS
from engine.render.camera import Camera, frame_all, orbit_camera, project
from engine.render.frame import TO_LIGHT
from engine.render.renderer import Renderer
from engine.render.scene import FloorStyle, Scene, extent_points

LONG_LENS_RAD = math.radians(11.0)  # across the wider side of a still
FLOOR_FADE_M = 60.0
SHADE_M = 0.5
EDGE = 5.0  # units over which a still ends
GAP_M = 0.12  # between bodies of a strip
SHADOW_DEPTH = 30.0  # a pixel this much darker than paper hides what an earlier still of a strip has there

GREY_WITHIN, DARKEST_SHADOW = 32, 110

Place = tuple[float, float]


class Still(NamedTuple):
    """A photograph and how it was taken, so that words and lines can be put on what it shows."""

    pixels: np.ndarray  # (H, W, 3) uint8
    size: Place  # width and height on the sheet, units
    camera: Camera

    def at(self, point_m) -> Place:
        """Where a point (3,) of the world is on the still, units from its top left corner."""
        x, y = self.many(np.reshape(np.asarray(point_m, float), (1, 3)))[0]
        return float(x), float(y)

    def many(self, points_m) -> np.ndarray:
        """(N, 2) units of points (N, 3)."""
        return project(self.camera, points_m, self.size)[0]


class Strip(NamedTuple):
    """Stills of one size and camera, side by side as one picture."""

    pixels: np.ndarray
    size: Place
    left: list[float]  # where each still begins, units
    each: Place  # size of one
    camera: Camera

    def at(self, which: int, point_m) -> Place:
        """Where a point of the world of one still is on the strip, units."""
        x, y = project(self.camera, np.reshape(np.asarray(point_m, float), (1, 3)), self.each)[0][0]
        return self.left[which] + float(x), float(y)


@dataclass(frozen=True)
class Look:
    """Where the photographer stands about a character that faces +X: azimuth 0 ahead, 90 on its left; elevation."""

    azimuth_deg: float = -50.0
    elevation_deg: float = 9.0

    @property
    def camera(self) -> Camera:
        return orbit_camera((0.0, 0.0, 0.9), self.azimuth_deg, self.elevation_deg, 12.0, fov_rad=LONG_LENS_RAD)


def photograph(
    renderer: Renderer, scene: Scene, camera: Camera, size: Place, scale: float, edge: float = EDGE
) -> Still:
    """The scene on white paper: the floor's shadows stay, floor and sky go (the picture is divided by the empty stage).

    `edge`: units over which the still fades out, so that a shadow that leaves it does not end at a knife's edge.
    """
    size_px = (max(16, round(size[0] * scale)), max(16, round(size[1] * scale)))
    floor = FloorStyle(lines=False, centre_m=camera.target[:2], fade_m=FLOOR_FADE_M)
    renderer.draw(replace(scene, floor=floor), camera, size_px)
    seen = renderer.read_rgb().astype(np.float32)
    renderer.draw(Scene(floor=floor), camera, size_px)
    empty = renderer.read_rgb().astype(np.float32)
    white = np.clip(seen * 255.0 / np.maximum(empty, 1.0) + 0.5, 0, 255).astype(np.uint8)
    return Still(_feathered(white, round(edge * scale)), size, camera)


def _feathered(pixels: np.ndarray, edge_px: int) -> np.ndarray:
    """Faint shadows end softly where the still ends."""
    ramps = [
        np.clip((0.5 + np.minimum(np.arange(n), np.arange(n)[::-1])) / max(edge_px, 1), 0, 1) for n in pixels.shape[:2]
    ]
    strength = (ramps[0][:, None] * ramps[1][None, :])[..., None]
    return (255.5 - (255.0 - pixels) * strength).astype(np.uint8)


def seen_points(scenes: Sequence[Scene], more_m=(), shadows: bool = True) -> np.ndarray:
    """(N, 3) of what a still must show: figures and balls, the shadows of solid ones, and further points."""
    points = [np.reshape(np.asarray(more_m, float), (-1, 3))]
    for scene in scenes:
        points.append(extent_points(scene))
        solid = Scene([f for f in scene.figures if f.alpha >= 1.0], [b for b in scene.balls if b.alpha >= 1.0])
        if shadows:
            high = extent_points(solid)
            points.append(high - high[:, 2:] * TO_LIGHT / TO_LIGHT[2])
            points += [_around(figure.positions[PELVIS]) for figure in solid.figures]
        points += [np.column_stack([b.support_m, np.zeros(len(b.support_m))]) for b in scene.balances]
    return np.vstack(points)


def _around(place_m) -> np.ndarray:
    """The rim of the soft shade that a body casts straight down."""
    turn = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    return np.column_stack([place_m[0] + SHADE_M * np.cos(turn), place_m[1] + SHADE_M * np.sin(turn), np.zeros(12)])


def framed(look: Look, points_m: np.ndarray, width: float, margin: float = 0.02) -> tuple[Camera, Place]:
    """A camera and a size in units: all points just fit a still of that width, as high as it needs to be."""
    across_m, up_m = spans_m(look, points_m)
    height = width * up_m / across_m
    fov_rad = LONG_LENS_RAD * height / max(width, height)
    return frame_all(replace(look.camera, fov_rad=fov_rad), points_m, (width, height), margin), (width, height)


def spans_m(look: Look, points_m: np.ndarray) -> Place:
    """How far points reach across and up as they are seen, metres."""
    right, up, _ = look.camera.axes()
    return float(np.ptp(points_m @ right)), float(np.ptp(points_m @ up))


def film(
    renderer: Renderer, scale: float, scenes: Sequence[Scene], look: Look, width: float,
    pitch_m: float | Sequence[float], more_m=(), shadows: bool = True,
) -> Strip:  # fmt: skip
    """Scenes around the origin, all seen alike, set out left to right in a strip of that width in units.

    pitch_m: from one origin to the next, one number or N - 1 of them (see `packed`).
    """
    points = seen_points(scenes, more_m, shadows)
    span_m = 1.04 * spans_m(look, points)[0]
    steps = np.broadcast_to(np.asarray(pitch_m, float), len(scenes) - 1)
    along = np.concatenate([[0.0], np.cumsum(steps)])
    unit = width / (span_m + along[-1])
    camera, each = framed(look, points, span_m * unit)
    left = [float(unit * x) for x in along]
    strip = np.full((max(16, round(each[1] * scale)), round(width * scale) + 2, 3), 255, np.uint8)
    # shadows fall to the left: from right to left, each body is laid over its neighbour's shadow
    for scene, x in reversed(list(zip(scenes, left, strict=True))):
        lay_over(strip, photograph(renderer, scene, camera, each, scale).pixels, round(x * scale))
    size = (strip.shape[1] / scale, strip.shape[0] / scale)
    return Strip(strip, size, left, each, camera)


def packed(scenes: Sequence[Scene], look: Look, least_m: float) -> list[float]:
    """Pitches at which no body stands in its neighbour's place: at least so much, more where somebody lies."""
    right, _, _ = look.camera.axes()
    sides = [extent_points(Scene(scene.figures)) @ right for scene in scenes]
    return [max(least_m, float(a.max() - b.min()) + GAP_M) for a, b in pairwise(sides)]


def lay_over(paper: np.ndarray, pixels: np.ndarray, x_px: int, join_shadows: bool = False) -> None:
    """Lays a still on white on what is there already, in place: its white is clear.

    With `join_shadows` its shadows (all that is grey and bright) deepen what is below instead of hiding it.
    """
    part = paper[:, x_px : x_px + pixels.shape[1]]
    pixels = pixels[:, : part.shape[1]]
    cover = np.clip((255.0 - pixels.min(axis=-1, keepdims=True)) / SHADOW_DEPTH, 0.0, 1.0)
    if join_shadows:
        coloured = np.ptp(pixels.astype(np.int16), axis=-1, keepdims=True) > GREY_WITHIN
        cover *= np.maximum(coloured, pixels.max(axis=-1, keepdims=True) < DARKEST_SHADOW)
    over = np.minimum(pixels, part) * (1.0 - cover) + pixels * cover
    part[:] = (over + 0.5).astype(np.uint8)
