"""What a panel of the window is, and which there are.

A panel is an object with a `title` (its tab) and a method `draw(ui, session)`, called every frame while its tab is
open: it shows things with the widgets of `engine.render.ui.widgets.Ui` (each widget takes the value now and returns the
value wanted) and acts on the `Session`. State of its own, such as a search word, lies in the object.

Beside `draw` a panel may have any of these:

- `drawn_into(scene, session)`: adds to the picture what it has to show there (figures, balls, marks in `scene.draw`).
  Called every frame while its tab is open, after the session's own things have been put in.
- `handle(event, session) -> bool`: is shown events of `engine.render.events` that no widget took, before the camera
  sees them; True keeps them from it. For dragging things in the picture: `session.ray()` says where the cursor looks.
- `memory() -> dict` and `remember(dict)`: plain JSON that is kept in the user's settings from one start to the next.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any, Protocol, runtime_checkable

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui

# module and class of each panel, in the order of their tabs; imported when the window first shows panels
PANELS = (
    ("demos.window.threat_panel", "ThreatPanel"),
    ("demos.window.rules_panel", "RulesPanel"),
    ("demos.window.timing_panel", "TimingPanel"),
    ("demos.window.character_panel", "CharacterPanel"),
    ("demos.window.stance_panel", "StancePanel"),
    ("demos.window.clips_panel", "ClipsPanel"),
    ("demos.window.view_panel", "ViewPanel"),
    ("demos.window.save_panel", "SavePanel"),
)


class Panel(Protocol):
    """The part that every panel has."""

    title: str

    def draw(self, ui: Ui, session: Session) -> None: ...


@runtime_checkable
class Remembering(Protocol):
    """A panel with something to keep from one start to the next."""

    def memory(self) -> dict[str, Any]: ...

    def remember(self, kept: dict[str, Any]) -> None: ...


def make_panels() -> list[Panel]:
    """One of each."""
    return [getattr(importlib.import_module(module), name)() for module, name in PANELS]
