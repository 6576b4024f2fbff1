"""Solids described by a field (negative inside) and turned into smooth triangles: what the mannequin is sculpted from.

A shape is a field with its bounding box. Fields need not be true distances: vertices are pulled onto the zero set along
the gradient afterwards, and the gradient gives exact normals, so a coarse grid already looks smooth.
Blends after Inigo Quilez (polynomial smooth minimum); meshing is naive surface nets (Gibson 1998): watertight.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from engine.maths import quaternion

Field = Callable[[np.ndarray], np.ndarray]  # points (N, 3) -> (N,), negative inside

_TETRAHEDRON = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], float)


class Shape(NamedTuple):
    """A solid and the box that holds it, metres."""

    field: Field
    low: np.ndarray  # (3,)
    high: np.ndarray  # (3,)


class Mesh(NamedTuple):
    """Triangles, counter-clockwise seen from outside."""

    vertices: np.ndarray  # (V, 3)
    normals: np.ndarray  # (V, 3) unit
    triangles: np.ndarray  # (T, 3) rows of vertices


def ellipsoid(centre, radii, power: float = 2.0) -> Shape:
    """An ellipsoid; a higher power makes it boxier, as a palm or a shoe is."""
    centre, radii = np.asarray(centre, float), np.asarray(radii, float)

    def field(points):
        scaled = np.abs(points - centre) / radii
        norm = np.sum(scaled**power, axis=1) ** (1.0 / power) + 1e-9
        slope = np.sqrt(np.sum((scaled ** (power - 1.0) / radii) ** 2, axis=1)) * norm ** (1.0 - power) + 1e-9
        return (norm - 1.0) / slope

    return Shape(field, centre - radii, centre + radii)


def taper(start, end, start_radius: float, end_radius: float, flat=(1.0, 1.0, 1.0)) -> Shape:
    """Two balls and the cone between them: a limb. `flat` squeezes it along the axes, about its start."""
    start, end, flat = np.asarray(start, float), np.asarray(end, float), np.asarray(flat, float)
    axis = (end - start) / flat
    length2 = max(float(axis @ axis), 1e-12)
    slope = (start_radius - end_radius) / np.sqrt(length2)

    def field(points):
        local = (points - start) / flat
        along = np.clip(local @ axis / length2, 0.0, 1.0)
        # the cone touches its balls off their equators: shift the nearest axis point accordingly
        aside = np.linalg.norm(local - along[:, None] * axis, axis=1)
        along = np.clip(local @ axis / length2 - slope * aside / np.sqrt(length2), 0.0, 1.0)
        distance = np.linalg.norm(local - along[:, None] * axis, axis=1)
        return (distance - (start_radius + (end_radius - start_radius) * along)) * flat.min()

    radii = flat * max(start_radius, end_radius)
    return Shape(field, np.minimum(start, end) - radii, np.maximum(start, end) + radii)


def ball(centre, radius: float) -> Shape:
    """A sphere."""
    return ellipsoid(centre, (radius, radius, radius))


def blend(width_m: float, *shapes: Shape) -> Shape:
    """All of them, melted together over a width."""

    def field(points):
        total = shapes[0].field(points)
        for shape in shapes[1:]:
            total = _smooth_min(total, shape.field(points), width_m)
        return total

    grown = 0.25 * width_m
    low = np.min([shape.low for shape in shapes], axis=0) - grown
    return Shape(field, low, np.max([shape.high for shape in shapes], axis=0) + grown)


def carve(width_m: float, shape: Shape, *cutters: Field) -> Shape:
    """The shape without what is inside the cutters, edges rounded over a width."""

    def field(points):
        total = shape.field(points)
        for cutter in cutters:
            total = -_smooth_min(-total, cutter(points), width_m)
        return total

    return Shape(field, shape.low, shape.high)


def both_sides(shape: Shape) -> Shape:
    """A shape on the left, and the same mirrored on the right, in one exactly symmetrical field."""
    low, high = shape.low * (1, 0, 1) - shape.high * (0, 1, 0), shape.high
    return Shape(
        lambda points: shape.field(np.column_stack([points[:, 0], np.abs(points[:, 1]), points[:, 2]])), low, high
    )


def shifted(shape: Shape, by: np.ndarray) -> Shape:
    """The shape moved."""
    return Shape(lambda points: shape.field(points - by), shape.low + by, shape.high + by)


def placed(shape: Shape, at, turned) -> Shape:
    """The shape of a frame, seen from where that frame is `at` (3,) and `turned` (4,) w x y z."""
    at, axes = np.asarray(at, float), np.array([quaternion.rotate(tuple(turned), axis) for axis in np.eye(3)])
    corners = np.array(list(itertools.product(*zip(shape.low, shape.high, strict=True)))) @ axes + at
    return Shape(lambda points: shape.field((points - at) @ axes.T), corners.min(axis=0), corners.max(axis=0))


def near_only(shape: Shape, reach_m: float) -> Shape:
    """The same shape within a reach of its box; farther out its field is only the way to the box, which costs little.

    For what is blended over less than that reach nothing changes.
    """

    def field(points):
        away = np.linalg.norm(np.maximum(np.maximum(shape.low - points, points - shape.high), 0.0), axis=1)
        near = away < reach_m
        away[near] = shape.field(points[near])
        return away

    return Shape(field, shape.low, shape.high)


def half_space(point, outward) -> Field:
    """Everything behind a plane; as a cutter it removes that side."""
    point, outward = np.asarray(point, float), np.asarray(outward, float)
    return lambda points: (points - point) @ outward


def mesh(shape: Shape, cell_m: float) -> Mesh:
    """Surface nets on a grid of that cell, then each vertex moved onto the surface. In the shape's own frame."""
    low = shape.low - 1.5 * cell_m
    counts = np.ceil((shape.high + 1.5 * cell_m - low) / cell_m).astype(int) + 1
    grid = np.stack(np.meshgrid(*[np.arange(n) for n in counts], indexing="ij"), axis=-1)
    values = shape.field(low + cell_m * grid.reshape(-1, 3)).reshape(tuple(counts))
    rows, vertices = _cell_vertices(values)
    vertices, normals = on_surface(shape.field, low + cell_m * vertices, np.full(len(vertices), cell_m))
    return Mesh(vertices, normals, _triangles(values < 0.0, rows))


def on_surface(field: Field, points: np.ndarray, cell_m: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 3) drawn onto the zero set along the gradient, half a cell (N,) a step at most; and the normals."""
    reach = 0.5 * cell_m[:, None]
    for _ in range(3):
        value, gradient = _value_and_gradient(field, points)
        step = value[:, None] * gradient / np.maximum(np.sum(gradient**2, axis=1), 1e-6)[:, None]
        points = points - np.clip(step, -reach, reach)
    _, gradient = _value_and_gradient(field, points)
    return points, gradient / np.maximum(np.linalg.norm(gradient, axis=1), 1e-9)[:, None]


def seen_from_surface(field: Field, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(N,) about how much of what is around can be seen from surface points: 1 in the open, less in folds.

    Steps out along the normal: where the way back to the surface is shorter than the way out, something is near
    (Evans, *Fast Approximations for Global Illumination on Dynamic Scenes*, 2006).
    """
    hidden, weight = np.zeros(len(points)), 0.0
    for out_m in (0.006, 0.014, 0.030, 0.060):
        share = 1.0 / out_m**0.5
        hidden += share * np.clip(1.0 - field(points + out_m * normals) / out_m, 0.0, 1.0)
        weight += share
    return 1.0 - hidden / weight


def without_buried(piece: Mesh, covers: list[Shape], depth_m: float = 0.004) -> Mesh:
    """The mesh less what lies deep inside solids that move along with it, so can never be seen."""
    buried = np.zeros(len(piece.vertices), bool)
    for cover in covers:
        buried |= cover.field(piece.vertices) < -depth_m
    kept = piece.triangles[~buried[piece.triangles].all(axis=1)]
    used, triangles = np.unique(kept, return_inverse=True)
    return Mesh(piece.vertices[used], piece.normals[used], triangles.reshape(-1, 3))


def _smooth_min(a, b, width):
    meet = np.maximum(width - np.abs(a - b), 0.0) / width
    return np.minimum(a, b) - 0.25 * width * meet * meet


def _value_and_gradient(field: Field, points: np.ndarray, step_m: float = 1e-4) -> tuple[np.ndarray, np.ndarray]:
    """Both from the four corners of a small tetrahedron around each point: (N,) and (N, 3), errors of second order."""
    samples = np.stack([field(points + step_m * corner) for corner in _TETRAHEDRON], axis=1)
    return samples.mean(axis=1), samples @ _TETRAHEDRON / (4.0 * step_m)


def _cell_vertices(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """One vertex per cell that the surface passes through: the mean of its edges' crossings, in grid units.

    Returns the vertex row of each cell (-1 where there is none) and the vertices (V, 3).
    """
    cells = tuple(n - 1 for n in values.shape)
    total, count = np.zeros((*cells, 3)), np.zeros(cells)
    for axis in range(3):
        for first in (0, 1):
            for second in (0, 1):
                corner = np.insert([first, second], axis, 0)
                a = values[tuple(slice(c, c + n) for c, n in zip(corner, cells, strict=True))]
                corner[axis] = 1
                b = values[tuple(slice(c, c + n) for c, n in zip(corner, cells, strict=True))]
                crosses = (a < 0.0) != (b < 0.0)
                where = np.zeros(3)
                where[:] = np.insert([first, second], axis, 0)
                total[crosses] += where
                total[crosses, axis] += (a / np.where(crosses, a - b, 1.0))[crosses]
                count[crosses] += 1
    active = count > 0
    rows = np.full(cells, -1)
    rows[active] = np.arange(np.count_nonzero(active))
    return rows, np.argwhere(active) + total[active] / count[active][:, None]


def _triangles(inside: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Two triangles for each grid edge that leaves or enters the solid, joining the four cells around it."""
    quads = []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        here = np.moveaxis(inside, (axis, u, v), (0, 1, 2))[:, 1:-1, 1:-1]
        cell = np.moveaxis(rows, (axis, u, v), (0, 1, 2))
        around = np.stack([cell[:, :-1, :-1], cell[:, 1:, :-1], cell[:, 1:, 1:], cell[:, :-1, 1:]], axis=-1)
        leaves, enters = here[:-1] & ~here[1:], ~here[:-1] & here[1:]
        quads += [around[leaves], around[enters][:, ::-1]]
    corners = np.concatenate(quads)
    return np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
