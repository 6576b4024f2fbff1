"""The layer of widgets over the picture: takes its share of the events, lets somebody draw, paints the result."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator

import glfw  # noqa: F401  before imgui_bundle, which otherwise finds a library of its own
from imgui_bundle import imgui

from engine.render.events import Event, Key, MouseButton, MouseMove, Scroll, Text
from engine.render.ui.input import tell
from engine.render.ui.paint import Painter
from engine.render.ui.style import apply_style
from engine.render.ui.widgets import Ui

FRAMES_TO_SEE = 4  # until imgui has taken a press in


class Overlay:
    """One a process: imgui's context is global."""

    def __init__(self, gl):
        self.context = imgui.create_context()
        io = imgui.get_io()
        io.set_ini_filename("")
        io.set_log_filename("")
        io.config_input_trickle_event_queue = False  # `_share` does it, and knows about drags
        apply_style()
        self.painter = Painter(gl)
        self.ui = Ui()
        self.held: set[int] = set()  # buttons that went down on a widget
        self._waiting: deque[Event] = deque()
        self._beside = 0  # frames until imgui has seen that a press beside its widgets ended the typing

    def take(self, events: Iterable[Event], scale: float) -> list[Event]:
        """Everything is told to imgui with the next frames; returns what was not meant for a widget."""
        events = list(events)
        self._waiting.extend(events)
        return [event for event in events if not self._took(event, scale)]

    def paint(self, target, scale: float, passed_s: float, draw: Callable[[Ui], None]) -> None:
        """One frame of widgets, made by `draw`, over the picture in `target`."""
        io = imgui.get_io()
        width, height = target.size
        io.display_size = imgui.ImVec2(width / scale, height / scale)
        io.display_framebuffer_scale = imgui.ImVec2(scale, scale)
        io.delta_time = min(max(passed_s, 1e-4), 0.5)
        self.ui.width, self.ui.height = width / scale, height / scale
        self.ui.areas.clear()
        self._beside = max(self._beside - 1, 0)
        tell(self._share(), scale)
        imgui.new_frame()
        draw(self.ui)
        imgui.render()
        self.painter.paint(target)

    def close(self) -> None:
        imgui.destroy_context(self.context)

    def _share(self) -> Iterator[Event]:
        """What of the events imgui is told in this frame: up to the first button that goes down or up, or until a key
        changes a second time. A release after a move waits for the next frame.

        Where frames are slow a whole drag may come between two of them, and imgui only looks at the state that it is
        left in, and not at where the mouse went when it sees the button up.
        """
        moved, keys = False, set()
        while self._waiting:
            event = self._waiting[0]
            if isinstance(event, MouseButton) and not event.pressed and moved:
                return
            if isinstance(event, Key):
                if event.name in keys:
                    return
                keys.add(event.name)
            yield self._waiting.popleft()
            if isinstance(event, MouseButton):
                return
            moved = moved or isinstance(event, MouseMove)

    def _took(self, event: Event, scale: float) -> bool:
        """Keys while a line is typed in; the mouse over an area or a popup, and from press to release."""
        if isinstance(event, (Key, Text)):
            return imgui.get_io().want_text_input and not self._beside
        if isinstance(event, MouseButton):
            if event.pressed and self._over(event.x_px / scale, event.y_px / scale):
                self.held.add(event.button)
                return True
            if event.pressed:
                self._beside = FRAMES_TO_SEE
            if not event.pressed and event.button in self.held:
                self.held.discard(event.button)
                return True
            return False
        if isinstance(event, Scroll):
            return self._over(event.x_px / scale, event.y_px / scale)
        return isinstance(event, MouseMove) and bool(self.held)

    def _over(self, x: float, y: float) -> bool:
        if imgui.is_popup_open("", imgui.PopupFlags_.any_popup):
            return True
        return any(x0 <= x < x1 and y0 <= y < y1 for x0, y0, x1, y1 in self.ui.areas)
