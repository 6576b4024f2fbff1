"""GLSL from the `shaders` package: `#include "file.glsl"` resolved, errors told with file and line."""

from __future__ import annotations

import importlib.resources
import re

import moderngl

from engine.core.errors import EnvironmentTrouble

_INCLUDE = re.compile(r'^\s*#include\s+"([^"]+)"')
_ERROR_PLACE = re.compile(r"\b(\d+):(\d+)(?=[(:])")
_HEADER = "#version 330 core\n"


def make_program(gl: moderngl.Context, name: str, **defines: int) -> moderngl.Program:
    """Compiles `name.vert` with `name.frag`; each define becomes a #define in both.

    EnvironmentTrouble with the shader's own file and line where the driver refuses it.
    """
    files: list[str] = []
    sources = [_source(f"{name}.{stage}", files, defines) for stage in ("vert", "frag")]
    try:
        return gl.program(vertex_shader=sources[0], fragment_shader=sources[1])
    except moderngl.Error as trouble:
        raise EnvironmentTrouble("shader", _with_file_names(str(trouble), files)) from trouble


def _source(name: str, files: list[str], defines: dict[str, int]) -> str:
    """One stage: version line, defines, then the text with its includes."""
    head = "".join(f"#define {key} {value}\n" for key, value in defines.items())
    return _HEADER + head + _expanded(name, files, set())


def _expanded(name: str, files: list[str], seen: set[str]) -> str:
    """The text of a file, each include in place once; #line keeps the driver's counting ours."""
    seen.add(name)
    files.append(name)
    number = len(files) - 1
    lines = [f"#line 1 {number}"]
    for count, line in enumerate(_read(name).splitlines(), start=1):
        included = _INCLUDE.match(line)
        if not included:
            lines.append(line)
        elif f"include/{included[1]}" not in seen:
            lines.append(_expanded(f"include/{included[1]}", files, seen))
            lines.append(f"#line {count + 1} {number}")
    return "\n".join(lines) + "\n"


def _read(name: str) -> str:
    return importlib.resources.files("shaders").joinpath(name).read_text(encoding="utf-8")


def _with_file_names(message: str, files: list[str]) -> str:
    """Drivers say `2:17(5): error`, file number first: put the name there."""

    def named(place: re.Match) -> str:
        number = int(place[1])
        return f"shaders/{files[number]}:{place[2]}" if number < len(files) else place[0]

    return _ERROR_PLACE.sub(named, message)
