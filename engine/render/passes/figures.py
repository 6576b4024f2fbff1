"""Characters: one static mesh per body, one instanced draw for all solid figures that share it; ghosts one by one."""

from __future__ import annotations

import numpy as np

from engine.body.skeleton import JOINT_COUNT, Body
from engine.render.camera import Camera, half_tangents
from engine.render.gpu import Instances, make_pass
from engine.render.mannequin import mannequin_mesh
from engine.render.scene import Figure

SOLID, SHADOW, GHOST = range(3)
POSE_UNIT, SHADOW_UNIT = 0, 1
# from so many pixels a metre on, cells of the mesh grow by so much
DETAIL = ((320.0, 1.0), (120.0, 1.4), (0.0, 1.8))

MeshKey = tuple[bytes, float]  # what the body looks like, how coarse


class FigurePass:
    """Draws mannequins. Joint transforms travel in one texture: a row a figure, three texels a joint."""

    def __init__(self, gl):
        self.gl = gl
        self.programs = [make_pass(gl, "figure"), make_pass(gl, "figure_shadow"), make_pass(gl, "figure", GHOST=1)]
        for program in self.programs:
            program["joints"] = POSE_UNIT
        self.programs[SOLID]["shadow_map"] = SHADOW_UNIT
        self.meshes: dict[MeshKey, Instances] = {}
        self.poses = None
        self.solid: list[tuple[Instances, int]] = []
        self.ghosts: list[tuple[Instances, int]] = []

    def upload(self, figures: list[Figure], camera: Camera, size_px) -> None:
        """Solid figures are grouped by mesh; ghosts sorted from far to near, so that blending composes."""
        solid = [figure for figure in figures if figure.alpha >= 1.0]
        ghosts = [figure for figure in figures if 0.0 < figure.alpha < 1.0]
        ghosts.sort(key=lambda figure: -_distance_m(figure, camera))
        groups: dict[MeshKey, list[tuple[int, Figure]]] = {}
        for row, figure in enumerate(solid + ghosts):
            key = (body_key(figure.body), coarseness(_distance_m(figure, camera), camera, size_px))
            groups.setdefault(key, []).append((row, figure))
        self._upload_poses(solid + ghosts)
        self.solid, placed = [], {}
        for key, members in groups.items():
            instances = self._mesh(key, members[0][1].body)
            rows = [(*linear(figure.colour), figure.alpha, row) for row, figure in members]
            instances.upload(np.array(rows, "f4"))
            self.solid.append((instances, sum(row < len(solid) for row, _ in members)))
            placed.update({row: (instances, place) for place, (row, _) in enumerate(members) if row >= len(solid)})
        self.ghosts = [placed[row] for row in sorted(placed)]

    def draw_solid(self) -> None:
        self._draw_solid(SOLID)

    def draw_shadow(self) -> None:
        self._draw_solid(SHADOW)

    def draw_ghost(self, ghost: tuple[Instances, int]) -> None:
        """One of `ghosts`, which are in drawing order."""
        self._bind()
        ghost[0].draw_one(GHOST, ghost[1])

    def _draw_solid(self, which: int) -> None:
        self._bind()
        for instances, count in self.solid:
            instances.draw(which, count=count)

    def _bind(self) -> None:
        if self.poses is not None:
            self.poses.use(POSE_UNIT)

    def _mesh(self, key: MeshKey, body: Body) -> Instances:
        if key not in self.meshes:
            mesh = mannequin_mesh(body, coarser=key[1])
            buffer = self.gl.buffer(np.hstack([mesh.vertices, mesh.normals, mesh.tags]).astype("f4").tobytes())
            index = self.gl.buffer(mesh.triangles.astype("i4").tobytes())
            layout = (buffer, "3f 3f 2f", "vertex_m", "normal", "tag")
            self.meshes[key] = Instances(self.gl, self.programs, layout, "4f 1f", ("colour", "row"), index)
        return self.meshes[key]

    def _upload_poses(self, figures: list[Figure]) -> None:
        if not figures:
            return
        if self.poses is None or self.poses.height < len(figures):
            rows = 1 << (len(figures) - 1).bit_length()
            self.poses = self.gl.texture((3 * JOINT_COUNT, rows), 4, dtype="f4")
            self.poses.filter = (self.gl.NEAREST, self.gl.NEAREST)
        positions = np.stack([figure.positions for figure in figures])
        orientations = np.stack([figure.orientations for figure in figures])
        data = world_from_joint(positions, orientations)
        self.poses.write(np.ascontiguousarray(data, "f4"), viewport=(0, 0, 3 * JOINT_COUNT, len(figures)))


def world_from_joint(positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """(N, J, 3) and (N, J, 4) -> (N, J, 3, 4) float32: the upper three rows of each joint's transform."""
    w, x, y, z = np.moveaxis(np.asarray(orientations, float), -1, 0)
    out = np.empty((*w.shape, 3, 4), "f4")
    out[..., 0, 0], out[..., 0, 1], out[..., 0, 2] = 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)
    out[..., 1, 0], out[..., 1, 1], out[..., 1, 2] = 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)
    out[..., 2, 0], out[..., 2, 1], out[..., 2, 2] = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
    out[..., 3] = positions
    return out


def body_key(body: Body) -> bytes:
    """What the mesh depends on: figures whose bodies agree in it share one."""
    return b"".join(np.asarray(part, float).tobytes() for part in body[:5])


def linear(colour) -> np.ndarray:
    """sRGB as picked to linear light, for shading."""
    colour = np.asarray(colour, float)[:3]
    return np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)


def coarseness(distance_m: float, camera: Camera, size_px) -> float:
    """How much larger triangles may be at that distance before their corners could be seen."""
    px_per_m = 0.5 * size_px[1] / (max(distance_m, 0.1) * half_tangents(camera, size_px)[1])
    return next(coarser for least_px_per_m, coarser in DETAIL if px_per_m >= least_px_per_m)


def _distance_m(figure: Figure, camera: Camera) -> float:
    return float(np.linalg.norm(np.subtract(figure.positions[0], camera.eye)))
