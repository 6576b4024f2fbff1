"""Fig. 3.12: the clip, and sustained poses against threats to the head, to the pelvis and to the torso between."""

from __future__ import annotations

from demos.figures.meeting import arriving, balance_of, meet, posed
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet, number
from demos.figures.stills import Look
from engine.render.scene import CLIP_BLUE, SUSTAINED_ORANGE, Scene

LOOK = Look(-58.0, 9.0)
PITCH_M = 1.6
TIME_S = 0.1
TARGETS = ("head", "pelvis", "torso")


def draw(press: Press) -> Sheet:
    clip = press.clip("walk", "stand")
    meetings = [meet(clip, TIME_S, 15.0, 8.0, 26.0, 0.5, target) for target in TARGETS]
    first = meetings[0]
    scenes = [Scene([posed(first.body, first.clip, CLIP_BLUE)])]
    for m in meetings:
        pose = m.found.sustained
        balance = balance_of(m.body, pose, m.found.feet.held, SUSTAINED_ORANGE)
        scenes.append(Scene([posed(m.body, pose, SUSTAINED_ORANGE)], [arriving(m, 0.1)], [balance]))
    strip = press.strip(scenes, LOOK, 900, PITCH_M)
    sheet = Sheet(strip.size[1] + 56, press.scale, 900)
    sheet.picture(strip, 0, 0)
    words = [("clip", "")] + [
        (f"impact to the {target}" if target != "torso" else "impact between", _weights(m))
        for target, m in zip(TARGETS, meetings, strict=True)
    ]
    for k, (word, weights) in enumerate(words):
        x, _ = strip.at(k, first.clip.root_m if k == 0 else meetings[k - 1].found.sustained.root_m)
        sheet.text(x, strip.size[1] + 4, word, BODY, align="center")
        sheet.text(x, strip.size[1] + 27, weights, SMALL, "faint", "center")
    return sheet


def _weights(meeting) -> str:
    """Eq. 3.4."""
    head, pelvis = meeting.threat.head_weight, meeting.threat.pelvis_weight
    return f"$W_\\mathrm{{head}}$ {number(head)}, $W_\\mathrm{{pelvis}}$ {number(pelvis)}"
