"""Fig. 4.1: the timing schematic, to scale, with the running durations."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.perceive.threats import make_threat
from behaviours.scenario_spec import CharacterSpec
from behaviours.settings import Settings
from behaviours.timing import ease, time_to_contact_s
from demos.figures.press import Press
from demos.figures.sheet import BODY, SMALL, Sheet, number
from engine.render.scene import BLEND_GREY, CLIP_BLUE, SIMULATED_RED, SUSTAINED_ORANGE

SPEED_MPS = 26.0
BEFORE_S, AFTER_S = 0.22, 0.22
CLIP_Y, STARTLE_Y, SUSTAINED_Y, SIMULATED_Y = 72.0, 118.0, 236.0, 296.0
AXIS_Y, HEIGHT, LEFT, RIGHT = 340.0, 470.0, 16.0, 984.0
THICK = 3.4


class Clock(NamedTuple):
    """Seconds from perception at which the regions of the schematic end."""

    startle: float
    contact: float
    response: float
    part_one: float
    part_two: float
    hold: float  # where the returning sequence leaves the sustained pose


def clock_of(settings: Settings) -> Clock:
    """From the settings in force, for a volleyball from straight ahead."""
    r, t = settings.recovery, settings.timing
    contact = time_to_contact_s(make_threat("volleyball", SPEED_MPS, 0.5).speed_norm, 1.0, t)
    response = contact + CharacterSpec().response_s
    part_one = response + r.part_one_s
    returning_s = r.part_two_s / (1.0 - r.part_one_share)
    return Clock(
        t.startle_s, contact, response, part_one, part_one + r.part_two_s, part_one - r.part_one_share * returning_s
    )


def draw(press: Press) -> Sheet:
    settings = Settings()
    clock, sheet = clock_of(settings), Sheet(HEIGHT, press.scale)
    span = clock.part_two + BEFORE_S + AFTER_S

    def x(seconds):
        return LEFT + (RIGHT - LEFT) * (np.asarray(seconds) + BEFORE_S) / span

    _curves(sheet, clock, settings, x)
    _poses(sheet, clock, settings, x)
    _regions(sheet, clock, x)
    sheet.legend(
        LEFT, HEIGHT - 14,
        [(CLIP_BLUE, "motion capture"), (SIMULATED_RED, "physical simulation"), (SUSTAINED_ORANGE, "sustained pose"),
         ("#22262d", "blends"), (BLEND_GREY, "blends not part of the final motion")], 13.5, 22,
    )  # fmt: skip
    return sheet


def _curves(sheet: Sheet, clock: Clock, settings: Settings, x) -> None:
    def curve(start, end, heights, colour, width=THICK):
        times = np.linspace(start, end, 60)
        sheet.line(list(zip(x(times), heights(times), strict=True)), colour, width, layer=4)

    def blend(since, lasts, low, high):
        return lambda times: np.array([low + (high - low) * ease((t - since) / lasts) for t in times])

    curve(-BEFORE_S, 0.0, lambda t: CLIP_Y + 0 * t, CLIP_BLUE)
    curve(clock.part_two, clock.part_two + AFTER_S, lambda t: CLIP_Y + 0 * t, CLIP_BLUE)
    curve(0.0, clock.startle, blend(0.0, clock.startle, CLIP_Y, STARTLE_Y), "ink")
    # stretched by the slack, so that it is never quite over when the threat arrives
    lasts = (clock.contact - clock.startle) * (1.0 + settings.timing.slack_share)
    protect = blend(clock.startle, lasts, STARTLE_Y, SUSTAINED_Y)
    curve(clock.startle, clock.contact, protect, "ink")

    reached = float(protect([clock.contact])[0])
    simulated = blend(clock.contact, 1.25 * (clock.part_one - clock.contact), reached, SIMULATED_Y)
    curve(clock.contact, clock.response, simulated, SIMULATED_RED)
    curve(clock.response, clock.part_one, simulated, SIMULATED_RED, 1.6)
    curve(clock.contact, clock.hold, lambda t: SUSTAINED_Y + 0 * t, SUSTAINED_ORANGE, 1.9)
    returning = blend(clock.hold, clock.part_two - clock.hold, SUSTAINED_Y, CLIP_Y)
    curve(clock.hold, clock.part_one, returning, BLEND_GREY, 1.6)

    def part_one(times):
        share = np.array([ease((t - clock.response) / (clock.part_one - clock.response)) for t in times])
        return (1.0 - share) * simulated(times) + share * returning(times)

    curve(clock.response, clock.part_one, part_one, "ink")
    curve(clock.part_one, clock.part_two, returning, "ink")


def _poses(sheet: Sheet, clock: Clock, settings: Settings, x) -> None:
    """Dashed: where the computed poses stand, and which pose of the clip each was made from."""
    for when, label, ahead_s in (
        (clock.startle, "startle", settings.timing.startle_ahead_s),
        (clock.contact, "sustained", settings.timing.sustained_ahead_s),
        (clock.part_two, "return", settings.timing.sustained_ahead_s),
    ):
        sheet.line([(float(x(when)), 34.0), (float(x(when)), AXIS_Y)], "faint", 1.2, dashed=True)
        sheet.text(float(x(when)), 10, f"$P_\\mathrm{{{label}}}$", BODY + 1, align="center")
        sheet.text(float(x(when)) + 7, 34, f"clip + {number(1000 * ahead_s, 0)} ms", SMALL - 1.5, "faint", halo=True)
    sheet.line([(float(x(0.0)), 34.0), (float(x(0.0)), AXIS_Y)], "faint", 1.2, dashed=True)
    sheet.text(float(x(0.0)), 12, "perception", SMALL + 1, "ink", "center", italic=True)
    sheet.text(
        float(x(clock.contact)) - 8, SUSTAINED_Y + 16, "contact", SMALL + 1, "ink", "right", italic=True, halo=True
    )


def _regions(sheet: Sheet, clock: Clock, x) -> None:
    """Each region with its milliseconds, and the brackets of what they make up."""
    ends = [0.0, clock.startle, clock.contact, clock.response, clock.part_one, clock.part_two]
    names = ("startle", "protective motion", "dynamic\nresponse", "recovery,\npart one", "recovery, part two")
    sheet.line([(LEFT, AXIS_Y), (RIGHT, AXIS_Y)], "ink", 1.4)
    for start, end, name in zip(ends, ends[1:], names, strict=False):
        middle = 0.5 * float(x(start) + x(end))
        sheet.text(middle, AXIS_Y + 7, number(1000 * (end - start), 0), BODY + 1, align="center", bold=True)
        sheet.text(middle, AXIS_Y + 28, name, SMALL - 0.5, "faint", "center")
    for when in ends:
        sheet.line([(float(x(when)), AXIS_Y - 5), (float(x(when)), AXIS_Y + 5)], "ink", 1.4)
    y = AXIS_Y + 76
    sheet.arrow((float(x(0.0)), y), (float(x(clock.contact)), y), "ink", 1.2, 8, both=True)
    words = f"time to contact, {number(1000 * clock.contact, 0)} ms at {number(SPEED_MPS, 0)} m/s (eq. 4.1)"
    sheet.text(0.5 * float(x(0.0) + x(clock.contact)), y + 5, words, SMALL, align="center")
    sheet.text(RIGHT, y, "milliseconds, to scale", SMALL, "faint", "right", "center", italic=True)
