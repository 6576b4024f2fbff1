"""The timeline along the bottom: phases in their colours, threats from notice to contact, what was thrown, and now."""

from __future__ import annotations

from typing import TYPE_CHECKING

from behaviours.components import Phase
from demos.window.phases import COLOURS, WORDS
from demos.window.timeline_view import TimelineView
from engine.core.clock import TICK_RATE_HZ
from engine.render.scene import BLEND_GREY

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.canvas import Canvas
    from engine.render.ui.widgets import Ui

HEIGHT, THREAT_Y, PHASE_Y, PHASE_HEIGHT = 52.0, 4.0, 15.0, 17.0
INK = (0.20, 0.23, 0.28, 1.0)
FAINT = (0.20, 0.23, 0.28, 0.55)
THREAT = (0.72, 0.20, 0.16, 0.85)
UNKNOWN = (0.20, 0.23, 0.28, 0.07)


class TimelineBar:
    """Draws the selected character's run; a click jumps, a drag scrubs, the wheel zooms."""

    def __init__(self) -> None:
        self.view = TimelineView()
        self.scrubbing = False

    def draw(self, ui: Ui, session: Session) -> None:
        canvas, view, run = ui.canvas("timeline", HEIGHT), self.view, session.run
        if canvas.wheel:
            view.zoom(canvas.wheel, canvas.mouse[0] / canvas.width)
        self._scrub(canvas, session)
        if not self.scrubbing:
            view.keep_up(session.tick, run.last_tick)
        _draw_phases(canvas, view, session)
        _draw_threats(canvas, view, session)
        for moment_s in view.seconds_marks():
            x = view.x_of(moment_s * TICK_RATE_HZ, canvas.width)
            canvas.line([(x, PHASE_Y + PHASE_HEIGHT), (x, PHASE_Y + PHASE_HEIGHT + 4)], FAINT)
            if x < canvas.width - 30.0:
                canvas.text(x + 3, PHASE_Y + PHASE_HEIGHT + 3, f"{moment_s:g} s", FAINT)
        _draw_now(canvas, view.x_of(session.tick, canvas.width))
        if canvas.hovered and not canvas.held:
            _tell(canvas, view, session)

    def _scrub(self, canvas: Canvas, session: Session) -> None:
        """Pressing pauses and jumps; the run follows the cursor until it lets go."""
        self.scrubbing = canvas.held
        if canvas.held:
            tick = self.view.tick_at(min(max(canvas.mouse[0], 0.0), canvas.width), canvas.width)
            session.clock.paused = True
            if min(max(tick, 0), session.run.last_tick) != session.tick:
                session.seek(tick)


def _draw_phases(canvas: Canvas, view: TimelineView, session: Session) -> None:
    low, high = PHASE_Y, PHASE_Y + PHASE_HEIGHT
    canvas.box(0, low, canvas.width, high, UNKNOWN, 3)
    for span in session.run.history.pasts[session.row].spans:
        left = max(view.x_of(span.first - 1, canvas.width), 0.0)
        right = min(view.x_of(span.last, canvas.width), canvas.width)
        if right > left:
            strength = 0.55 if span.phase == Phase.PLAY else 0.95
            canvas.box(left, low, right, high, (*COLOURS.get(span.phase, BLEND_GREY)[:3], strength))
    edge = view.x_of(session.run.last_tick, canvas.width)
    if 0.0 <= edge <= canvas.width:  # the live edge
        canvas.line([(edge, low - 2), (edge, high + 2)], FAINT, 1.5)


def _draw_threats(canvas: Canvas, view: TimelineView, session: Session) -> None:
    """A bar from notice to the contact that is expected, a diamond where it came, ticks for what was thrown."""
    for mark in session.run.history.marks:
        x = view.x_of(mark.tick, canvas.width)
        if mark.row != session.row or not -400.0 <= x <= canvas.width:
            continue
        if mark.kind in ("perceived", "flinched"):
            due = view.x_of(mark.tick + mark.data.get("ttc_s", 0.0) * TICK_RATE_HZ, canvas.width)
            ends = (max(x, 0.0), max(min(due, canvas.width), x + 2.0))
            canvas.box(ends[0], THREAT_Y + 2, ends[1], THREAT_Y + 6, (*THREAT[:3], 0.45), 2)
            canvas.line([(x, THREAT_Y), (x, THREAT_Y + 8)], THREAT, 2)
        elif x >= 0.0 and mark.kind in ("contact", "touch"):
            _diamond(canvas, x, THREAT_Y + 4, 5.0 if mark.kind == "contact" else 3.0)
            canvas.line([(x, PHASE_Y), (x, PHASE_Y + PHASE_HEIGHT)], (1.0, 1.0, 1.0, 0.9), 1.5)
    for tick in session.run.inputs:
        x = view.x_of(tick, canvas.width)
        if 0.0 <= x <= canvas.width:
            y = PHASE_Y + PHASE_HEIGHT
            canvas.triangle((x - 4, y + 7), (x + 4, y + 7), (x, y), FAINT)


def _diamond(canvas: Canvas, x: float, y: float, r: float) -> None:
    canvas.triangle((x - r, y), (x, y - r), (x + r, y), THREAT)
    canvas.triangle((x - r, y), (x + r, y), (x, y + r), THREAT)


def _draw_now(canvas: Canvas, x: float) -> None:
    canvas.line([(x, 1.0), (x, PHASE_Y + PHASE_HEIGHT + 5)], INK, 2)
    canvas.triangle((x - 5, 0), (x + 5, 0), (x, 6), INK)


def _tell(canvas: Canvas, view: TimelineView, session: Session) -> None:
    """What was there, in words, beside the cursor."""
    tick = view.tick_at(canvas.mouse[0], canvas.width)
    if not 0 <= tick <= session.run.last_tick:
        canvas.hint("not played yet")
        return
    spans = session.run.history.pasts[session.row].spans
    phase = next((span.phase for span in spans if span.first - 1 <= tick <= span.last), Phase.PLAY)
    words = f"{tick / TICK_RATE_HZ:.2f} s   {WORDS[phase]}"
    near = 5.0 * view.span / canvas.width
    for mark in session.run.history.marks:
        if mark.row == session.row and abs(mark.tick - tick) <= near:
            part = f" at the {mark.data['part']}" if "part" in mark.data else ""
            words += f"\n{mark.kind}{part}"
    canvas.hint(words)
