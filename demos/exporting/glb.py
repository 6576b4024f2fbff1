"""A run as glTF 2.0 (.glb): skinned people and balls, moving; one animation, linear between frames.

Section numbers are those of the Khronos specification, 2.0.1. A file keeps seconds: Blender rounds them to the frame
rate of its own scene when it imports, so set that to the export's first.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from demos.exporting.footage import Footage, Person, Thrown
from demos.exporting.gltf_buffer import ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, Buffer
from demos.exporting.surfaces import Surface, ball_surface, skin_of
from engine.body.skeleton import JOINT_COUNT, JOINTS, PARENT
from engine.maths.y_up import y_up, y_up_rotations

STILL = 1e-9  # a joint that turns less than this needs no track


class Document:
    """The lists of a glTF file while it is being put together."""

    def __init__(self, time_s: np.ndarray):
        self.buffer = Buffer()
        self.nodes: list[dict[str, Any]] = []
        self.roots: list[int] = []
        self.meshes: list[dict[str, Any]] = []
        self.skins: list[dict[str, Any]] = []
        self.channels: list[dict[str, Any]] = []
        self.samplers: list[dict[str, Any]] = []
        self.times = self.buffer.add(time_s, "f4", bounds=True)

    def node(self, root: bool, **fields: Any) -> int:
        self.nodes.append(fields)
        if root:
            self.roots.append(len(self.nodes) - 1)
        return len(self.nodes) - 1

    def track(self, node: int, path: str, values: np.ndarray, times: int | None = None, step: bool = False) -> None:
        """Moves a node's translation, rotation (x y z w) or scale."""
        sampler = {
            "input": self.times if times is None else times,
            "output": self.buffer.add(values, "f4"),
            "interpolation": "STEP" if step else "LINEAR",
        }
        self.samplers.append(sampler)
        self.channels.append({"sampler": len(self.samplers) - 1, "target": {"node": node, "path": path}})


def glb_bytes(footage: Footage) -> bytes:
    """The whole file; the same footage gives the same bytes."""
    document = Document(footage.time_s)
    for person in footage.people:
        _add_person(document, person)
    if footage.balls:
        mesh = _add_mesh(document, "volleyball", ball_surface(), skinned=False)
        for number, ball in enumerate(footage.balls):
            _add_ball(document, f"ball_{number}", ball, mesh, footage.time_s)
    material = {"metallicFactor": 0.0, "roughnessFactor": 0.65}
    return document.buffer.glb(
        {
            "asset": {"version": "2.0", "generator": "Brace"},
            "scene": 0,
            "scenes": [{"name": footage.title, "nodes": document.roots}],
            "nodes": document.nodes,
            "meshes": document.meshes,
            "skins": document.skins,
            "materials": [{"name": "painted", "pbrMetallicRoughness": material}],
            "animations": [{"name": footage.title, "channels": document.channels, "samplers": document.samplers}],
        }
    )


def _add_person(document: Document, person: Person) -> None:
    """A tree of joints that moves, and beside it the skin that follows: skinned meshes are roots (3.7.3.3)."""
    surface = skin_of(person.body)
    turns, places = xyzw(y_up_rotations(person.pose.rotations)), y_up(person.pose.root_m)
    offsets = y_up(person.body.offset_m)
    first = len(document.nodes)
    for joint, name in enumerate(JOINTS):
        place = places[0] if joint == 0 else offsets[joint]
        children = [first + int(child) for child in np.flatnonzero(np.equal(PARENT, joint))]
        node = document.node(joint == 0, name=name, translation=place.tolist(), rotation=turns[0, joint].tolist())
        if children:
            document.nodes[node]["children"] = children
    document.track(first, "translation", places)
    for joint in range(JOINT_COUNT):
        if np.abs(np.diff(turns[:, joint], axis=0)).max(initial=0.0) > STILL:
            document.track(first + joint, "rotation", turns[:, joint])
    bind = np.tile(np.eye(4), (JOINT_COUNT, 1, 1))
    bind[:, 3, :3] = -y_up(surface.rest)  # column-major: the last row in memory is the last column (3.6.2.1)
    joints = list(range(first, first + JOINT_COUNT))
    document.skins.append(
        {"name": person.name, "joints": joints, "inverseBindMatrices": document.buffer.add(bind, "f4")}
    )
    mesh = _add_mesh(document, person.name, surface, skinned=True)
    document.node(True, name=person.name, mesh=mesh, skin=len(document.skins) - 1)


def _add_ball(document: Document, name: str, ball: Thrown, mesh: int, time_s: np.ndarray) -> None:
    """A node that flies; while there is no ball it has no size."""
    places, turns = y_up(ball.position_m), xyzw(y_up_rotations(ball.turned))
    sizes = np.where(ball.seen, ball.radius_m, 0.0)[:, None] * np.ones(3)
    node = document.node(
        True, name=name, mesh=mesh,
        translation=places[0].tolist(), rotation=turns[0].tolist(), scale=sizes[0].tolist(),
    )  # fmt: skip
    document.track(node, "translation", places)
    document.track(node, "rotation", turns)
    changes = np.flatnonzero(np.diff(ball.seen, prepend=~ball.seen[0]))
    times = document.buffer.add(time_s[changes], "f4", bounds=True)
    document.track(node, "scale", sizes[changes], times, step=True)


def _add_mesh(document: Document, name: str, surface: Surface, skinned: bool) -> int:
    add = document.buffer.add
    colours = np.column_stack([np.round(255.0 * surface.colours), np.full(len(surface.colours), 255.0)])
    attributes = {
        "POSITION": add(y_up(surface.positions), "f4", target=ARRAY_BUFFER, bounds=True),
        "NORMAL": add(y_up(surface.normals), "f4", target=ARRAY_BUFFER),
        "COLOR_0": add(colours, "u1", target=ARRAY_BUFFER, normalised=True),
    }
    if skinned:
        attributes["JOINTS_0"] = add(surface.joints, "u1", target=ARRAY_BUFFER)
        attributes["WEIGHTS_0"] = add(surface.weights, "f4", target=ARRAY_BUFFER)
    kind = "u2" if len(surface.positions) < 65535 else "u4"  # the greatest number is reserved (3.7.2.1)
    indices = add(surface.triangles.reshape(-1), kind, target=ELEMENT_ARRAY_BUFFER)
    document.meshes.append(
        {"name": name, "primitives": [{"attributes": attributes, "indices": indices, "material": 0}]}
    )
    return len(document.meshes) - 1


def xyzw(quaternions: np.ndarray) -> np.ndarray:
    """w x y z as glTF has it, the scalar last."""
    return quaternions[..., [1, 2, 3, 0]]
