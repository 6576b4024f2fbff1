"""A sweep of two azimuths, two speeds and two sizes: eight sustained poses in one strip, each difference to be seen."""

from __future__ import annotations

from itertools import product

from demos.figures.meeting import meet
from demos.figures.press import Press
from demos.figures.sheet import BODY, Sheet, number
from demos.figures.speeds import before_impact
from demos.figures.stills import Look, Strip

LOOK = Look(-48.0, 9.0)
PITCH_M = 1.2
TIME_S = 0.1
AZIMUTHS_DEG, SPEEDS_MPS, SIZES = (-15.0, 55.0), (22.8, 29.7), (0.0, 1.0)
LEVEL = 27.0  # from one row of words to the next


def draw(press: Press) -> Sheet:
    clip = press.clip("walk", "stand")
    eight = [
        meet(clip, TIME_S, azimuth, 8.0, speed, size, size_means="radius")
        for azimuth, speed, size in product(AZIMUTHS_DEG, SPEEDS_MPS, SIZES)
    ]
    strip = press.strip([before_impact(m) for m in eight], LOOK, 1000, PITCH_M)
    sheet = Sheet(strip.size[1] + 3 * LEVEL + 16, press.scale)
    sheet.picture(strip, 0, 0)
    radii_cm = [number(100 * m.make.radius_m, 0) for m in eight[:2]]
    levels = (
        (1, [f"size {number(size, 0)}, ø {2 * int(r)} cm" for size, r in zip(SIZES, radii_cm, strict=True)]),
        (2, [f"{number(speed, 1)} m/s" for speed in SPEEDS_MPS]),
        (4, [f"from {number(abs(a), 0)}° {'left' if a > 0 else 'right'}" for a in AZIMUTHS_DEG]),
    )
    middles = [strip.at(k, m.found.sustained.root_m)[0] for k, m in enumerate(eight)]
    for row, (each, words) in enumerate(levels):
        _brackets(sheet, strip, middles, each, words, strip.size[1] + 4 + row * LEVEL)
    return sheet


def _brackets(sheet: Sheet, strip: Strip, middles: list[float], each: int, words: list[str], y: float) -> None:
    """Words under every so many poses, with a line over what they hold for."""
    reach = 0.40 * (middles[1] - middles[0])
    for group in range(0, len(middles), each):
        first, last = middles[group] - reach, middles[group + each - 1] + reach
        if each > 1:
            sheet.line([(first, y), (last, y)], "hair")
        sheet.text(
            0.5 * (first + last), y + 3, words[group // each % len(words)], BODY if each > 1 else 13, align="center"
        )
