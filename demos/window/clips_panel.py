"""The Clips panel: everything that can be played, with a search; files are dropped on the window."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from engine.clips.library import FETCH_SIZE, list_clips
from engine.clips.making import FORMATS

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui

MOST_FILES = 200  # of the working folder


class Row(NamedTuple):
    clip: str  # as a scenario names it
    shown: str
    about: str
    ready: bool = True


class ClipsPanel:
    """A click plays a clip from its start."""

    title = "Clips"

    def __init__(self) -> None:
        self.search = ""
        self._files: list[Row] | None = None

    def draw(self, ui: Ui, session: Session) -> None:
        self.search = ui.entry("clip search", self.search, "Search")
        found = [row for row in self._rows(session) if matches(row, self.search)]
        for row in found:
            if ui.item(row.shown, row.clip == session.character.clip, "" if row.ready else "not here") and row.ready:
                session.play_clip(row.clip)
            if row.about:
                ui.text(row.about, faint=True)
        if not found:
            ui.text(f"Nothing is called {self.search!r}.", faint=True)
        ui.gap()
        if not all(row.ready for row in found):
            if session.fetching:
                ui.text("What is not here is being fetched.", faint=True)
            elif ui.button(f"Fetch what is not here ({FETCH_SIZE})", width=-1.0):
                session.ask("clips")
        formats = ", ".join(FORMATS)
        ui.text(f"Drop a {formats} file on the window to play it (an .amc needs its .asf beside it).", faint=True)

    def _rows(self, session: Session) -> list[Row]:
        """The library, what was dropped, and the files of the folder that things are saved in."""
        library = [Row(listed.name, listed.name, listed.about, listed.ready) for listed in list_clips()]
        if self._files is None:
            self._files = files_in(session.save_in)
        dropped = [Row(path, Path(path).name, str(Path(path).parent)) for path in session.dropped]
        return [*dropped, *library, *(row for row in self._files if row.clip not in session.dropped)]


def files_in(folder: Path) -> list[Row]:
    """The clip files that lie in a folder; none where it cannot be read."""
    try:
        paths = sorted(path for path in folder.iterdir() if path.suffix.lower() in (".bvh", ".amc"))
    except OSError:
        return []
    return [Row(str(path.resolve()), path.name, "") for path in paths[:MOST_FILES]]


def matches(row: Row, search: str) -> bool:
    """Whether every word of the search stands somewhere in the row."""
    text = f"{row.shown} {row.about}".lower()
    return all(word in text for word in search.lower().split())
