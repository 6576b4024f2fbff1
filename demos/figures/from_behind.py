"""Fig. 3.11: a threat to the head from behind, two views: hands behind the head, elbows around its sides."""

from __future__ import annotations

from demos.figures.meeting import arriving, meet, posed
from demos.figures.press import Press
from demos.figures.sheet import Sheet
from demos.figures.stills import Look
from engine.render.scene import SUSTAINED_ORANGE, Scene

VIEWS = ((Look(155.0, 14.0), "from behind"), (Look(35.0, 8.0), "from the front"))
TIME_S = 0.1
UNIT = 210.0  # units for a metre


def draw(press: Press) -> Sheet:
    m = meet(press.clip("walk", "stand"), TIME_S, 180.0, 12.0, 25.0, 0.5)
    scene = Scene([posed(m.body, m.found.sustained, SUSTAINED_ORANGE)], [arriving(m, 0.6)])
    stills = [press.still_at(scene, look, UNIT) for look, _ in VIEWS]
    height = max(still.size[1] for still in stills)
    sheet = Sheet(height + 30, press.scale, sum(still.size[0] for still in stills))
    x = 0.0
    for still, (_, words) in zip(stills, VIEWS, strict=True):
        y = height - still.size[1]
        sheet.picture(still, x, y)
        sheet.text(x + still.at(m.found.sustained.root_m)[0], height + 4, words, align="center")
        x += still.size[0]
    return sheet
