"""Characters: one static skin per body, one instanced draw for all solid figures that share it; ghosts one by one."""

from __future__ import annotations

import numpy as np

from engine.body.skeleton import JOINT_COUNT
from engine.maths import rotations
from engine.render.camera import Camera, half_tangents
from engine.render.gpu import Instances, make_pass
from engine.render.mannequin import MannequinMesh, rest_positions
from engine.render.mesh_cache import body_key, cached_mesh
from engine.render.occlusion import CAPSULES, occluders
from engine.render.scene import Figure
from engine.render.skinning import world_from_rest

SOLID, SHADOW, GHOST, MEASURE = range(4)
POSE_UNIT, SHADOW_UNIT = 0, 1
# from so many pixels a metre on, cells of the mesh grow by so much
DETAIL = ((420.0, 1.0), (210.0, 1.4), (90.0, 2.0), (0.0, 2.8))
SHADOW_DETAIL = 1.4  # nobody sees more in a shadow; still coarser, flat facets would show on the body itself

ROW_TEXELS = 2 * JOINT_COUNT + 2 * CAPSULES  # of the joint texture: dual quaternions, then what hides the sky

MeshKey = tuple[bytes, float, str]  # what the body looks like, how coarse, in which style
SKIN_LAYOUT = "3f 3f 4u1 4f 3f 1f"
SKIN_TYPES = (("f4", 3), ("f4", 3), ("u1", 4), ("f4", 4), ("f4", 3), ("f4", 1))
SKIN_ATTRIBUTES = ("vertex_m", "normal", "joint", "weight", "paint_m", "openness")


class FigurePass:
    """Draws mannequins. What the joints do travels in one texture: a row a figure, a dual quaternion a joint."""

    def __init__(self, gl):
        self.gl = gl
        self.programs = [make_pass(gl, "figure"), make_pass(gl, "figure_shadow"), make_pass(gl, "figure", GHOST=1)]
        self.programs.append(make_pass(gl, "figure_measure"))
        for program in self.programs:
            program["joints"] = POSE_UNIT
        self.programs[SOLID]["shadow_map"] = SHADOW_UNIT
        self.meshes: dict[MeshKey, Instances] = {}
        self.shadow_meshes: dict[MeshKey, Instances] = {}
        self.poses = None
        self.solid: list[tuple[Instances, int]] = []
        self.shadows: list[Instances] = []
        self.ghosts: list[tuple[Instances, int]] = []

    def upload(self, figures: list[Figure], camera: Camera, size_px, coarser: float = 1.0) -> None:
        """Solid figures are grouped by mesh; ghosts sorted from far to near, so that blending composes.

        coarser: cells grow by this much more, where drawing is slow.
        """
        solid = [figure for figure in figures if figure.alpha >= 1.0]
        ghosts = [figure for figure in figures if 0.0 < figure.alpha < 1.0]
        ghosts.sort(key=lambda figure: -_distance_m(figure, camera))
        drawn = solid + ghosts
        self._upload_poses(drawn)
        self.solid, self.shadows, placed = [], [], {}
        details = [coarseness(_distance_m(figure, camera), camera, size_px, coarser) for figure in drawn]
        for key, rows in _groups(drawn, details).items():
            instances = self._filled(self.meshes, key, drawn, rows)
            self.solid.append((instances, sum(row < len(solid) for row in rows)))
            placed.update({row: (instances, place) for place, row in enumerate(rows) if row >= len(solid)})
        for key, rows in _groups(solid, [max(detail, SHADOW_DETAIL) for detail in details]).items():
            self.shadows.append(self._filled(self.shadow_meshes, key, solid, rows))
        self.ghosts = [placed[row] for row in sorted(placed)]

    def draw_solid(self, which: int = SOLID) -> None:
        self._bind()
        for instances, count in self.solid:
            instances.draw(which, count=count)

    def draw_shadow(self) -> None:
        self._bind()
        for instances in self.shadows:
            instances.draw(SHADOW)

    def draw_ghost(self, ghost: tuple[Instances, int]) -> None:
        """One of `ghosts`, which are in drawing order."""
        self._bind()
        ghost[0].draw_one(GHOST, ghost[1])

    def _bind(self) -> None:
        if self.poses is not None:
            self.poses.use(POSE_UNIT)

    def _filled(self, meshes: dict[MeshKey, Instances], key: MeshKey, figures: list[Figure], rows) -> Instances:
        """The mesh of that key, with one copy for each of those rows of the joint texture."""
        if key not in meshes:
            meshes[key] = self._made(cached_mesh(figures[rows[0]].body, key[1], key[2]))
        copies = [(*linear(figures[row].colour), figures[row].alpha, row) for row in rows]
        meshes[key].upload(np.array(copies, "f4"))
        return meshes[key]

    def _made(self, mesh: MannequinMesh) -> Instances:
        row = np.dtype([(name, *kind) for name, kind in zip(SKIN_ATTRIBUTES, SKIN_TYPES, strict=True)])
        vertices = np.empty(len(mesh.positions), row)
        for name, values in zip(SKIN_ATTRIBUTES, (mesh.positions, mesh.normals, *mesh[3:]), strict=True):
            vertices[name] = values.reshape(vertices[name].shape)
        index = self.gl.buffer(mesh.triangles.tobytes())
        layout = (self.gl.buffer(vertices.tobytes()), SKIN_LAYOUT, *SKIN_ATTRIBUTES)
        return Instances(self.gl, self.programs, layout, "4f 1f", ("colour", "row"), index)

    def _upload_poses(self, figures: list[Figure]) -> None:
        if not figures:
            return
        if self.poses is None or self.poses.height < len(figures):
            rows = 1 << (len(figures) - 1).bit_length()
            self.poses = self.gl.texture((ROW_TEXELS, rows), 4, dtype="f4")
            self.poses.filter = (self.gl.NEAREST, self.gl.NEAREST)
        rest = np.stack([rest_positions(figure.body) for figure in figures])
        positions = np.stack([figure.positions for figure in figures])
        orientations = np.stack([figure.orientations for figure in figures])
        carried = dual_quaternions(world_from_rest(rest, positions, orientations), orientations)
        data = np.concatenate([carried.reshape(len(figures), -1, 4), occluders(figures)], axis=1)
        self.poses.write(data.astype("f4").tobytes(), viewport=(0, 0, ROW_TEXELS, len(figures)))


def _groups(figures: list[Figure], details: list[float]) -> dict[MeshKey, list[int]]:
    """Rows of the figures that share a mesh."""
    groups: dict[MeshKey, list[int]] = {}
    for row, (figure, detail) in enumerate(zip(figures, details, strict=False)):
        groups.setdefault((body_key(figure.body), detail, figure.style), []).append(row)
    return groups


def dual_quaternions(places: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """(..., 3) and (..., 4) -> (..., 2, 4) float32: real and dual part of turning first and shifting then."""
    pure = np.concatenate([np.zeros((*places.shape[:-1], 1)), places], axis=-1)
    return np.stack([turns, 0.5 * rotations.multiply(pure, turns)], axis=-2).astype("f4")


def linear(colour) -> np.ndarray:
    """sRGB as picked to linear light, for shading."""
    colour = np.asarray(colour, float)[:3]
    return np.where(colour <= 0.04045, colour / 12.92, ((colour + 0.055) / 1.055) ** 2.4)


def coarseness(distance_m: float, camera: Camera, size_px, coarser: float = 1.0) -> float:
    """How much larger triangles may be at that distance before their corners could be seen."""
    px_per_m = 0.5 * size_px[1] / (max(distance_m, 0.1) * half_tangents(camera, size_px)[1]) / coarser
    return next(cells for least_px_per_m, cells in DETAIL if px_per_m >= least_px_per_m)


def _distance_m(figure: Figure, camera: Camera) -> float:
    return float(np.linalg.norm(np.subtract(figure.positions[0], camera.eye)))
