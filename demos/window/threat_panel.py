"""The Threat panel: what is sent next, by its button, by T or by auto-fire."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from behaviours.perceive.approach import coming_from
from behaviours.perceive.senses import facing_dot
from behaviours.perceive.threats import KINDS, make_threat
from behaviours.playing import heading_of
from behaviours.scenario_spec import BODY_TARGETS
from behaviours.timing import time_to_contact_s
from engine.body.skeleton import JOINTS

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui


class ThreatPanel:
    """Sliders for an approach, and who throws it when."""

    title = "Threat"

    def draw(self, ui: Ui, session: Session) -> None:
        draft = session.threat
        before = vars(draft).copy()
        ui.heading("Where it comes from, as the character faces")
        draft.azimuth_deg = ui.slider(
            "Azimuth", draft.azimuth_deg, -180, 180, "°", digits=0, help="0 ahead, +90 its left, 180 behind"
        )
        draft.elevation_deg = ui.slider("Elevation", draft.elevation_deg, -30, 80, "°", digits=0, help="0 level, up")
        ui.heading("What it is")
        draft.kind = ui.choice("Kind", draft.kind, tuple(KINDS))
        draft.target = ui.choice("Target", draft.target, BODY_TARGETS + JOINTS)
        draft.speed_mps = ui.slider(
            "Speed", draft.speed_mps, 5, 45, "m/s", digits=1, help="the rules know 22.8 to 29.7: slower is 0, faster 1"
        )
        draft.size = ui.slider("Size", draft.size, 0, 1, help="as the rules take it: 0 small, 1 large")
        draft.size_means = ui.choice(
            "Size means", draft.size_means, ("rule", "radius", "mass", "both"), help="what else goes with the size"
        )
        if draft.kind == "custom":
            draft.radius_m = ui.slider("Radius", draft.radius_m, 0.03, 0.5, "m")
            draft.mass_kg = ui.slider("Mass", draft.mass_kg, 0.05, 20, "kg")
        draft.drag = ui.toggle("Air drag", draft.drag)
        startle = ui.toggle("The character startles", session.character.startle, help="a reflex first (3.2.6)")
        if startle != session.character.startle:
            session.change_character(startle=startle)
        ui.text(f"Noticed {_ttc_s(session):.2f} s before contact (eq. 4.1)", faint=True)
        ui.gap()
        if ui.button("Send it now   T", width=-1.0):
            session.send()
        session.auto_fire = ui.toggle("Auto-fire", session.auto_fire, help="whenever it plays its clip")
        session.auto_fire_s = ui.slider("Every", session.auto_fire_s, 1, 10, "s", digits=1)
        session.auto_vary = ui.toggle("from anywhere", session.auto_vary, help="direction, speed and target vary")
        if session.paused:
            ui.text("Paused: what you change here changes the last threat, and all that came of it.", faint=True)
            if vars(draft) != before:
                session.alter_last_threat()
        else:
            ui.text("Pause to change the threat that came last instead of the next.", faint=True)


def _ttc_s(session: Session) -> float:
    """How long before contact the character will notice the threat of the panel."""
    draft, world, row = session.threat, session.world, session.row
    make = make_threat(draft.kind, draft.speed_mps, draft.size)
    towards = coming_from(
        heading_of(world, row), math.radians(draft.azimuth_deg), math.radians(draft.elevation_deg)
    )  # fmt: skip
    return time_to_contact_s(make.speed_norm, facing_dot(world, row, towards), world.assets.settings.timing)
