"""The figure, sculpted around one Body's own bone lengths: a smooth body in a skin, or a mannequin of rigid parts."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body import skeleton as sk
from engine.body.skeleton import Body
from engine.maths import rotations
from engine.render.adaptive import graded_mesh
from engine.render.sculpture.arm import arm_parts
from engine.render.sculpture.head import head_parts
from engine.render.sculpture.leg import leg_parts
from engine.render.sculpture.parts import JOINT, SHOE, VISOR, Part
from engine.render.sculpture.trunk import trunk_parts
from engine.render.sculpture.whole import LEVELS, ROOT_M, bind_pose, cell_m, paint_m, whole_body
from engine.render.skinning import INFLUENCES, moved_by_skin, skin_weights
from engine.render.surface import mesh, seen_from_surface, without_buried

REFERENCE_STATURE_M = 1.75
STYLES = ("smooth", "jointed")


class MannequinMesh(NamedTuple):
    """A figure in the identity pose, the pelvis's joint at the origin: X forward, Y left, Z up, metres."""

    positions: np.ndarray  # (V, 3) float32
    normals: np.ndarray  # (V, 3) float32, unit
    triangles: np.ndarray  # (T, 3) int32, counter-clockwise seen from outside
    joints: np.ndarray  # (V, 4) uint8 rows of the skeleton, the strongest first
    weights: np.ndarray  # (V, 4) float32, descending, summing to one
    paint_m: np.ndarray  # (V, 3) float32: how far from the dark parts, the glass and the shoes; negative on them
    openness: np.ndarray  # (V,) float32: 1 where the surroundings are all seen, less in folds and between fingers


def mannequin_mesh(body: Body, coarser: float = 1.0, style: str = "smooth") -> MannequinMesh:
    """Sculpts and meshes a body, on cells that many times larger. ValueError for a style not in STYLES.

    The smooth one takes a second or two at full detail, the jointed one about half a second: see `mesh_cache`.
    """
    if style not in STYLES:
        raise ValueError(f"unknown style {style!r}; the styles are {', '.join(STYLES)}")
    factor = REFERENCE_STATURE_M / stature_m(body)
    made = {"smooth": _smooth, "jointed": _jointed}[style](scaled(body, factor), coarser)
    return MannequinMesh(
        (made.positions / factor).astype("f4"),
        made.normals.astype("f4"),
        made.triangles.astype("i4"),
        made.joints.astype("u1"),
        made.weights.astype("f4"),
        made.paint_m.astype("f4"),
        made.openness.astype("f4"),
    )


def _smooth(body: Body, coarser: float) -> MannequinMesh:
    """One skin, meshed with its limbs apart and brought to the identity pose by its own weights. Reference metres."""
    bind = bind_pose(body)
    shape = whole_body(body, bind)
    skin = graded_mesh(shape, cell_m(body, bind, coarser), ROOT_M * coarser, LEVELS)
    joints, weights = skin_weights(bind, skin.vertices, skin.triangles, coarser)
    back = rotations.conjugate(bind.orientations)
    places = rest_positions(body) - rotations.rotate(back, bind.positions)
    positions, normals = moved_by_skin(skin.vertices, skin.normals, joints, weights, places, back)
    paint = paint_m(body, bind, skin.vertices)
    openness = seen_from_surface(shape.field, skin.vertices, skin.normals)
    return MannequinMesh(positions, normals, skin.triangles, joints, weights, paint, openness)


def _jointed(body: Body, coarser: float) -> MannequinMesh:
    """Rigid parts with balls between them. Reference metres."""
    positions, normals, triangles, joints, paint, base = [], [], [], [], [], 0
    parts, rest = mannequin_parts(body), rest_positions(body)
    for part in parts:
        covers = [other.shape for other in parts if other.joint == part.joint and other is not part]
        piece = without_buried(mesh(part.shape, min(coarser * part.cell_m, part.coarsest_m)), covers)
        positions.append(piece.vertices + rest[part.joint])
        normals.append(piece.normals)
        joints.append(np.tile((part.joint, 0, 0, 0), (len(piece.vertices), 1)))
        on = np.array([part.material == kind for kind in (JOINT, VISOR, SHOE)])
        paint.append(np.tile(np.where(on, -1.0, 1.0), (len(piece.vertices), 1)))
        triangles.append(piece.triangles + base)
        base += len(piece.vertices)
    whole = np.tile(np.eye(INFLUENCES)[0], (base, 1))
    return MannequinMesh(
        np.concatenate(positions), np.concatenate(normals), np.concatenate(triangles), np.concatenate(joints), whole,
        np.concatenate(paint), np.ones(base),
    )  # fmt: skip


def mannequin_parts(body: Body) -> list[Part]:
    """Every piece of the jointed figure of one body, in the body's own metres: sculpted for the reference stature."""
    parts = trunk_parts(body, rest_positions(body)) + head_parts(body)
    for side in (sk.LEFT, sk.RIGHT):
        parts += arm_parts(body, side) + leg_parts(body, side)
    return parts


def scaled(body: Body, factor: float) -> Body:
    """The body with all its lengths multiplied; masses and limits stay as they are."""
    lengths = ("offset_m", "head_top_m", "palm_m", "fingertip_m", "sole_m")
    return body._replace(**{name: factor * getattr(body, name) for name in lengths})


def rest_positions(body: Body) -> np.ndarray:
    """(21, 3) joints of the identity pose, the pelvis at the origin: frames are parallel, so offsets just add up."""
    rest = np.zeros((sk.JOINT_COUNT, 3))
    for joint in range(1, sk.JOINT_COUNT):
        rest[joint] = rest[sk.PARENT[joint]] + body.offset_m[joint]
    return rest


def stature_m(body: Body) -> float:
    """Crown to sole, standing in the identity pose."""
    rest = rest_positions(body)
    soles = min(rest[ankle][2] + body.sole_m[side, :4, 2].min() for side, ankle in enumerate(sk.ANKLES))
    return float(rest[sk.HEAD][2] + body.head_top_m[2] - soles)
