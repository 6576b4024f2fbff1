"""The way a threat comes (thesis 3.1): from its state at contact, flown backwards to where it is perceived.

Azimuth and elevation say where it comes *from* in the character's heading: 0 ahead, +90 degrees its left, 180 behind,
elevation up.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from engine.maths import quaternion, vector
from engine.maths.ballistics import GRAVITY_MPS2, fly, longest_past_s

PATH_STEP_S = 1.0 / 120.0  # a tick: perception and contact fall on whole ones
ELEVATION_STEPS = 60


class Approach(NamedTuple):
    """A threat's flight from perception to contact. World metres, m/s."""

    start_m: tuple[float, float, float]  # where it is perceived
    start_mps: tuple[float, float, float]
    contact_m: tuple[float, float, float]  # where its centre is to be at contact
    contact_mps: tuple[float, float, float]
    ttc_s: float
    raised_deg: float  # how far the elevation had to be raised for the path to clear the floor
    shortened_s: float  # or the time to contact shortened


def coming_from(heading_rad: float, azimuth_rad: float, elevation_rad: float) -> tuple[float, float, float]:
    """Unit vector from the character to where the threat comes from, world."""
    level = math.cos(elevation_rad)
    local = (level * math.cos(azimuth_rad), level * math.sin(azimuth_rad), math.sin(elevation_rad))
    return quaternion.rotate(quaternion.about_z(heading_rad), local)


def fly_backwards(contact_m, contact_mps, ttc_s: float, drag: float):
    """State at perception: position and velocity, `ttc_s` before contact."""
    return fly(contact_m, contact_mps, GRAVITY_MPS2, drag, -ttc_s)


def lowest_m(contact_m, contact_mps, ttc_s: float, drag: float) -> float:
    """The lowest height of the ball's centre between perception and contact: that of either end, since a ball that has
    begun to fall goes on falling, with drag too.
    """
    return min(contact_m[2], fly_backwards(contact_m, contact_mps, ttc_s, drag)[0][2])


def plan_approach(
    contact_m,
    heading_rad: float,
    azimuth_rad: float,
    elevation_rad: float,
    speed_mps: float,
    ttc_s: float,
    *,
    radius_m: float = 0.0,
    drag: float = 0.0,
    low_path: str = "raise",
) -> Approach:
    """The flight that meets `contact_m` at this speed from this direction, perceived `ttc_s` earlier.

    Run backwards, a flat approach may lead under ground. `low_path` "raise" raises the elevation to the least that
    clears the floor; "shorten" keeps the direction and perceives it later. Both are reported in the result.
    """
    if drag > 0.0:
        ttc_s = min(ttc_s, 0.5 * longest_past_s(speed_mps, drag))

    def contact_velocity(elevation: float):
        return vector.scale(coming_from(heading_rad, azimuth_rad, elevation), -speed_mps)

    def clears(elevation: float, ttc: float) -> bool:
        return lowest_m(contact_m, contact_velocity(elevation), ttc, drag) >= radius_m

    elevation, ttc = elevation_rad, ttc_s
    if not clears(elevation, ttc):
        if low_path == "shorten":
            late = _bisect(lambda share: clears(elevation, ttc_s * (1.0 - share)), 0.0, 1.0)
            ttc = max(1, math.floor(ttc_s * (1.0 - late) / PATH_STEP_S)) * PATH_STEP_S
        else:
            elevation = _bisect(lambda e: clears(e, ttc_s), elevation_rad, 0.5 * math.pi - 1e-3)
    velocity = contact_velocity(elevation)
    start_m, start_mps = fly_backwards(contact_m, velocity, ttc, drag)
    raised = math.degrees(elevation - elevation_rad)
    return Approach(start_m, start_mps, tuple(contact_m), velocity, ttc, raised, ttc_s - ttc)


def _bisect(holds, low: float, high: float) -> float:
    """The least argument at which a condition that fails at `low` and holds at `high` holds, from above."""
    for _ in range(ELEVATION_STEPS):
        middle = 0.5 * (low + high)
        if holds(middle):
            high = middle
        else:
            low = middle
    return high
