"""One calm look for everything on the picture: paper, ink and one colour for what can be moved."""

from __future__ import annotations

from pathlib import Path

from imgui_bundle import imgui

Colour = tuple[float, float, float, float]

PAPER: Colour = (0.972, 0.966, 0.955, 0.94)
SUNK: Colour = (0.905, 0.897, 0.882, 1.0)  # what can be dragged or typed into
RAISED: Colour = (0.865, 0.857, 0.842, 1.0)
LINE: Colour = (0.80, 0.79, 0.775, 1.0)
INK: Colour = (0.20, 0.23, 0.28, 1.0)
FAINT: Colour = (0.45, 0.47, 0.51, 1.0)
ACCENT: Colour = (0.24, 0.43, 0.62, 1.0)
ACCENT_LIGHT: Colour = (0.24, 0.43, 0.62, 0.22)
GRAB: Colour = (0.24, 0.43, 0.62, 0.45)  # numbers are read through it
ALARM: Colour = (0.72, 0.20, 0.16, 1.0)

FONT_PX, SMALL_PX = 14.5, 12.5


def apply_style() -> None:
    """Fonts, spacing and colours of the current imgui context."""
    imgui.get_io().fonts.add_font_from_file_ttf(str(_font()), FONT_PX)
    style = imgui.get_style()
    style.window_padding, style.frame_padding = imgui.ImVec2(12.0, 10.0), imgui.ImVec2(7.0, 3.0)
    style.item_spacing, style.item_inner_spacing = imgui.ImVec2(7.0, 5.0), imgui.ImVec2(6.0, 4.0)
    style.window_rounding, style.child_rounding, style.popup_rounding = 7.0, 5.0, 5.0
    style.frame_rounding, style.grab_rounding, style.grab_min_size = 4.0, 4.0, 9.0
    style.window_border_size, style.popup_border_size, style.frame_border_size = 0.0, 1.0, 0.0
    style.scrollbar_size, style.scrollbar_rounding = 9.0, 5.0
    style.indent_spacing = 10.0
    style.disabled_alpha = 0.45
    for name, colour in _colours().items():
        style.set_color_(getattr(imgui.Col_, name), colour)


def _colours() -> dict[str, Colour]:
    clear = (0.0, 0.0, 0.0, 0.0)
    return {
        "text": INK, "text_disabled": FAINT, "window_bg": PAPER, "child_bg": clear, "popup_bg": (*PAPER[:3], 0.99),
        "border": LINE, "frame_bg": SUNK, "frame_bg_hovered": RAISED, "frame_bg_active": RAISED,
        "slider_grab": GRAB, "slider_grab_active": (*ACCENT[:3], 0.6), "check_mark": ACCENT,
        "checkbox_selected_bg": SUNK,
        "button": SUNK, "button_hovered": RAISED, "button_active": LINE,
        "header": ACCENT_LIGHT, "header_hovered": RAISED, "header_active": LINE,
        "separator": LINE, "scrollbar_bg": clear, "scrollbar_grab": LINE, "scrollbar_grab_hovered": FAINT,
        "scrollbar_grab_active": FAINT, "text_selected_bg": ACCENT_LIGHT, "nav_cursor": clear,
    }  # fmt: skip


def _font() -> Path:
    """Roboto, which the library carries."""
    import imgui_bundle

    return Path(imgui_bundle.__file__).parent / "assets" / "fonts" / "Roboto" / "Roboto-Regular.ttf"
