"""The View panel: what is shown beside the character."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui

GROUPS = {
    "Ghosts, while it protects itself": (
        ("ghost_clip", "Clip", "where the clip would have it, blue"),
        ("ghost_rules", "Rules", "what the rules alone ask for, yellow"),
        ("ghost_sustained", "Sustained", "the pose that it goes to, orange"),
    ),
    "Balance": (
        ("com", "Centre of mass", "its plumb line, and a ring where it is wanted"),
        ("support", "Support polygon", "around the feet that stand"),
    ),
    "Threat and body": (
        ("path", "Predicted path", "of every ball that has been noticed"),
        ("forces", "Limb forces", "what moves each limb, and what carries the whole body"),
        ("labels", "Labels", "speeds, times and forces in words"),
    ),
    "Window": (
        ("plots", "Plots", "margin of the centre of mass, acceleration of the head"),
        ("timeline", "Timeline", "phases, threats and contacts; drag to go back in time"),
        ("follow", "Camera follows", "the character that is selected"),
    ),
}


class ViewPanel:
    """Switches in groups."""

    title = "View"

    def draw(self, ui: Ui, session: Session) -> None:
        for heading, switches in GROUPS.items():
            ui.heading(heading)
            for name, label, help in switches:
                setattr(session.view, name, ui.toggle(label, getattr(session.view, name), help=help))
