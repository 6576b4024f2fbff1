"""Draws what imgui has put together, through moderngl, over a finished picture."""

from __future__ import annotations

import ctypes

import moderngl
import numpy as np
from imgui_bundle import imgui

from engine.render.shader_source import make_program

UNIT = 5


class Painter:
    """One program, one pair of buffers, and the textures that imgui asks for (its letters)."""

    def __init__(self, gl: moderngl.Context):
        self.gl = gl
        self.program = make_program(gl, "ui")
        self.program["letters"] = UNIT
        self.vertices = gl.buffer(reserve=1 << 16, dynamic=True)
        self.indices = gl.buffer(reserve=1 << 15, dynamic=True)
        self.array = self._array()
        self.textures: dict[int, moderngl.Texture] = {}
        io = imgui.get_io()
        io.backend_flags |= imgui.BackendFlags_.renderer_has_textures
        largest = gl.info["GL_MAX_TEXTURE_SIZE"]
        imgui.get_platform_io().renderer_texture_max_width = largest
        imgui.get_platform_io().renderer_texture_max_height = largest

    def paint(self, target: moderngl.Framebuffer) -> None:
        """The last frame of imgui on this framebuffer, whose first row is the picture's lowest."""
        data = imgui.get_draw_data()
        for texture in imgui.get_platform_io().textures:
            self._renew(texture)
        width, height = target.size
        target.use()
        self.gl.enable_only(moderngl.BLEND)
        self.gl.blend_func = (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA)
        self.program["points"] = (data.display_size.x, data.display_size.y)
        scale = data.framebuffer_scale.x
        for commands in data.cmd_lists:
            self._upload(commands)
            for command in commands.cmd_buffer:
                left, top, right, bottom = (int(edge * scale) for edge in command.clip_rect)
                left, top, right, bottom = max(left, 0), max(top, 0), min(right, width), min(bottom, height)
                if right <= left or bottom <= top:
                    continue
                target.scissor = (left, height - bottom, right - left, bottom - top)
                self.textures[command.tex_ref.get_tex_id()].use(UNIT)
                self.array.render(moderngl.TRIANGLES, vertices=command.elem_count, first=command.idx_offset)
        target.scissor = (0, 0, width, height)

    def _upload(self, commands) -> None:
        """The corners and the order of one list; the buffers grow by doubling."""
        corners = commands.vtx_buffer.size() * imgui.VERTEX_SIZE
        order = commands.idx_buffer.size() * imgui.INDEX_SIZE
        if corners > self.vertices.size or order > self.indices.size:
            self.vertices = self.gl.buffer(reserve=max(2 * corners, self.vertices.size), dynamic=True)
            self.indices = self.gl.buffer(reserve=max(2 * order, self.indices.size), dynamic=True)
            self.array = self._array()
        if corners:
            self.vertices.write(ctypes.string_at(commands.vtx_buffer.data_address(), corners))
            self.indices.write(ctypes.string_at(commands.idx_buffer.data_address(), order))

    def _array(self) -> moderngl.VertexArray:
        return self.gl.vertex_array(
            self.program,
            [(self.vertices, "2f 2f 4f1", "place", "in_letters", "colour")],
            index_buffer=self.indices,
            index_element_size=imgui.INDEX_SIZE,
        )

    def _renew(self, texture) -> None:
        """Makes, fills again or drops a texture as imgui asks: letters come as they are first needed."""
        if texture.status == imgui.ImTextureStatus.want_create:
            made = self.gl.texture((texture.width, texture.height), 4, _pixels(texture))
            made.filter, made.repeat_x, made.repeat_y = (moderngl.LINEAR, moderngl.LINEAR), False, False
            self.textures[made.glo] = made
            texture.set_tex_id(made.glo)
            texture.status = imgui.ImTextureStatus.ok
        elif texture.status == imgui.ImTextureStatus.want_updates:
            self.textures[texture.tex_id].write(_pixels(texture))
            texture.status = imgui.ImTextureStatus.ok
        elif texture.status == imgui.ImTextureStatus.want_destroy and texture.unused_frames > 0:
            self.textures.pop(texture.tex_id).release()
            texture.set_tex_id(0)
            texture.status = imgui.ImTextureStatus.destroyed


def _pixels(texture) -> bytes:
    return np.ascontiguousarray(texture.get_pixels_array()).tobytes()
