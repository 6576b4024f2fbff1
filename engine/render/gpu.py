"""Small helpers on moderngl: programs bound to the frame block, and buffers that grow with what is drawn."""

from __future__ import annotations

import moderngl
import numpy as np

from engine.render.frame import FRAME_BINDING
from engine.render.shader_source import make_program

# two triangles as a strip, corners at -1..1
SQUARE = np.array([(-1, -1), (1, -1), (-1, 1), (1, 1)], "f4")


def make_pass(gl: moderngl.Context, name: str, **defines: int) -> moderngl.Program:
    """A program that reads the frame's uniform block."""
    program = make_program(gl, name, **defines)
    block = program.get("Frame", None)
    if isinstance(block, moderngl.UniformBlock):
        block.binding = FRAME_BINDING
    return program


class Instances:
    """One static mesh drawn many times: per-copy data in one buffer that grows by doubling, uploaded once a frame."""

    def __init__(
        self, gl, programs, mesh_layout, layout: str, attributes: tuple[str, ...], index=None, mode=moderngl.TRIANGLES
    ):
        """mesh_layout: moderngl's (buffer, format, names...) of the mesh; layout and attributes: of one copy."""
        self.gl, self.programs, self.mesh_layout, self.index, self.mode = gl, programs, mesh_layout, index, mode
        self.layout, self.attributes = layout, attributes
        self.count = 0
        self._reserve(4096)

    def upload(self, copies: np.ndarray) -> None:
        """copies: (N, K) float32, one row a copy."""
        data = np.ascontiguousarray(copies, "f4")
        self.count = len(data)
        if data.nbytes > self.buffer.size:
            self._reserve(2 * data.nbytes)
        if self.count:
            self.buffer.write(data)

    def draw(self, which: int = 0, count: int | None = None) -> None:
        """Draws the first `count` copies, or all, with one of the programs."""
        count = self.count if count is None else count
        if count > 0:
            self.arrays[which].render(self.mode, instances=count)

    def draw_one(self, which: int, copy: int) -> None:
        """Draws a single copy. GL 3.3 has no first instance: the rows before it become padding."""
        array = self._array(self.programs[which], skipped=copy)
        array.render(self.mode, instances=1)
        array.release()

    def _reserve(self, size_bytes: int) -> None:
        self.buffer = self.gl.buffer(reserve=size_bytes, dynamic=True)
        self.arrays = [self._array(program) for program in self.programs]

    def _array(self, program: moderngl.Program, skipped: int = 0) -> moderngl.VertexArray:
        """Attributes that a program does not read are left out of its array."""
        per_copy = _only_read(program, self.layout, self.attributes)
        padding = f"{4 * skipped * _floats(self.layout)}x " if skipped else ""
        content = [_mesh_part(program, self.mesh_layout)]
        if per_copy:
            content.append((self.buffer, padding + per_copy[0] + "/i", *per_copy[1]))
        return self.gl.vertex_array(program, content, index_buffer=self.index, index_element_size=4)


def _floats(layout: str) -> int:
    return sum(_bytes(item) for item in layout.split()) // 4


def _bytes(item: str) -> int:
    """Of one attribute such as 3f or 4u1."""
    count, kind = int(item[0]), item[1:]
    return count * {"f": 4, "u1": 1, "f1": 1}[kind]


def _only_read(program, layout: str, names) -> tuple[str, list[str]] | None:
    """The layout with what the program does not read turned into padding."""
    items, read = [], []
    for item, name in zip(layout.split(), names, strict=True):
        if name in program:
            items.append(item)
            read.append(name)
        else:
            items.append(f"{_bytes(item)}x")
    return (" ".join(items), read) if read else None


def _mesh_part(program, mesh_layout):
    buffer, layout, *names = mesh_layout
    used = _only_read(program, layout, names)
    assert used is not None, "a program that reads nothing of its mesh"
    return (buffer, used[0], *used[1])
