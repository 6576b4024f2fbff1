"""Fig. 3.10: the three cases of balancing and bracing, real ones: the centre of mass as it is and as it is wanted."""

from __future__ import annotations

from behaviours.protect.sustained import Case
from demos.figures.meeting import balance_of, posed
from demos.figures.plan import draw_plan
from demos.figures.press import Press
from demos.figures.search_cases import Tried, first_of_each
from demos.figures.sheet import SMALL, TITLE, Sheet
from demos.figures.stills import Look
from engine.body.skeleton import Pose
from engine.render.scene import RULES_YELLOW, SUSTAINED_ORANGE, Scene

WANTED = {
    "1": lambda t: t.meeting.found.case == Case.BALANCED and t.before_m > 0.015 and t.after_m > 0.02,
    "2": lambda t: t.meeting.found.case == Case.BRACED_OUT and t.before_m > 0.01 and t.after_m < -0.02,
    "3": lambda t: t.meeting.found.case == Case.UNRECOVERED and t.before_m < -0.06 and t.after_m > 0.5 * t.before_m,
}
WORDS = {"1": "in balance, stays in balance", "2": "out, to brace for the impact", "3": "too far out to be mended"}
COLUMN, PLAN, UNIT = 333, 230, 260.0  # widths of a column and of its plan, units for a metre in the plan
TOP = 52


def draw(press: Press) -> Sheet:
    found = first_of_each(press, WANTED)
    stills = {name: _still(press, tried) for name, tried in found.items()}
    height = max((still.size[1] for still in stills.values()), default=200.0)
    sheet = Sheet(TOP + height + PLAN + 60, press.scale, 3 * COLUMN)
    for k, name in enumerate(WANTED):
        middle = (k + 0.5) * COLUMN
        sheet.text(middle, 6, f"case {name}", TITLE, align="center", bold=True)
        sheet.text(middle, 29, WORDS[name], SMALL, "faint", "center", italic=True)
        if name not in found:
            sheet.text(middle, TOP + 0.5 * height, "none found among these clips", SMALL, "faint", "center")
            continue
        still = stills[name]
        sheet.picture(still, middle - 0.5 * still.size[0], TOP + height - still.size[1])
        current, wanted = (found[name].meeting.found.com_rules_m, found[name].meeting.found.com_wanted_m)
        draw_plan(sheet, found[name].meeting, current, wanted, (middle, TOP + height + 10 + 0.5 * PLAN), UNIT)
        clip = f"{found[name].clip}, {found[name].time_s:.2f} s"
        sheet.text(middle, TOP + height + PLAN + 8, clip, SMALL, "faint", "center")
    y = sheet.height - 16
    end = sheet.legend(10, y, [(RULES_YELLOW, "$COM_{cur}$"), (SUSTAINED_ORANGE, "$COM_{des}$")])
    sheet.line([(end + 40, y), (end + 40 + 0.1 * UNIT, y)], "ink", 2.0)
    sheet.text(end + 48 + 0.1 * UNIT, y, "10 cm", SMALL, valign="center")
    sheet.arrow((end + 130, y), (end + 165, y), "ink", 1.8, 9)
    sheet.text(end + 173, y, "travel of the threat", SMALL, valign="center")
    return sheet


def _still(press: Press, tried: Tried):
    m, found = tried.meeting, tried.meeting.found
    here = Pose(found.sustained.root_m - found.sustained.root_m * (1.0, 1.0, 0.0), found.sustained.rotations)
    scene = Scene([posed(m.body, here, SUSTAINED_ORANGE)])
    scene.balances = [balance_of(m.body, here, found.feet.held, SUSTAINED_ORANGE)]
    return press.still_at(scene, Look(-58.0 if tried.azimuth_deg > 0 else 58.0, 16.0), 142.0)
