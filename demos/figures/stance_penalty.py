"""Stance paper, fig. 4: the penalty on a value that strays: a desired point and four cubic Hermite pieces."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.stance.penalty import HIGH, LOW, Side, penalty_of, row
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet, number

ACCENT = "#b3261e"
PIECES = ("#2a5fc4", "#7d9be0")  # basin, wall
GAP = 40.0


class Kind(NamedTuple):
    """A penalty to draw: what it is for, and both its sides."""

    title: str
    low: Side
    high: Side


KINDS = (
    Kind("two pieces on either side: a basin, then a wall", Side(0.8, 0.12, 2.0, 1.0), Side(0.8, 0.12, 2.0, 1.0)),
    Kind("any value in a range: flat basin", Side(1.2, 0.0, 2.0, 1.0), Side(1.2, 0.0, 2.0, 1.0)),
    Kind("a certain value: steep sides", Side(0.3, 0.15, 1.0, 1.0), Side(0.3, 0.15, 1.0, 1.0)),
    Kind("one side favoured: asymmetric", Side(0.4, 0.2, 1.0, 1.0), Side(1.4, 0.06, 2.2, 0.5)),
)
BIG, SMALL_PLOT = (500.0, 330.0), (360.0, 92.0)
REACH = 2.5  # how far from the desired value the plots go


def draw(press: Press) -> Sheet:
    sheet = Sheet(BIG[1] + 118, press.scale)
    _plot(sheet, KINDS[0], (56.0, 40.0), BIG, True)
    for k, kind in enumerate(KINDS[1:]):
        _plot(sheet, kind, (1000.0 - SMALL_PLOT[0] - 20.0, 40.0 + k * (SMALL_PLOT[1] + 34.0)), SMALL_PLOT, False)
    sheet.legend(56.0, sheet.height - 18, [(PIECES[0], "basin"), (PIECES[1], "wall"), (ACCENT, "desired value")], BODY)
    return sheet


def _plot(sheet: Sheet, kind: Kind, corner, size, lettered: bool) -> None:
    x0, y0 = corner
    penalty = row(0.0, kind.low, kind.high)

    def at(stray: float, height: float) -> tuple[float, float]:
        return x0 + size[0] * (0.5 + 0.5 * stray / REACH), y0 + size[1] * (1.0 - min(height, 1.15) / 1.15)

    sheet.text(x0, y0 - 8, kind.title, BODY if lettered else SMALL, valign="bottom", italic=not lettered)
    sheet.arrow(at(-REACH, 0.0), (at(REACH, 0.0)[0] + 14, at(0.0, 0.0)[1]), "faint", 1.4, 8)
    sheet.arrow(at(-REACH, 0.0), (at(-REACH, 0.0)[0], y0 - 2), "faint", 1.4, 8)
    for side, sign in ((LOW, -1.0), (HIGH, 1.0)):
        basin, far = penalty[side], penalty[side + 2]
        for k, (start, end) in enumerate(((0.0, basin), (basin, far))):
            stray = sign * np.linspace(start, end, 60)
            sheet.line([at(s, penalty_of(penalty, s)) for s in stray], PIECES[k], 3.0 if lettered else 2.2)
        beyond = sign * np.linspace(far, REACH, 20)
        inside = [s for s in beyond if penalty_of(penalty, s) <= 1.15]
        if len(inside) > 1:
            sheet.line([at(s, penalty_of(penalty, s)) for s in inside], PIECES[1], 1.4, dashed=True)
        for end in (basin, far):
            place = at(sign * end, penalty_of(penalty, sign * end))
            if lettered:
                sheet.line([place, at(sign * end, 0.0)], "hair", 1.1, dashed=True)
            sheet.circle(place, 4.5 if lettered else 3.2, fill="white", edge="ink", line=1.6)
    sheet.circle(at(0.0, 0.0), 6.0 if lettered else 4.5, fill=ACCENT, edge="none")
    if lettered:
        _letters(sheet, at, kind)


def _letters(sheet: Sheet, at, kind: Kind) -> None:
    low, high = kind.low, kind.high
    y = at(0.0, 0.0)[1]
    sheet.text(at(0.0, 0.0)[0], y + 12, "desired value", BODY, ACCENT, "center")
    for stray, words in ((high.basin, "basin"), (high.far, "far"), (-low.basin, "basin"), (-low.far, "far")):
        sheet.text(at(stray, 0.0)[0], y + 12, words, SMALL, "faint", "center")
    x = at(0.5 * (high.basin + high.far), 0.0)[0]
    sheet.text(x - 24, at(0.0, 0.6)[1], "wall", BODY, PIECES[1], "right")
    sheet.text(at(0.42 * high.basin, 0.0)[0], at(0.0, 0.13)[1], "basin", BODY, PIECES[0], "center", "bottom")
    for height in (high.basin_height, high.far_height):
        sheet.text(at(-REACH, 0.0)[0] - 8, at(0.0, height)[1], number(height), SMALL, "faint", "right", "center")
    sheet.text(at(-REACH, 0.0)[0] + 10, at(0.0, 1.13)[1], "$f$", BODY)
