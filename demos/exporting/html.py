"""A run as one web page that plays it: page.html, page.css and page.js with the scene inside. Nothing is fetched.

The arrays are quantised (corners to 1/32767 of the mesh, turns to 3e-5, half a tenth of a millimetre at arm's length),
laid one after the other, deflated and written as base64; a JSON head says of each [kind, byte offset, length].
"""

from __future__ import annotations

import base64
import html
import json
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from demos.exporting.footage import PHASE_NAMES, Footage
from demos.exporting.surfaces import PALETTE, Surface, ball_surface, skin_of
from demos.stage import PHASE_COLOURS
from engine.body.skeleton import PARENT
from engine.render.mesh_cache import body_key
from engine.render.scene import SUSTAINED_ORANGE

HERE = Path(__file__).resolve().parent
COARSER, COARSER_IN_CROWDS, CROWD = 1.4, 2.0, 4  # the figures' meshes, so that pages stay small; from how many on
EYE_HEIGHT_M = 0.95  # of what the camera looks at
CALM_S = 0.25  # the camera's path is the mean over so long to either side
ROOM_M = 1.5  # about the people
NEAR_M = 2.5  # what is always in the light's reach about the camera's centre
ALIGNMENT = 4
PAINT_M = 0.03  # distances from an edge of paint are told up to here


class Arrays:
    """Takes arrays, gives what the page finds each by."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.length = 0

    def add(self, array: np.ndarray, kind: str) -> list[Any]:
        packed = np.ascontiguousarray(array, dtype=np.dtype(kind).newbyteorder("<"))
        place = [kind, self.length, packed.size]
        self.parts.append(packed.tobytes() + bytes(-packed.nbytes % ALIGNMENT))
        self.length += len(self.parts[-1])
        return place

    def text(self) -> str:
        return base64.b64encode(zlib.compress(b"".join(self.parts), 9)).decode("ascii")


def html_bytes(footage: Footage, camera: tuple[float, float, float]) -> bytes:
    """The whole page; camera: azimuth and elevation in degrees and distance in metres about the people at first."""
    arrays = Arrays()
    centre, reach_m, reach_at_first_m = centre_of(footage)
    meshes, people = _people(footage, arrays)
    balls = [
        {
            "mesh": len(meshes), "radius_m": ball.radius_m, "places": arrays.add(ball.position_m, "f4"),
            "turns": arrays.add(_shares(ball.turned, 32767), "i2"), "seen": arrays.add(ball.seen, "u1"),
        }
        for ball in footage.balls
    ]  # fmt: skip
    azimuth, elevation, distance = camera
    head = {
        "title": footage.title, "fps": footage.fps, "frames": len(footage.time_s), "reach_m": reach_m,
        "camera": [azimuth, elevation, distance + 3.0 * (reach_at_first_m - NEAR_M)],
        "centre": arrays.add(centre, "f4"), "palette": [np.round(colour, 4).tolist() for colour in PALETTE],
        "meshes": [*meshes, _mesh(ball_surface(), arrays)], "people": people, "balls": balls,
        "phases": _phases(footage), "marks": footage.marks,
    }  # fmt: skip
    return _page(head, arrays.text()).encode()


def _page(head: dict[str, Any], data: str) -> str:
    # "</" would end the script that holds it
    text = json.dumps(head, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
    filled = {
        "title": html.escape(head["title"]), "style": _source("page.css"), "script": _source("page.js"),
        "head": text, "data": data,
    }  # fmt: skip
    page = _source("page.html")
    first, *rest = page.split("{{")
    for part in rest:
        name, _, after = part.partition("}}")
        first += filled[name] + after
    return first + "\n"


def _source(name: str) -> str:
    return (HERE / name).read_text(encoding="utf-8").rstrip()


def centre_of(footage: Footage) -> tuple[np.ndarray, float, float]:
    """What the camera looks at (F, 3), calm and at chest height; how far from it people ever are, and at first."""
    pelvis = np.mean([person.pose.root_m for person in footage.people], axis=0)
    wide = min(round(CALM_S * footage.fps), (len(pelvis) - 1) // 2)
    ends = np.pad(pelvis[:, :2], ((wide, wide), (0, 0)), mode="edge")
    sums = np.cumsum(np.vstack([np.zeros((1, 2)), ends]), axis=0)
    centre = np.column_stack([
        (sums[2 * wide + 1 :] - sums[: -2 * wide - 1]) / (2 * wide + 1), np.full(len(pelvis), EYE_HEIGHT_M)
    ])  # fmt: skip
    away = np.max([np.hypot(*(person.pose.root_m - centre)[:, :2].T) for person in footage.people], axis=0)
    return centre, max(NEAR_M, float(away.max()) + ROOM_M), max(NEAR_M, float(away[0]) + ROOM_M)


def _people(footage: Footage, arrays: Arrays) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """The meshes, one for each different body, and the people with their motions."""
    coarser = COARSER if len(footage.people) < CROWD else COARSER_IN_CROWDS
    known: dict[bytes, tuple[int, Surface]] = {}
    meshes: list[dict[str, Any]] = []
    people: list[dict[str, Any]] = []
    for person in footage.people:
        key = body_key(person.body)
        if key not in known:
            known[key] = (len(meshes), skin_of(person.body, coarser))
            meshes.append(_mesh(known[key][1], arrays))
        number, surface = known[key]
        people.append({
            "name": person.name, "mesh": number, "parents": PARENT.tolist(),
            "offsets": _listed(person.body.offset_m), "rest": _listed(surface.rest),
            "root": arrays.add(person.pose.root_m, "f4"),
            "turns": arrays.add(_shares(person.pose.rotations, 32767), "i2"),
        })  # fmt: skip
    return meshes, people


def _mesh(surface: Surface, arrays: Arrays) -> dict[str, Any]:
    """A surface on whole numbers; the page's vertex shader turns them back."""
    size_m = float(np.abs(surface.positions).max())
    # square roots, so that dark tones keep their steps
    mesh = {
        "size_m": size_m,
        "places": arrays.add(_four(_shares(surface.positions / size_m, 32767)), "i2"),
        "normals": arrays.add(_four(_shares(surface.normals, 127)), "i1"),
        "joints": arrays.add(surface.joints, "u1"),
        "weights": arrays.add(_shares(surface.weights, 255), "u1"),
        "colours": arrays.add(_four(_shares(np.sqrt(surface.colours), 255)), "u1"),
        "triangles": arrays.add(surface.triangles, "u2"),
    }
    if surface.paint is not None:  # sharper than colours at corners
        shares = np.column_stack([surface.paint[:, :3] / PAINT_M, surface.paint[:, 3]])
        mesh["paint"] = arrays.add(_shares(shares, 127), "i1")
    return mesh


def _shares(values: np.ndarray, whole: int) -> np.ndarray:
    return np.round(np.clip(values, -1.0, 1.0) * whole)


def _four(rows: np.ndarray) -> np.ndarray:
    """(V, 3) with a fourth column, so that each row begins at a whole word."""
    return np.column_stack([rows, np.zeros(len(rows))])


def _listed(points_m: np.ndarray) -> list[list[float]]:
    return np.round(points_m, 6).tolist()


def _phases(footage: Footage) -> list[dict[str, Any]]:
    """What the first person was about, from when on."""
    phase = footage.people[0].phase
    changes = np.flatnonzero(np.diff(phase, prepend=-1))
    return [
        {
            "name": PHASE_NAMES[phase[frame]], "from_s": round(float(footage.time_s[frame]), 4),
            "colour": _css(PHASE_COLOURS.get(phase[frame], SUSTAINED_ORANGE)),
        }
        for frame in changes
    ]  # fmt: skip


def _css(colour: tuple[float, float, float]) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour)
