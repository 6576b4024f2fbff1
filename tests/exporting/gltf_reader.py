"""A small reader of .glb files for tests, from the specification alone: it shares no line with the writer."""

from __future__ import annotations

import json
import struct

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

DTYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Glb:
    """The document, and its arrays by accessor."""

    def __init__(self, data: bytes):
        magic, self.version, self.length = struct.unpack_from("<4sII", data)
        assert magic == b"glTF"
        assert self.length == len(data)
        size, kind = struct.unpack_from("<I4s", data, 12)
        assert kind == b"JSON"
        self.json = json.loads(data[20 : 20 + size])
        start = 20 + size
        self.binary_size, kind = struct.unpack_from("<I4s", data, start)
        assert kind == b"BIN\0"
        assert start % 4 == 0
        assert start + 8 + self.binary_size == len(data)
        self.binary = data[start + 8 :]

    def array(self, number: int) -> np.ndarray:
        accessor = self.json["accessors"][number]
        view = self.json["bufferViews"][accessor["bufferView"]]
        width = WIDTHS[accessor["type"]]
        count = accessor["count"] * width
        flat = np.frombuffer(self.binary, DTYPES[accessor["componentType"]], count, view.get("byteOffset", 0))
        assert flat.nbytes == view["byteLength"]
        return flat.reshape(-1, width) if width > 1 else flat

    def pose_at(self, time_s: float) -> list[np.ndarray]:
        """The world matrix (4, 4) of every node at a time of the first animation."""
        parts = [
            {"translation": np.zeros(3), "rotation": np.array([0.0, 0, 0, 1]), "scale": np.ones(3)}
            | {key: np.array(node[key]) for key in ("translation", "rotation", "scale") if key in node}
            for node in self.json["nodes"]
        ]
        animation = self.json["animations"][0]
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            times, values = self.array(sampler["input"]).astype(float), self.array(sampler["output"]).astype(float)
            part = parts[channel["target"]["node"]]
            part[channel["target"]["path"]] = _sampled(times, values, time_s, channel["target"]["path"], sampler)
        world: list[np.ndarray] = [np.eye(4)] * len(parts)

        def descend(number: int, above: np.ndarray) -> None:
            local = np.eye(4)
            local[:3, :3] = Rotation.from_quat(parts[number]["rotation"]).as_matrix() * parts[number]["scale"]
            local[:3, 3] = parts[number]["translation"]
            world[number] = above @ local
            for child in self.json["nodes"][number].get("children", ()):
                descend(child, world[number])

        for root in self.json["scenes"][0]["nodes"]:
            descend(root, np.eye(4))
        return world


def _sampled(times, values, time_s, path, sampler):
    row = int(np.clip(np.searchsorted(times, time_s, side="right") - 1, 0, len(times) - 1))
    if sampler["interpolation"] == "STEP" or row == len(times) - 1 or time_s <= times[0]:
        return values[row]
    share = (time_s - times[row]) / (times[row + 1] - times[row])
    if path == "rotation":
        return Slerp([0.0, 1.0], Rotation.from_quat(values[row : row + 2]))(share).as_quat()
    return (1.0 - share) * values[row] + share * values[row + 1]
