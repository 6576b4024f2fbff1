"""A solid meshed on cells that are small where it is delicate and large where it is not, without a crack between them.

Dual meshing of an octree after Ju, Losasso, Schaefer, Warren, *Dual Contouring of Hermite Data* (2002): every smallest
edge that the surface passes joins the cells around it, whatever their sizes, so the result is closed. Vertices are then
drawn onto the surface along the gradient, as `surface.mesh` does.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from engine.render.surface import Field, Mesh, Shape, on_surface

SLACK = 1.9  # a cell is searched if the surface may be so many of its sizes from its centre: fields are not exact
AROUND = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])  # the four cells around an edge, counter-clockwise


class Leaves(NamedTuple):
    """The smallest cells, in units of the finest level."""

    low: np.ndarray  # (C, 3) int64
    size: np.ndarray  # (C,) int64, a power of two


def graded_mesh(shape: Shape, wanted_m: Callable[[np.ndarray], np.ndarray], root_m: float, levels: int) -> Mesh:
    """Meshes a shape on cells of root_m halved up to `levels` times, until small as `wanted_m` (N, 3) -> (N,) asks."""
    low = root_m * np.floor(shape.low / root_m - 1.0)  # the grid meets the origin: mirrored shapes, mirrored meshes
    unit_m = root_m / 2**levels
    leaves = _leaves(shape, low, wanted_m, root_m, levels)
    starts, axes, lengths, cells = _smallest_edges(leaves)
    values = [_at_corners(shape.field, low, unit_m, corners) for corners in (starts, _ends(starts, axes, lengths))]
    crossed = (values[0] < 0.0) != (values[1] < 0.0)
    starts, axes, lengths, cells, first, second = (
        part[crossed] for part in (starts, axes, lengths, cells, values[0], values[1])
    )
    crossing = starts.astype(float)
    crossing[np.arange(len(axes)), axes] += lengths * first / (first - second)
    used, cells = np.unique(cells, return_inverse=True)
    cells = cells.reshape(-1, 4)
    vertices = low + unit_m * _means(crossing, cells, len(used))
    vertices, normals = on_surface(shape.field, vertices, unit_m * leaves.size[used])
    turned = np.where((first < 0.0)[:, None], cells, cells[:, ::-1])
    return Mesh(vertices, normals, _triangles(turned, vertices))


def _leaves(shape: Shape, low: np.ndarray, wanted_m, root_m: float, levels: int) -> Leaves:
    """Splits what the surface may pass until small enough. Siblings stay together: neighbours are always there."""
    counts = np.ceil((shape.high + root_m - low) / root_m).astype(int)
    cells = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(-1, 3)
    lows, sizes = [], []
    for level in range(levels + 1):
        size_m, size = root_m / 2**level, 2 ** (levels - level)
        centres = low + size_m * (cells + 0.5)
        split = (np.abs(shape.field(centres)) < SLACK * size_m) & (wanted_m(centres) < 0.75 * size_m)
        if level == levels:
            split[:] = False
        lows.append(size * cells[~split])
        sizes.append(np.full(np.count_nonzero(~split), size))
        eighths = np.stack(np.meshgrid(*[[0, 1]] * 3, indexing="ij"), axis=-1).reshape(1, 8, 3)
        cells = (2 * cells[split][:, None, :] + eighths).reshape(-1, 3)
    return Leaves(np.concatenate(lows), np.concatenate(sizes))


def _smallest_edges(leaves: Leaves) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Edges that no cell around them splits further: start (E, 3), axis (E,), length (E,), the cells around (E, 4)."""
    starts, axes, lengths, cells = [], [], [], []
    find = _finder(leaves)
    for axis in range(3):
        sides = [(axis + 1) % 3, (axis + 2) % 3]
        edges = []
        for offset in ((0, 0), (0, 1), (1, 0), (1, 1)):
            start = leaves.low.copy()
            start[:, sides] += leaves.size[:, None] * offset
            edges.append(np.column_stack([start, leaves.size]))
        edge = _distinct(np.concatenate(edges))
        halves = 2 * edge[:, :3]  # in half units: places between the corners of the finest cells have odd numbers
        halves[:, axis] += 1
        around = np.empty((len(edge), 4), np.int64)
        for k, step in enumerate(AROUND):
            place = halves.copy()
            place[:, sides] += step
            around[:, k] = find(place >> 1)
        whole = (around >= 0).all(axis=1) & (leaves.size[around] >= edge[:, 3:]).all(axis=1)
        starts.append(edge[whole, :3])
        lengths.append(edge[whole, 3])
        axes.append(np.full(np.count_nonzero(whole), axis))
        cells.append(around[whole])
    return np.concatenate(starts), np.concatenate(axes), np.concatenate(lengths), np.concatenate(cells)


def _finder(leaves: Leaves) -> Callable[[np.ndarray], np.ndarray]:
    """A function from finest cells (N, 3) to the leaves that hold them (N,), -1 where none does."""
    tables = []
    for size in np.unique(leaves.size):
        rows = np.flatnonzero(leaves.size == size)
        keys = _key(leaves.low[rows])
        order = np.argsort(keys)
        tables.append((int(size), keys[order], rows[order]))

    def find(places: np.ndarray) -> np.ndarray:
        found = np.full(len(places), -1)
        for size, keys, rows in tables:
            wanted = _key(places - places % size)
            at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
            hit = keys[at] == wanted
            found[hit] = rows[at[hit]]
        return found

    return find


def _at_corners(field: Field, low: np.ndarray, unit_m: float, corners: np.ndarray) -> np.ndarray:
    """The field at grid corners (N, 3), each place asked once."""
    _, first, inverse = np.unique(_key(corners), return_index=True, return_inverse=True)
    return field(low + unit_m * corners[first])[inverse.reshape(-1)]


def _ends(starts: np.ndarray, axes: np.ndarray, lengths: np.ndarray) -> np.ndarray:
    ends = starts.copy()
    ends[np.arange(len(axes)), axes] += lengths
    return ends


def _distinct(edges: np.ndarray) -> np.ndarray:
    """Rows without repeats: start and length of an edge."""
    _, first = np.unique(_key(edges[:, :3]) * 64 + edges[:, 3], return_index=True)
    return edges[first]


def _key(places: np.ndarray) -> np.ndarray:
    """One number for each grid place (N, 3), from -1 up."""
    return ((places[:, 0] + 1) << 36) | ((places[:, 1] + 1) << 18) | (places[:, 2] + 1)


def _means(points: np.ndarray, cells: np.ndarray, count: int) -> np.ndarray:
    """(count, 3): for each cell the mean of the crossings (N, 3) on the edges around which it lies (N, 4)."""
    each = np.repeat(points, 4, axis=0)
    touched = np.maximum(np.bincount(cells.ravel(), minlength=count), 1)
    return np.stack([np.bincount(cells.ravel(), each[:, k], count) / touched for k in range(3)], axis=1)


def _triangles(quads: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Two for each ring of four, along its shorter diagonal; where one large cell is there twice, one."""
    corner = vertices[quads]
    even = np.linalg.norm(corner[:, 0] - corner[:, 2], axis=1) <= np.linalg.norm(corner[:, 1] - corner[:, 3], axis=1)
    ring = np.where(even[:, None], quads, np.roll(quads, -1, axis=1))
    triangles = np.concatenate([ring[:, [0, 1, 2]], ring[:, [0, 2, 3]]])
    a, b, c = triangles.T
    return triangles[(a != b) & (b != c) & (c != a)]
