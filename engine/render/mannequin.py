"""The figure: a jointed mannequin sculpted around one Body's own bone lengths, each part rigid to its joint."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body import skeleton as sk
from engine.body.skeleton import Body
from engine.render.sculpture.arm import arm_parts
from engine.render.sculpture.head import head_parts
from engine.render.sculpture.leg import leg_parts
from engine.render.sculpture.parts import Part
from engine.render.sculpture.trunk import trunk_parts
from engine.render.surface import mesh, without_buried

REFERENCE_STATURE_M = 1.75


class MannequinMesh(NamedTuple):
    """All pieces in one buffer; positions and normals in the frame of the vertex's joint."""

    vertices: np.ndarray  # (V, 3) float32, metres
    normals: np.ndarray  # (V, 3) float32
    tags: np.ndarray  # (V, 2) float32: joint, material (sculpture.parts)
    triangles: np.ndarray  # (T, 3) int32


def mannequin_mesh(body: Body, coarser: float = 1.0) -> MannequinMesh:
    """Sculpts and meshes a body, on cells that many times larger; about a quarter of a second at full detail."""
    vertices, normals, tags, triangles, base = [], [], [], [], 0
    parts = mannequin_parts(body)
    for part in parts:
        covers = [other.shape for other in parts if other.joint == part.joint and other is not part]
        piece = without_buried(mesh(part.shape, min(coarser * part.cell_m, part.coarsest_m)), covers)
        vertices.append(piece.vertices)
        normals.append(piece.normals)
        tags.append(np.tile((part.joint, part.material), (len(piece.vertices), 1)))
        triangles.append(piece.triangles + base)
        base += len(piece.vertices)
    metres = np.concatenate(vertices) * (stature_m(body) / REFERENCE_STATURE_M)
    return MannequinMesh(
        metres.astype("f4"),
        np.concatenate(normals).astype("f4"),
        np.concatenate(tags).astype("f4"),
        np.concatenate(triangles).astype("i4"),
    )


def mannequin_parts(body: Body) -> list[Part]:
    """Every piece of one body, in reference metres."""
    reference = scaled(body, REFERENCE_STATURE_M / stature_m(body))
    parts = trunk_parts(reference, rest_positions(reference)) + head_parts(reference)
    for side in (sk.LEFT, sk.RIGHT):
        parts += arm_parts(reference, side) + leg_parts(reference, side)
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
