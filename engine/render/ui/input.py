"""What the user did, told to imgui in its words."""

from __future__ import annotations

from collections.abc import Iterable

from imgui_bundle import imgui

from engine.render.events import ALT, CTRL, SHIFT, Event, Key, MouseButton, MouseMove, Scroll, Text

_KEYS = {
    "tab": imgui.Key.tab, "left": imgui.Key.left_arrow, "right": imgui.Key.right_arrow, "up": imgui.Key.up_arrow,
    "down": imgui.Key.down_arrow, "page_up": imgui.Key.page_up, "page_down": imgui.Key.page_down,
    "home": imgui.Key.home, "end": imgui.Key.end, "insert": imgui.Key.insert, "delete": imgui.Key.delete,
    "backspace": imgui.Key.backspace, "space": imgui.Key.space, "enter": imgui.Key.enter, "escape": imgui.Key.escape,
    **{letter: getattr(imgui.Key, letter) for letter in "acvxyz"},  # what editing a line of text needs
}  # fmt: skip
_MODIFIERS = ((SHIFT, imgui.Key.mod_shift), (CTRL, imgui.Key.mod_ctrl), (ALT, imgui.Key.mod_alt))


def tell(events: Iterable[Event], scale: float) -> None:
    """Every event, whether anybody here wants it or not. scale: framebuffer pixels per point."""
    io = imgui.get_io()
    for event in events:
        if isinstance(event, MouseMove):
            io.add_mouse_pos_event(event.x_px / scale, event.y_px / scale)
        elif isinstance(event, MouseButton):
            io.add_mouse_pos_event(event.x_px / scale, event.y_px / scale)
            _tell_modifiers(event.modifiers)
            io.add_mouse_button_event(event.button, event.pressed)
        elif isinstance(event, Scroll):
            io.add_mouse_wheel_event(event.steps_x, event.steps_y)
        elif isinstance(event, Text):
            io.add_input_character(ord(event.character))
        elif isinstance(event, Key):
            _tell_modifiers(event.modifiers)
            if event.name in _KEYS:
                io.add_key_event(_KEYS[event.name], event.action != "release")


def _tell_modifiers(modifiers: int) -> None:
    for bit, key in _MODIFIERS:
        imgui.get_io().add_key_event(key, bool(modifiers & bit))
