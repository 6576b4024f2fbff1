"""The binary half of a glTF 2.0 file: arrays laid one after the other, each told by a view and an accessor."""

from __future__ import annotations

import json
import struct
from typing import Any

import numpy as np

COMPONENT_TYPES = {"u1": 5121, "u2": 5123, "u4": 5125, "f4": 5126}  # glTF 2.0, 3.6.2.2
SHAPES = {(): "SCALAR", (3,): "VEC3", (4,): "VEC4", (4, 4): "MAT4"}
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
MAGIC, VERSION, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 2, 0x4E4F534A, 0x004E4942
ALIGNMENT = 4


class Buffer:
    """Takes arrays, gives the index of the accessor that stands for each."""

    def __init__(self) -> None:
        self.parts: list[bytes] = []
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self.length = 0

    def add(
        self, array: np.ndarray, kind: str, *, target: int | None = None, bounds: bool = False, normalised: bool = False
    ) -> int:
        """An array whose first axis counts, of a kind of COMPONENT_TYPES; `bounds`: states least and greatest."""
        packed = np.ascontiguousarray(array, dtype=np.dtype(kind).newbyteorder("<"))
        data = packed.tobytes()
        view = {"buffer": 0, "byteOffset": self.length, "byteLength": len(data)}
        self.views.append(view | ({"target": target} if target else {}))
        accessor: dict[str, Any] = {
            "bufferView": len(self.views) - 1, "componentType": COMPONENT_TYPES[kind], "count": len(packed),
            "type": SHAPES[packed.shape[1:]],
        }  # fmt: skip
        if normalised:
            accessor["normalized"] = True
        if bounds:
            flat = packed.reshape(len(packed), -1)
            accessor |= {"min": flat.min(axis=0).tolist(), "max": flat.max(axis=0).tolist()}
        self.accessors.append(accessor)
        self.parts.append(data + bytes(-len(data) % ALIGNMENT))
        self.length += len(self.parts[-1])
        return len(self.accessors) - 1

    def glb(self, document: dict[str, Any]) -> bytes:
        """The whole file: the rest of the document, then these arrays."""
        whole = document | {
            "accessors": self.accessors, "bufferViews": self.views, "buffers": [{"byteLength": self.length}]
        }  # fmt: skip
        text = json.dumps(whole, separators=(",", ":"), allow_nan=False).encode()
        chunks = _chunk(JSON_CHUNK, text + b" " * (-len(text) % ALIGNMENT)) + _chunk(BINARY_CHUNK, b"".join(self.parts))
        return struct.pack("<III", MAGIC, VERSION, 12 + len(chunks)) + chunks


def _chunk(kind: int, data: bytes) -> bytes:
    return struct.pack("<II", len(data), kind) + data
