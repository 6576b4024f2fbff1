"""What lies at the top of the picture: when it is, what the character is about, what was said, what is offered."""

from __future__ import annotations

from typing import TYPE_CHECKING

from behaviours.components import Phase, Struck
from demos.window.phases import COLOURS
from demos.window.throwing import throw_speed_mps
from engine.clips.library import FETCH_SIZE, list_clips
from engine.core.clock import TICK_RATE_HZ

if TYPE_CHECKING:
    from demos.play import Play
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui

STATUS_WIDTH, OFFER_WIDTH, OFFER_Y = 460.0, 250.0, 70.0


def draw_status(ui: Ui, play: Play, margin: float) -> None:
    """One line at the top left: when, what, how fast, what is held. Below it, what a newcomer has to know."""
    session = play.session
    with ui.area("status", margin, margin, STATUS_WIDTH, paper=False, mouse=False):
        ui.chip(f"{session.tick / TICK_RATE_HZ:.2f} s")
        ui.beside()
        ui.chip(session.doing(session.row), COLOURS[session.phase])
        for words in states(play):
            ui.beside()
            ui.chip(words)
        if not play.help:
            ui.chip("F throw   F1 all keys   Tab panels", faint=True)


def states(play: Play) -> list[str]:
    """What is out of the ordinary, in a word or two each."""
    session, words = play.session, []
    if session.paused:
        words.append("paused")
    elif session.slow_motion.share < 0.95:
        words.append("slow motion")
    elif session.clock.rate != 1.0:
        words.append(f"{session.clock.rate:g} x")
    if session.tick < session.run.last_tick:
        words.append("replay")
    if session.busy:
        words.append(f"re-running {session.rerun_share:.0%}")
    if session.filming:
        words.append("filming")
    if session.fetching:
        words.append("fetching clips")
    if play.held_s is not None:
        words.append(f"throw {throw_speed_mps(play.held_s):.0f} m/s")
    return words


def draw_offer(ui: Ui, session: Session, margin: float) -> None:
    """Where somebody stays down: why, and what can be done about it."""
    if session.busy or not stays_down(session):
        return
    missing = [listed for listed in list_clips() if listed.gets_up and not listed.ready]
    with ui.area("offer", margin, margin + OFFER_Y, OFFER_WIDTH):
        if not missing:
            ui.text("Stays down: no motion of the library begins as this one lies.")
        elif session.fetching:
            ui.text("Stays down until the clips that get up are here.")
        else:
            ui.text("Stays down: no clip that is here gets up.")
            if ui.button(f"Fetch some ({FETCH_SIZE})", width=-1.0):
                session.ask("clips")


def stays_down(session: Session) -> bool:
    """Whether the selected character has found nothing to get up with."""
    return session.phase == Phase.DOWN and bool(session.world[Struck].said[session.row])


def draw_toasts(ui: Ui, session: Session, right: float, margin: float) -> None:
    """Lines at the top right, newest last; `right`: how far they may go."""
    if session.toasts.lines:
        width = min(420.0, right - margin)
        with ui.area("toasts", right - width, margin, width, mouse=False):
            for line in session.toasts.lines:
                ui.text(line.text, alarm=line.alarm)
