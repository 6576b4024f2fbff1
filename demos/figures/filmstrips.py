"""Fig. 5.2: three filmstrips: back to the same motion; into a new one after a mild blow; and after an extreme one."""

from __future__ import annotations

from typing import Any

import numpy as np

from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet, number
from demos.figures.stills import Look
from demos.figures.take import LEGEND, Take, take

LOOK = Look(-62.0, 9.0)
PITCH_M = 1.12
PICTURES = 10
HEAD, BAND = 26, 24  # over and under each strip
MILD = {"azimuth_deg": 25.0, "elevation_deg": 10.0, "speed_mps": 26.0, "size": 0.5, "perceived_s": 0.5}
EXTREME = {**MILD, "azimuth_deg": 10.0, "speed_mps": 29.0, "size": 1.0, "size_means": "both", "mass_kg": 6.0}
ROWS: tuple[tuple[str, str, dict[str, Any]], ...] = (
    ("the same motion", "same", MILD),
    ("a new motion, mild blow", "new", MILD),
    ("a new motion, extreme blow", "new", EXTREME),
)


def draw(press: Press) -> Sheet:
    runs = [take(press, scenario(recover, threat)) for _, recover, threat in ROWS]
    strips, chosen = [], []
    for run in runs:
        ticks = moments(run)
        scenes = [run.scene(tick, run.frames[tick].pose.root_m) for tick in ticks]
        for scene in scenes:
            scene.balls = [ball for ball in scene.balls if np.hypot(*np.asarray(ball.position_m)[:2]) < 1.0]
        chosen.append(ticks)
        strips.append(press.strip(scenes, LOOK, 1000, PITCH_M))
    sheet = Sheet(sum(strip.size[1] + HEAD + BAND for strip in strips) + 34, press.scale)
    y = 0.0
    for (name, _, _), run, ticks, strip in zip(ROWS, runs, chosen, strips, strict=True):
        y += HEAD
        sheet.picture(strip, 0, y)
        sheet.text(8, y - HEAD + 4, f"{name}{_returned(run)}", BODY + 1, italic=True)
        for k, tick in enumerate(ticks):
            seconds = run.frames[tick].time_s - run.frames[run.contact].time_s
            x, _ = strip.at(k, (0.0, 0.0, 0.0))
            sheet.text(x, y + strip.size[1] + 2, f"{number(seconds)} s", SMALL, "faint", "center")
        y += strip.size[1] + BAND
    sheet.legend(8, sheet.height - 14, LEGEND)
    return sheet


def scenario(recover: str, threat: dict[str, Any]) -> dict[str, Any]:
    """A walker who is met by such a threat."""
    character = {"clip": "walk", "start_s": 0.5, "startle": False, "recover": recover}
    return {"duration_s": 5.0, "character": [character], "threat": [threat]}


def moments(run: Take) -> list[int]:
    """From just before perception until the new motion is under way, the blow among them."""
    first, reached = run.perceived - 1, run.contact - 1
    playing = [t for t in range(run.contact, len(run.frames)) if run.frames[t].phase == 0]
    over = min(playing[0] + 24 if playing else len(run.frames) - 1, len(run.frames) - 1)
    return [first, (first + reached) // 2, reached] + [round(t) for t in np.linspace(run.contact + 8, over, PICTURES - 3)]


def _returned(run: Take) -> str:
    return f": {run.clip_name}"
