"""The widgets that panels are made of. Each is told the value as it is and returns the value that the user wants.

Lengths are in points: pixels of an ordinary screen, whatever the screen. Labels stand left, what can be moved right.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from imgui_bundle import imgui

from engine.render.ui import style
from engine.render.ui.canvas import Canvas

LABEL_SHARE = 0.44  # of a panel's width
_AREA_FLAGS = (
    imgui.WindowFlags_.no_title_bar
    | imgui.WindowFlags_.no_resize
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_collapse
    | imgui.WindowFlags_.no_nav
)


class Ui:
    """Handed to every panel's `draw`. `areas` are the rectangles drawn on this frame, for whose is the mouse."""

    def __init__(self) -> None:
        self.width, self.height = 0.0, 0.0  # of the window, points
        self.areas: list[tuple[float, float, float, float]] = []

    # --- words ---------------------------------------------------------------------------------------------------

    def heading(self, text: str) -> None:
        """A small title over a group of widgets."""
        imgui.spacing()
        imgui.push_font(None, style.SMALL_PX)
        imgui.text_colored(style.FAINT, text)
        imgui.pop_font()

    def text(self, text: str, *, faint: bool = False, alarm: bool = False) -> None:
        """A paragraph, wrapped at the panel's width."""
        colour = style.ALARM if alarm else style.FAINT if faint else style.INK
        imgui.push_style_color(imgui.Col_.text, colour)
        imgui.text_wrapped(text)
        imgui.pop_style_color()

    def pair(self, left: str, right: str, left_width: float) -> None:
        """A word and what it stands for, in two columns."""
        start = imgui.get_cursor_pos_x()
        imgui.text_colored(style.ACCENT, left)
        imgui.same_line(start + left_width)
        imgui.text_wrapped(right)

    def chip(self, text: str, mark: Sequence[float] | None = None, *, faint: bool = False) -> None:
        """A word on a piece of paper of its own, with a spot of colour before it if one is given."""
        draw, at = imgui.get_window_draw_list(), imgui.get_cursor_screen_pos()
        size, spot = imgui.calc_text_size(text), 14.0 if mark else 0.0
        width, height = size.x + 16.0 + spot, size.y + 8.0
        corner = (at.x + width, at.y + height)
        draw.add_rect_filled((at.x, at.y), corner, imgui.get_color_u32(imgui.ImVec4(*style.PAPER)), 6.0)
        if mark:
            colour = imgui.get_color_u32(imgui.ImVec4(mark[0], mark[1], mark[2], 1.0))
            draw.add_circle_filled((at.x + 13.0, at.y + 0.5 * height), 4.5, colour)
        ink = imgui.get_color_u32(imgui.ImVec4(*(style.FAINT if faint else style.INK)))
        draw.add_text((at.x + 8.0 + spot, at.y + 4.0), ink, text)
        imgui.dummy((width, height))

    def gap(self) -> None:
        """A little room, with a line through it."""
        imgui.spacing()
        imgui.separator()
        imgui.spacing()

    def beside(self) -> None:
        """What comes next stands on the same line as what came last."""
        imgui.same_line()

    # --- values --------------------------------------------------------------------------------------------------

    def slider(
        self,
        label: str,
        value: float,
        low: float,
        high: float,
        unit: str = "",
        *,
        digits: int = 2,
        loose: bool = False,
        help: str = "",
    ) -> float:
        """A number from a range; Ctrl-click types one, with `loose` also beyond its ends. What the user sets is rounded
        to one digit more than is shown.
        """
        self._label(label, help)
        shown = f"%.{digits}f {unit}".rstrip().replace("%", "%%").replace("%%", "%", 1)
        changed, wanted = imgui.slider_float(f"##{label}", value, low, high, shown)
        self._hint(help)
        if not changed:
            return value
        return round(wanted if loose else min(max(wanted, low), high), digits + 1)

    def whole(self, label: str, value: int, low: int, high: int, unit: str = "", *, help: str = "") -> int:
        """A whole number from a range."""
        self._label(label, help)
        changed, wanted = imgui.slider_int(f"##{label}", value, low, high, f"%d {unit}".rstrip())
        self._hint(help)
        return min(max(wanted, low), high) if changed else value

    def toggle(self, label: str, on: bool, *, help: str = "") -> bool:
        """Yes or no."""
        _, wanted = imgui.checkbox(label, on)
        self._hint(help)
        return wanted

    def choice(self, label: str, chosen: str, options: Sequence[str], *, help: str = "") -> str:
        """One of several words."""
        self._label(label, help)
        if imgui.begin_combo(f"##{label}", chosen):
            for option in options:
                picked, _ = imgui.selectable(option, option == chosen)
                chosen = option if picked else chosen
            imgui.end_combo()
        self._hint(help)
        return chosen

    def entry(self, label: str, text: str, hint: str = "") -> str:
        """A line to type in, over the whole width."""
        imgui.set_next_item_width(-1.0)
        _, wanted = imgui.input_text_with_hint(f"##{label}", hint or label, text)
        return wanted

    # --- actions -------------------------------------------------------------------------------------------------

    def button(self, label: str, *, enabled: bool = True, chosen: bool = False, help: str = "", width: float = 0.0):
        """True in the frame in which it is clicked. width: 0 as the label needs it, -1 all there is."""
        imgui.begin_disabled(not enabled)
        if chosen:  # also under the cursor, where it was clicked
            imgui.push_style_color(imgui.Col_.button, style.ACCENT_LIGHT)
            imgui.push_style_color(imgui.Col_.button_hovered, style.ACCENT_LIGHT)
        clicked = imgui.button(label, (width, 0.0))
        if chosen:
            imgui.pop_style_color(2)
        imgui.end_disabled()
        self._hint(help)
        return clicked

    def item(self, label: str, chosen: bool, detail: str = "") -> bool:
        """A row of a list, with something faint at its right; True when clicked."""
        clicked, _ = imgui.selectable(f"{label}##item", chosen)
        if detail:
            right = imgui.get_window_width() - imgui.calc_text_size(detail).x - imgui.get_style().window_padding.x - 8.0
            imgui.same_line(max(right, imgui.calc_text_size(label).x + 24.0))
            imgui.text_colored(style.FAINT, detail)
        return clicked

    def tabs(self, titles: Sequence[str], chosen: str, per_row: int = 4) -> str:
        """Buttons in rows, one of them chosen."""
        gap = 4.0
        width = (imgui.get_content_region_avail().x - gap * (per_row - 1)) / per_row
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (gap, gap))
        for number, title in enumerate(titles):
            if number % per_row:
                imgui.same_line()
            if self.button(title, chosen=title == chosen, width=width):
                chosen = title
        imgui.pop_style_var()
        return chosen

    # --- structure -----------------------------------------------------------------------------------------------

    def folded(self, title: str, open: bool = False, help: str = "") -> bool:
        """A group that unfolds: draw its widgets where this is True."""
        imgui.set_next_item_open(open, imgui.Cond_.once)
        shown = imgui.collapsing_header(title)
        self._hint(help)
        return shown

    @contextmanager
    def scope(self, name: str) -> Iterator[None]:
        """Labels inside may repeat those outside."""
        imgui.push_id(name)
        yield
        imgui.pop_id()

    @contextmanager
    def area(
        self, name: str, x: float, y: float, width: float, height: float = 0.0, *, paper=True, mouse=True
    ) -> Iterator[None]:
        """A rectangle of the window to draw in. height 0: as high as its content. mouse: whether it catches clicks."""
        flags = _AREA_FLAGS
        flags |= 0 if paper else imgui.WindowFlags_.no_background
        flags |= 0 if mouse else imgui.WindowFlags_.no_inputs
        flags |= imgui.WindowFlags_.no_scrollbar if not height else 0
        imgui.set_next_window_pos((x, y))
        imgui.set_next_window_size((width, height))
        imgui.begin(name, None, flags)
        yield
        if mouse:
            at, size = imgui.get_window_pos(), imgui.get_window_size()
            self.areas.append((at.x, at.y, at.x + size.x, at.y + size.y))
        imgui.end()

    @contextmanager
    def scrolled(self, name: str, height: float = 0.0) -> Iterator[None]:
        """A part that scrolls by itself; height 0: all that is left."""
        imgui.begin_child(name, (0.0, height))
        yield
        imgui.end_child()

    def canvas(self, name: str, height: float, width: float = 0.0) -> Canvas:
        """A place to draw freely in; width 0: all there is."""
        return Canvas(name, width or imgui.get_content_region_avail().x, height)

    def _label(self, label: str, help: str) -> None:
        """The label at the left; what follows gets the rest of the line."""
        imgui.align_text_to_frame_padding()
        left = imgui.get_cursor_pos_x()
        imgui.text(label)
        self._hint(help)
        imgui.same_line(left + LABEL_SHARE * (imgui.get_content_region_avail().x + 0.0))
        imgui.set_next_item_width(-1.0)

    def _hint(self, help: str) -> None:
        if help:
            imgui.set_item_tooltip(help.replace("%", "%%"))
