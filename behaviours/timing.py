"""Timing (thesis 4.2): how long before contact the character notices, and the clock of every blend of fig. 4.1."""

from __future__ import annotations

import math

from behaviours.settings import Timing
from engine.maths.kernel import njit

TICK_S = 1.0 / 120.0


def time_to_contact_s(speed_norm: float, facing_dot_threat: float, timing: Timing) -> float:
    """How long before contact a character notices (thesis 4.2, eq. 4.1), seconds.

    `speed_norm` in [0, 1]; `facing_dot_threat` is the cosine between the way the character faces and the direction
    from its head to the threat. Faster threats leave less time; threats from the side leave more, as eccentric ones are
    reacted to sooner (Li and Laurent 2001). `ttc_model = "text"` is the reading of the words around the equation.
    """
    aside = 1.0 - facing_dot_threat
    if timing.ttc_model == "text":
        return (timing.ttc_least_s + timing.ttc_range_s * speed_norm) * (1.0 + timing.ttc_side_gain_text * aside)
    return (timing.ttc_least_s + timing.ttc_range_s * (1.0 - speed_norm)) * (1.0 + timing.ttc_side_gain * aside)


def facing_dot_threat(heading_rad: float, towards) -> float:
    """Cosine between the way a character faces, its heading, and a unit direction towards the threat (for eq. 4.1)."""
    return math.cos(heading_rad) * towards[0] + math.sin(heading_rad) * towards[1]


def whole_ticks(seconds: float) -> int:
    """The nearest number of ticks, at least one."""
    return max(1, round(seconds / TICK_S))


@njit(cache=True)
def ease(progress):
    """Ease in, ease out (EIEO): 0 to 1 with no velocity at either end, clamped outside. The cubic 3 u^2 - 2 u^3."""
    u = min(max(progress, 0.0), 1.0)
    return u * u * (3.0 - 2.0 * u)


@njit(cache=True)
def overshoot(after_s, share, period_s, half_life_s):
    """How far beyond its end a movement still goes, as a share of its way: a swing about the end that begins gently
    and dies.

    What fills a pause instead of a freeze (thesis 4.2, left to future work there). No velocity at first; `share` is the
    greatest swing there could be, were it not dying away.
    """
    if after_s <= 0.0:
        return 0.0
    alive = 2.0 ** (-after_s / half_life_s)
    return 4.0 * share * alive * (1.0 - alive) * math.sin(2.0 * math.pi * after_s / period_s)


@njit(cache=True)
def arc(progress):
    """Up from 0 to 1 and back to 0 with no velocity at either end: the height of a step. sin^2(pi u)."""
    u = min(max(progress, 0.0), 1.0)
    return math.sin(math.pi * u) ** 2
