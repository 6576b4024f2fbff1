"""The Timing panel: when things happen, how poses are blended, what the blow does, and the way back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from demos.window.knob_widgets import draw_groups

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.widgets import Ui

GROUPS = (
    ("timing", "Time to contact (4.2, eq. 4.1)"),
    ("blend", "Blending (4.3)"),
    ("response", "The blow (4.1.2)"),
    ("recovery", "Recovery (4.1.3)"),
    ("search", "Another motion"),
)


class TimingPanel:
    """The clock first: how fast the window plays, and slow motion."""

    title = "Timing"

    def draw(self, ui: Ui, session: Session) -> None:
        session.clock.rate = ui.slider("Speed", session.clock.rate, 0.02, 2.0, "x", help="- and = change it by steps")
        session.slow_motion.enabled = ui.toggle(
            "Slow motion at the blow", session.slow_motion.enabled, help="begins just before contact and ends after it"
        )
        ui.gap()
        draw_groups(ui, session, GROUPS)
