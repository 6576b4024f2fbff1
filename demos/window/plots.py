"""Two plots of the last seconds: how safely the centre of mass stands, and what the head goes through."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from behaviours.components import Phase
from engine.core.clock import TICK_RATE_HZ

if TYPE_CHECKING:
    from demos.window.session import Session
    from engine.render.ui.canvas import Canvas
    from engine.render.ui.widgets import Ui

SPAN_S = 4.0
HEIGHT = 62.0
TITLE_HEIGHT = 15.0
INK = (0.20, 0.23, 0.28, 1.0)
FAINT = (0.20, 0.23, 0.28, 0.55)
GRID = (0.20, 0.23, 0.28, 0.14)
CONTACT = (0.72, 0.20, 0.16, 0.8)
CURVE = (0.24, 0.43, 0.62, 1.0)


def draw_plots(ui: Ui, session: Session) -> None:
    """Both, one above the other, of the selected character, up to the moment that is shown."""
    past, tick = session.run.history.pasts[session.row], session.tick
    ticks = round(SPAN_S * TICK_RATE_HZ)
    margin_cm = 100.0 * session.run.history.window(past.margin_m, tick, ticks)
    head_g = session.run.history.window(past.head_g, tick, ticks)
    contacts = [
        (mark.tick - tick) / TICK_RATE_HZ
        for mark in session.run.history.marks
        if mark.row == session.row and mark.kind == "contact" and tick - ticks < mark.tick <= tick
    ]
    absent = "lies" if session.phase == Phase.DOWN else "in the air"
    canvas = ui.canvas("margin", HEIGHT + TITLE_HEIGHT)
    _plot(canvas, "COM inside the feet", "cm", margin_cm, (-20.0, 15.0), contacts, absent)
    most = max(10.0, float(np.nanmax(head_g, initial=0.0)))
    _plot(ui.canvas("head", HEIGHT + TITLE_HEIGHT), "head acceleration", "g", head_g, (0.0, rounded_up(most)), contacts)


def rounded_up(most: float) -> float:
    """The next of 10, 20, 50, 100, ... so that the scale does not creep."""
    return next(step * 10.0**power for power in range(1, 9) for step in (1.0, 2.0, 5.0) if step * 10.0**power >= most)


def _plot(canvas: Canvas, title: str, unit: str, values: np.ndarray, ends, contacts: list[float], absent="") -> None:
    """One curve, newest at the right; nan leaves a gap, and `absent` says why there is none now."""
    low, high = ends
    top, bottom = TITLE_HEIGHT, canvas.height - 1.0
    now = values[-1] if len(values) and np.isfinite(values[-1]) else None
    canvas.text(0, 0, title, FAINT)
    canvas.text(canvas.width, 0, f"{now:.1f} {unit}" if now is not None else absent, INK, right=True)

    def y_of(value: float) -> float:
        return bottom - (min(max(value, low), high) - low) / (high - low) * (bottom - top)

    for level in (low, 0.0, high):
        canvas.line([(0, y_of(level)), (canvas.width, y_of(level))], GRID if level else FAINT)
    canvas.text(2, top, f"{high:g}", FAINT)
    for after_s in contacts:
        x = canvas.width * (1.0 + after_s / SPAN_S)
        canvas.line([(x, top), (x, bottom)], CONTACT, 1.5)
    for stretch in curves(values):
        points = [
            (canvas.width * (1.0 - (len(values) - 1 - k) / (SPAN_S * TICK_RATE_HZ)), y_of(float(values[k])))
            for k in stretch
        ]
        canvas.line(points, CURVE, 1.6)


def curves(values: np.ndarray) -> list[list[int]]:
    """Runs of indices where there are values; peaks must not be lost, so every tick is kept."""
    runs: list[list[int]] = [[]]
    for k, value in enumerate(values):
        if np.isfinite(value):
            runs[-1].append(k)
        elif runs[-1]:
            runs.append([])
    return [run for run in runs if run]
