"""What exported people and balls look like: triangles with a colour at every corner, bound to joints."""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from engine.body.skeleton import Body
from engine.render.mannequin import rest_positions
from engine.render.mesh_cache import cached_mesh
from engine.render.scene import PERSON

EDGE_M = 0.003  # over which the paint of a figure changes
FOLD_DARKNESS = 0.6  # what a corner that sees nothing of its surroundings loses of its colour

# of a volleyball: a cube blown up to a sphere, on each pair of opposite faces the middle strip and the outer two
WHITE, YELLOW, BLUE = (0.80, 0.79, 0.76), (0.86, 0.56, 0.03), (0.025, 0.10, 0.40)
PANELS = ((BLUE, YELLOW), (YELLOW, WHITE), (WHITE, BLUE))
SEAM_DARKNESS = 0.25
ALONG = np.array([0.0, 0.03, 0.2, 0.4, 0.6, 0.8, 0.97, 1.0])  # corners of a panel along it: a narrow rim for the seam
ACROSS = np.array([0.0, 0.09, 0.5, 0.91, 1.0])


def linear(srgb: np.ndarray) -> np.ndarray:
    """Colours as an artist picks them, as amounts of light (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


# linear colours of a figure: its own, the dark parts, the glass of the face, the shoes
OWN = linear(np.array(PERSON))
DARK, GLASS = np.array((0.12, 0.12, 0.125)), np.array((0.012, 0.014, 0.018))
PALETTE = (OWN, DARK, GLASS, 0.82 * DARK + 0.18 * OWN)


class Surface(NamedTuple):
    """V corners at rest: the pelvis's joint, or the ball's centre, at the origin; our axes, metres."""

    positions: np.ndarray  # (V, 3) float32
    normals: np.ndarray  # (V, 3) float32, unit
    triangles: np.ndarray  # (T, 3) int32, counter-clockwise seen from outside
    joints: np.ndarray  # (V, 4) uint8 rows of `rest`, the strongest first, 0 where the weight is 0
    weights: np.ndarray  # (V, 4) float32, summing to one
    colours: np.ndarray  # (V, 3) float64, linear light, 0 to 1, darker in folds
    rest: np.ndarray  # (J, 3) where the joints are
    # (V, 4) of figures: metres to the parts of PALETTE after the first, negative on them; then 0 in folds, 1 outside
    paint: np.ndarray | None = None


def skin_of(body: Body, coarser: float = 1.0) -> Surface:
    """The figure of a body, painted."""
    mesh = cached_mesh(body, coarser)
    joints = np.where(mesh.weights > 0.0, mesh.joints, 0).astype("u1")
    paint = np.column_stack([mesh.paint_m, mesh.openness]).astype(float)
    return Surface(
        mesh.positions, mesh.normals, mesh.triangles, joints, mesh.weights, _painted(paint), rest_positions(body), paint
    )


def _painted(paint: np.ndarray) -> np.ndarray:
    """(V, 3) linear colours from `Surface.paint`."""
    colours = np.tile(OWN, (len(paint), 1))
    for column, other in enumerate(PALETTE[1:]):
        share = np.clip(0.5 - paint[:, column, None] / EDGE_M, 0.0, 1.0)
        colours += share * (other - colours)
    return colours * (1.0 - FOLD_DARKNESS * (1.0 - paint[:, 3:]))


@lru_cache(maxsize=1)
def ball_surface() -> Surface:
    """A volleyball of radius 1: eighteen panels with dark seams, one joint."""
    points, colours, triangles, base = [], [], [], 0
    for axis in range(3):
        for sign in (1.0, -1.0):
            for strip in range(3):
                panel, shade = _panel(axis, sign, strip)
                points.append(panel.reshape(-1, 3))
                colours.append(shade.reshape(-1, 1) * np.array(PANELS[axis][strip != 1]))
                triangles.append(_quads(panel.shape[0], panel.shape[1], flipped=sign < 0.0) + base)
                base += len(points[-1])
    positions = np.concatenate(points).astype("f4")
    joints, weights = np.zeros((base, 4), "u1"), np.tile(np.array([1, 0, 0, 0], "f4"), (base, 1))
    return Surface(
        positions, positions, np.concatenate(triangles).astype("i4"), joints, weights, np.concatenate(colours),
        np.zeros((1, 3)),
    )  # fmt: skip


def _panel(axis: int, sign: float, strip: int) -> tuple[np.ndarray, np.ndarray]:
    """Corners (A, B, 3) on the unit sphere, and how bright they are (A, B): dark along the rim."""
    across, along = (2.0 * (strip + ACROSS) / 3.0 - 1.0, 2.0 * ALONG - 1.0)
    u, v = np.meshgrid(np.tan(0.25 * np.pi * across), np.tan(0.25 * np.pi * along), indexing="ij")
    corners = np.empty((*u.shape, 3))
    corners[..., axis], corners[..., (axis + 1) % 3], corners[..., (axis + 2) % 3] = sign, u, v
    shade = np.full(u.shape, SEAM_DARKNESS)
    shade[1:-1, 1:-1] = 1.0
    return corners / np.linalg.norm(corners, axis=-1, keepdims=True), shade


def _quads(rows: int, columns: int, flipped: bool) -> np.ndarray:
    """Two triangles (T, 3) for each cell of a grid of corners."""
    corner = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]
    triangles = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return triangles[:, ::-1] if flipped else triangles
