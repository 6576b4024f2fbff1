"""The panels over the picture, for the loop: widgets are imported after the first picture has been seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

from engine.render.events import Event

if TYPE_CHECKING:
    from demos.play import Play
    from engine.render.context import Context
    from engine.render.renderer import Renderer
    from engine.render.ui.overlay import Overlay


class PanelLayer:
    """Passes events and frames between the loop, the widgets and a Play. scale: points to pixels; 0 as the screen."""

    def __init__(self, play: Play, scale: float = 0.0):
        self.play, self.scale = play, scale
        self._overlay: Overlay | None = None
        self._seen = 0

    def take(self, events: list[Event], context: Context) -> list[Event]:
        if self._overlay is None:
            return events
        return self.play.take(self._overlay.take(events, self.scale or context.scale))

    def paint(self, renderer: Renderer, context: Context, passed_s: float) -> None:
        """The first picture is shown without panels: they take a moment to be imported."""
        self.play.keep(renderer.read_rgb, passed_s)
        self._seen += 1
        if self._seen == 1:
            return
        if self._overlay is None:
            from engine.render.ui.overlay import Overlay

            self._overlay = Overlay(renderer.gl)
        self.play.scale = self.scale or context.scale
        self._overlay.paint(renderer.finished, self.play.scale, passed_s, self.play.draw)

    def close(self) -> None:
        if self._overlay:
            self._overlay.close()
