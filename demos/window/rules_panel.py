"""The Rules panel: the constants of the rules, of balance, and of the search for the sustained pose."""

from __future__ import annotations

from typing import TYPE_CHECKING

from demos.window.knob_widgets import draw_groups

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui

GROUPS = (
    ("block", "Block (3.2.5)"),
    ("lean_turn", "Lean and turn (3.2.2, 3.2.3)"),
    ("recoil", "Recoil (3.2.4)"),
    ("startle", "Startle (3.2.6)"),
    ("wrap", "From behind (3.4)"),
    ("pelvis", "At the pelvis (3.4)"),
    ("balance", "Balance (3.3)"),
    ("objective", "Total error (eq. 3.3)"),
    ("solver", "Search for the pose"),
    ("temper", "Boldness"),
    ("senses", "Senses"),
    ("threats", "Approach"),
)


class RulesPanel:
    """Groups of sliders; a change re-runs what has happened so far."""

    title = "Rules"

    def draw(self, ui: Ui, session: Session) -> None:
        ui.text("A change re-runs what has happened so far. Pause in a reaction and see the pose change.", faint=True)
        draw_groups(ui, session, GROUPS)
