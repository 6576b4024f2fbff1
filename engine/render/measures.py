"""What a picture knows beside its colours: how far each pixel is, and whose it is."""

from __future__ import annotations

from typing import NamedTuple

import moderngl
import numpy as np

NOTHING, FLOOR, FIRST_FIGURE, FIRST_BALL = 0, 1, 2, 128


class Measures(NamedTuple):
    """Of one frame, top row first. Ghosts, marks, words and scenery are no part of it."""

    depth_m: np.ndarray  # (H, W) float32 along the view; infinite where nothing is
    mask: np.ndarray  # (H, W) uint8: NOTHING, FLOOR, FIRST_FIGURE + n, FIRST_BALL + n, counted as in the scene


def measuring_target(gl: moderngl.Context, size_px: tuple[int, int]) -> moderngl.Framebuffer:
    """One sample a pixel: a depth that is averaged over an edge would lie where nothing is."""
    return gl.framebuffer([gl.texture(size_px, 2, dtype="f4")], gl.depth_renderbuffer(size_px))


def measures_of(target: moderngl.Framebuffer) -> Measures:
    """Reads what was drawn into it."""
    width, height = target.size
    pixels = np.frombuffer(target.read(components=2, dtype="f4", alignment=1), "f4").reshape(height, width, 2)[::-1]
    mask = np.round(pixels[..., 1]).astype("u1")
    return Measures(np.where(mask == NOTHING, np.float32(np.inf), pixels[..., 0]), mask)
