"""The Save panel: pictures, films, the run as a scenario or a recording."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui


class SavePanel:
    """One button each; a line at the top says where the file is."""

    title = "Save"

    def draw(self, ui: Ui, session: Session) -> None:
        if ui.button("Screenshot   P", width=-1.0):
            session.ask("screenshot")
        if ui.button("Stop the film   R" if session.filming else "Film   R", width=-1.0, chosen=session.filming):
            session.ask("film")
        ui.text("An .mp4 of the picture, as you play, without the panels.", faint=True)
        ui.gap()
        if ui.button("Scenario   Ctrl-S", width=-1.0):
            session.ask("scenario")
        ui.text("A .toml with all that is set and every throw; brace react runs it to the same state.", faint=True)
        if ui.button("Recording   Ctrl-R", width=-1.0):
            session.ask("recording")
        ui.text("A .brace with every tick; brace replay --check proves it.", faint=True)
        ui.gap()
        ui.text(f"Files go to {session.save_in}", faint=True)
