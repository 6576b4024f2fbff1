"""Fig. 1.2: the four stages at the instant of impact, with support polygon and centre of mass."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from demos.figures.meeting import balance_of, posed
from demos.figures.one_anticipation import SCENARIO
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet, number
from demos.figures.stills import Look
from demos.figures.take import Take, take
from engine.body.skeleton import Pose
from engine.body.support import margin_m
from engine.clips.playback import planted_at
from engine.render.scene import CLIP_BLUE, RULES_YELLOW, SIMULATED_RED, SUSTAINED_ORANGE, Scene

LOOK = Look(-50.0, 18.0)
PITCH_M = 1.75
TOP = 6
AFTER_TICKS = 6  # of the blow: far enough into it to see it


def draw(press: Press) -> Sheet:
    run = take(press, SCENARIO)
    scenes = stages(run, press)
    strip = press.strip(scenes, LOOK, 1000, PITCH_M)
    sheet = Sheet(TOP + strip.size[1] + 62, press.scale)
    sheet.picture(strip, 0, TOP)
    words = ("clip", "rules alone", "sustained pose", "simulated")
    for k, (word, scene) in enumerate(zip(words, scenes, strict=True)):
        balance = scene.balances[0]
        x, _ = strip.at(k, (*balance.com_m[:2], 0.0))
        margin = margin_m(balance.support_m, balance.com_m[:2])
        where = f"COM {number(abs(100 * margin), 1)} cm {'inside' if margin >= 0 else 'outside'}"
        y = TOP + strip.size[1] + 6
        sheet.circle(
            (x - 0.5 * sheet.width_of(word) - 14, y + 0.62 * BODY), 5.5, fill=scene.figures[0].colour, edge="none"
        )
        sheet.text(x, y, word, BODY, align="center")
        sheet.text(x, y + 24, where if np.isfinite(margin) else "no foot planted", SMALL, "faint", "center")
    return sheet


def stages(run: Take, press: Press) -> list[Scene]:
    """Clip, rules, sustained, simulated: each over the origin by the middle of its feet."""
    frame, struck = run.frames[run.contact - 1], run.frames[run.contact + AFTER_TICKS]
    clip = press.clip(SCENARIO["character"][0]["clip"])
    clip_s = SCENARIO["character"][0]["start_s"] + frame.time_s
    about = 0.5 * (run.sustained.root_m[:2] + run.rules.root_m[:2])
    scenes = [
        _stage(run, run.clip, run.clip.root_m, planted_at(clip, clip_s), CLIP_BLUE),
        _stage(run, run.rules, about, frame.planted, RULES_YELLOW),
        _stage(run, run.sustained, about, frame.planted, SUSTAINED_ORANGE),
        _stage(run, struck.pose, about, frame.planted, SIMULATED_RED),
    ]
    scenes[3].balls = [replace(ball, position_m=ball.position_m - np.array([*about, 0.0])) for ball in struck.balls]
    return scenes


def _stage(run: Take, pose: Pose, about_m, planted, colour) -> Scene:
    pose = Pose(pose.root_m - (*about_m[:2], 0.0), pose.rotations)
    return Scene([posed(run.body, pose, colour)], balances=[balance_of(run.body, pose, planted, colour)])
