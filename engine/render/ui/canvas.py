"""A rectangle among the widgets to draw lines, boxes and words in, which knows what the mouse does there."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from imgui_bundle import imgui

from engine.render.ui import style

Colour = Sequence[float]  # r, g, b, a


class Canvas:
    """Places are points from its top left corner.

    `mouse`: where the cursor is (also outside while dragging); `hovered`; `pressed`: the left button went down in it in
    this frame; `held`: and has not come up yet; `released`: it just did; `wheel`: steps turned over it.
    """

    def __init__(self, name: str, width: float, height: float):
        self.width, self.height = max(width, 1.0), max(height, 1.0)
        corner = imgui.get_cursor_screen_pos()
        self._left, self._top = corner.x, corner.y
        imgui.invisible_button(name, (self.width, self.height))
        self.hovered, self.held = imgui.is_item_hovered(), imgui.is_item_active()
        self.pressed, self.released = imgui.is_item_activated(), imgui.is_item_deactivated()
        self.wheel = imgui.get_io().mouse_wheel if self.hovered else 0.0
        at = imgui.get_mouse_pos()
        self.mouse = (at.x - self._left, at.y - self._top)
        self._list = imgui.get_window_draw_list()

    def box(self, x0: float, y0: float, x1: float, y1: float, colour: Colour, rounding: float = 0.0) -> None:
        self._list.add_rect_filled(self._at(x0, y0), self._at(x1, y1), _packed(colour), rounding)

    def line(self, points: Iterable[tuple[float, float]], colour: Colour, width: float = 1.0) -> None:
        """Through all the points; fewer than two draw nothing."""
        path: list = [imgui.ImVec2(*self._at(x, y)) for x, y in points]
        if len(path) > 1:
            self._list.add_polyline(path, _packed(colour), width, 0)

    def triangle(self, a, b, c, colour: Colour) -> None:
        self._list.add_triangle_filled(self._at(*a), self._at(*b), self._at(*c), _packed(colour))

    def dot(self, x: float, y: float, radius: float, colour: Colour) -> None:
        self._list.add_circle_filled(self._at(x, y), radius, _packed(colour))

    def text(self, x: float, y: float, text: str, colour: Colour = style.INK, *, right: bool = False) -> None:
        """Small words, their top left corner at (x, y), or with `right` the top right one."""
        imgui.push_font(None, style.SMALL_PX)
        width = imgui.calc_text_size(text).x if right else 0.0
        self._list.add_text(self._at(x - width, y), _packed(colour), text)
        imgui.pop_font()

    def hint(self, text: str) -> None:
        """Words above the rectangle, over the cursor."""
        imgui.set_next_window_pos((self._left + self.mouse[0], self._top - 6.0), imgui.Cond_.always, (0.5, 1.0))
        imgui.set_tooltip(text.replace("%", "%%"))

    def _at(self, x: float, y: float) -> tuple[float, float]:
        return (self._left + x, self._top + y)


def _packed(colour: Colour) -> int:
    r, g, b, a = colour
    return imgui.get_color_u32(imgui.ImVec4(r, g, b, a))
