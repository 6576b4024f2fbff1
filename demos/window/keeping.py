"""Doing what was asked to be kept, screenshots, films, scenarios, recordings, or brought: clips. Says where it went, or
why it did not.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from demos.window.fetching import Fetching
from demos.window.film import Film
from demos.window.saving import free_name, save_replay, save_scenario
from engine.core.errors import BraceError
from engine.render.capture import write_png

if TYPE_CHECKING:
    from demos.window.session import Session

Picture = Callable[[], np.ndarray]


class Keeper:
    """Fulfils `session.ask`, once a frame."""

    def __init__(self, session: Session):
        self.session = session
        self.film: Film | None = None
        self._finishing: list[Film] = []
        self._fetching = Fetching()

    def keep(self, picture: Picture, passed_s: float) -> None:
        """The picture of this frame is drawn; nothing lies on it yet."""
        asked, self.session.asked = self.session.asked, []
        for what in asked:
            try:
                getattr(self, f"_{what}")(picture)
            except BraceError as trouble:
                self.session.say(trouble.line(), alarm=True)
        if self.film and not self.film.offer(passed_s, picture):
            self._film(picture)
        self._look_after()

    def close(self) -> None:
        """The window goes: films are finished, clips are fetched no further."""
        self._fetching.stop()
        if self.film:
            self.film.stop()
            self._finishing.append(self.film)
        for film in self._finishing:
            film.wait()

    def _screenshot(self, picture: Picture) -> None:
        path = free_name(self.session.save_in, "screenshot", ".png")
        write_png(path, picture())
        self._say_saved(path)

    def _recording(self, picture: Picture) -> None:
        self._say_saved(save_replay(self.session.run, self.session.save_in))

    def _scenario(self, picture: Picture) -> None:
        self._say_saved(save_scenario(self.session.run, self.session.save_in, self.session.folder))

    def _film(self, picture: Picture) -> None:
        """Begins one, or ends it."""
        if self.film is None:
            self.film = Film(free_name(self.session.save_in, "film", ".mp4"))
            self.session.say("filming; R ends it")
        else:
            self.film.stop()
            self._finishing.append(self.film)
            self.film = None
        self.session.filming = self.film is not None

    def _clips(self, picture: Picture) -> None:
        self._fetching.begin()
        self.session.fetching = True
        self.session.say("fetching clips; everything goes on meanwhile")

    def _look_after(self) -> None:
        """Says of films that were ended, and of clips that were fetched, whether they are there."""
        said = self._fetching.ended()
        if said is not None:
            self.session.fetching = False
            self.session.say(said or "all clips of the library are here", alarm=bool(said))
            self.session.change()  # whoever lies there finds them
        for film in [film for film in self._finishing if not film.going]:
            self._finishing.remove(film)
            if film.trouble:
                self.session.say(film.trouble.line(), alarm=True)
            else:
                self._say_saved(film.path)

    def _say_saved(self, path) -> None:
        self.session.say(f"saved {path}")
