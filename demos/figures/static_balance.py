"""Fig. 3.9: rules and sustained pose; left in balance from the start, so it only braces; right out of it, so both."""

from __future__ import annotations

from demos.figures.meeting import balance_of, posed
from demos.figures.plan import draw_plan
from demos.figures.press import Press
from demos.figures.search_cases import Tried, first_of_each
from demos.figures.sheet import BODY, SMALL, Sheet, number
from demos.figures.stills import Look, seen_points, spans_m
from engine.body.skeleton import Pose
from engine.render.scene import RULES_YELLOW, SUSTAINED_ORANGE, Scene

WANTED = {
    "in balance: braced": lambda t: t.before_m > 0.02 and t.after_m > 0.01 and _plain(t),
    "out of balance: balanced and braced": lambda t: t.before_m < -0.01 and t.after_m > 0.015 and _plain(t),
}
WIDTH, GAP, BAND, PLAN = 430, 20, 92, 130
UNIT, PLAN_UNIT = 200.0, 230.0  # units for a metre
ELEVATION_DEG = 20.0


def _plain(tried: Tried) -> bool:
    """Seen at a glance: from about ahead, with some lean."""
    return abs(tried.azimuth_deg) < 45.0 and float(tried.meeting.found.controls[0]) > 0.3


def draw(press: Press) -> Sheet:
    found = first_of_each(press, WANTED)
    stills = {name: _still(press, tried) for name, tried in found.items()}
    height = max(still.size[1] for still in stills.values())
    sheet = Sheet(height + PLAN + BAND, press.scale, 2 * WIDTH + GAP)
    for k, name in enumerate(WANTED):
        middle = k * (WIDTH + GAP) + 0.5 * WIDTH
        sheet.text(middle, height + PLAN + 6, name, BODY, align="center")
        if name not in found:
            sheet.text(middle, 0.5 * height, "none found among these clips", SMALL, "faint", "center", italic=True)
            continue
        sheet.picture(stills[name], middle - 0.5 * stills[name].size[0], height - stills[name].size[1])
        m = found[name].meeting
        draw_plan(
            sheet, m, m.found.com_rules_m, m.found.com_m, (middle, height + 0.5 * PLAN), PLAN_UNIT, facing_right=True
        )
        sheet.text(middle, height + PLAN + 30, _margins(found[name]), SMALL, "faint", "center")
    sheet.legend(10, sheet.height - 14, [(RULES_YELLOW, "rules alone"), (SUSTAINED_ORANGE, "sustained pose")])
    return sheet


def _still(press: Press, tried: Tried):
    m, found = tried.meeting, tried.meeting.found
    about = found.sustained.root_m * (1.0, 1.0, 0.0)
    scenes = []
    for pose, colour in ((found.rules, RULES_YELLOW), (found.sustained, SUSTAINED_ORANGE)):
        here = Pose(pose.root_m - about, pose.rotations)
        scenes.append(
            Scene([posed(m.body, here, colour)], balances=[balance_of(m.body, here, found.feet.held, colour)])
        )
    # from where the arms do not hide the body
    side = -1.0 if tried.azimuth_deg > 0 else 1.0
    look = Look(side * 62.0, ELEVATION_DEG)
    across_m, _ = spans_m(look, seen_points(scenes))
    return press.layers(scenes, look, UNIT * across_m, shadows=True)


def _margins(tried: Tried) -> str:
    words = [
        f"{number(100 * abs(m), 1)} cm {'inside' if m >= 0 else 'outside'}" for m in (tried.before_m, tried.after_m)
    ]
    return f"COM from the edge: {words[0]}, then {words[1]}"
