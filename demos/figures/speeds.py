"""Fig. 5.1: sustained poses just before impact, as the threat's speed rises from left to right."""

from __future__ import annotations

import numpy as np

from behaviours.perceive.threats import KINDS
from demos.figures.meeting import Meeting, arriving, balance_of, meet, posed
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet, number
from demos.figures.stills import Look
from engine.render.scene import SUSTAINED_ORANGE, Scene

LOOK = Look(-62.0, 9.0)
PITCH_M = 1.5
SPEEDS = 5
TIME_S = 0.1


def draw(press: Press) -> Sheet:
    clip, speeds = press.clip("walk", "stand"), np.linspace(*KINDS["volleyball"].speed_range_mps, SPEEDS)
    meetings = [meet(clip, TIME_S, 20.0, 8.0, float(speed)) for speed in speeds]
    strip = press.strip([before_impact(m) for m in meetings], LOOK, 1000, PITCH_M)
    sheet = Sheet(strip.size[1] + 58, press.scale)
    sheet.picture(strip, 0, 0)
    for k, (speed, m) in enumerate(zip(speeds, meetings, strict=True)):
        x, _ = strip.at(k, m.found.sustained.root_m)
        sheet.text(x, strip.size[1] + 4, f"{number(speed, 1)} m/s", BODY, align="center")
        lean = f"lean {number(m.found.controls[0])},  TTC {number(1000 * m.way.ttc_s, 0)} ms"
        sheet.text(x, strip.size[1] + 26, lean, SMALL, "faint", "center")
    return sheet


def before_impact(meeting: Meeting) -> Scene:
    """The sustained pose with the ball a hand's breadth off."""
    body, found = meeting.body, meeting.found
    return Scene(
        [posed(body, found.sustained, SUSTAINED_ORANGE)],
        [arriving(meeting, 0.08)],
        [balance_of(body, found.sustained, found.feet.held, SUSTAINED_ORANGE)],
    )
