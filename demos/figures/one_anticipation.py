"""Fig. 1.1: one anticipation as a filmstrip, from the clip to the sustained pose, through the blow, and back."""

from __future__ import annotations

from typing import Any

import numpy as np

from behaviours.timing import TICK_S
from demos.figures.press import Press
from demos.figures.sheet import SMALL, Sheet, number
from demos.figures.stills import Look
from demos.figures.take import LEGEND, Take, take
from engine.render.scene import Scene

SCENARIO: dict[str, Any] = {
    "duration_s": 2.6,
    "character": [{"clip": "walk", "start_s": 0.5, "startle": False}],
    "threat": [{"azimuth_deg": 30.0, "elevation_deg": 10.0, "speed_mps": 27.0, "size": 0.5, "perceived_s": 0.5}],
}
LOOK = Look(-62.0, 8.0)
PITCH_M = 1.06
TOP = 8


def draw(press: Press) -> Sheet:
    run = take(press, SCENARIO)
    ticks = moments(run)
    strip = press.strip([centred(run, tick) for tick in ticks], LOOK, 1000, PITCH_M)
    sheet = Sheet(TOP + strip.size[1] + 74, press.scale)
    sheet.picture(strip, 0, TOP)
    line_y = TOP + strip.size[1] + 12
    sheet.arrow((8, line_y), (992, line_y), "hair", 1.4)
    for k, tick in enumerate(ticks):
        x, _ = strip.at(k, (0.0, 0.0, 0.0))
        seconds = (tick - run.contact) * TICK_S
        sheet.circle((x, line_y), 3.2, fill=run.colour(tick), edge="white")
        sheet.text(x, line_y + 9, f"{number(seconds)} s", SMALL, "faint", "center")
    sheet.legend(8, sheet.height - 14, LEGEND)
    sheet.text(992, sheet.height - 14, "time from contact", SMALL, "faint", "right", "center", italic=True)
    return sheet


def moments(run: Take) -> list[int]:
    """Ticks worth a picture: before, the blend, the pose as it is reached, the blow, and the way back."""
    reached, over = run.contact - 1, next(t for t in range(run.contact, len(run.frames)) if run.frames[t].phase == 0)
    blending = np.linspace(run.perceived, reached, 4)[1:3]
    back = np.linspace(run.contact + 9, over, 5)[1:4]
    chosen = [run.perceived - 15, run.perceived - 1, *blending, reached, run.contact + 8, *back, over + 6]
    return [round(tick) for tick in chosen]


def centred(run: Take, tick: int) -> Scene:
    """The character over the origin; the ball only where it is near."""
    scene = run.scene(tick, run.frames[tick].pose.root_m)
    scene.balls = [ball for ball in scene.balls if np.hypot(*np.asarray(ball.position_m)[:2]) < 1.0]
    return scene
