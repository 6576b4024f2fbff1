"""The Character panel: what it plays, how it stands and how bold it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from behaviours.stance.shape_sets import SETS
from engine.clips.library import list_clips

if TYPE_CHECKING:
    from behaviours.scenario_spec import StanceSpec
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui

OWN_SHAPE = "a shape of one's own"


class CharacterPanel:
    """The keys of a scenario's `[[character]]`, of the one that is selected."""

    title = "Character"

    def draw(self, ui: Ui, session: Session) -> None:
        spec = session.character
        if len(session.scenario.character) > 1:
            session.selected = ui.whole("Which", session.selected, 0, len(session.scenario.character) - 1)
            ui.text("A double click in the picture selects one, too.", faint=True)
            spec = session.character
        ui.heading("Clip")
        names = [listed.name for listed in list_clips() if listed.ready]
        clip = ui.choice("Plays", spec.clip, names if spec.clip in names else [spec.clip, *names])
        if clip != spec.clip:
            session.play_clip(clip)
            return
        changes: dict = {}
        ui.heading("Stance, worn under everything it does")
        _note(changes, "stance", spec.stance.model_dump(), _stance(ui, spec.stance))
        ui.heading("Temper")
        _note(changes, "boldness", spec.boldness, ui.slider(
            "Boldness", spec.boldness, -1.0, 1.0, help="-1 timid: takes threats for larger and faster, +1 bold"
        ))  # fmt: skip
        _note(changes, "startle", spec.startle, ui.toggle("Startles", spec.startle))
        _note(changes, "protects", spec.protects, ui.toggle(
            "Sees threats coming", spec.protects, help="off: goes on, and is hit unprepared"
        ))  # fmt: skip
        ui.heading("After the blow")
        _note(changes, "response_s", spec.response_s, ui.slider(
            "Response", spec.response_s, 0.02, 0.5, "s", help="physics alone, before the recovery begins (4.1.2)"
        ))  # fmt: skip
        _note(changes, "recover", spec.recover, ui.choice(
            "Goes on with", spec.recover, ("same", "new", "auto"),
            help="the same clip, or a motion that is searched for; auto: where the blow was hard",
        ))  # fmt: skip
        if changes:
            session.change_character(**changes)


def _stance(ui: Ui, worn: StanceSpec) -> dict:
    """The stance that is wanted: choosing a set takes the place of a shape of one's own."""
    shown, sets = (OWN_SHAPE, (OWN_SHAPE, *SETS)) if worn.shape else (worn.set, tuple(SETS))
    chosen = ui.choice("Shape set", shown, sets)
    intensity = ui.slider("Intensity", worn.intensity, -1.0, 1.0, help="0: the clip as it is")
    if chosen == shown:
        return {**worn.model_dump(), "intensity": intensity}
    return {"set": chosen, "intensity": intensity, "shape": None}


def _note(changes: dict, key: str, old, wanted) -> None:
    if wanted != old:
        changes[key] = wanted
