"""Free flight. One function for prediction and simulation, forwards and backwards, so that none can drift."""

from __future__ import annotations

import math

from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

GRAVITY_MPS2 = (0.0, 0.0, -9.80665)
AIR_KGPM3 = 1.204  # at 20 degrees
LONGEST_STEP_S = 1.0 / 120.0


@njit(cache=True)
def drag_per_m(radius_m, mass_kg, coefficient):
    """Quadratic drag of a ball: it loses this share of its speed per metre of way. 0.5 rho C A / m, in 1 / m.

    A volleyball at spike speed is past the drag crisis (Reynolds number 3.5e5): C about 0.2; below 15 m/s about 0.45
    (Asai et al. 2010, Fundamental aerodynamics of a new volleyball, Sports Technology 3).
    """
    return 0.5 * AIR_KGPM3 * coefficient * math.pi * radius_m * radius_m / mass_kg


@njit(cache=True)
def longest_past_s(speed_mps, drag):
    """How far back a flight with drag (1 / m) can be run: before, it would have been infinitely fast; inf without."""
    return 1.0 / (drag * speed_mps) if drag * speed_mps > 0.0 else math.inf


@inner_kernel
def _drift(x, y, z, u, v, w, drag, h):
    """Exact flight without gravity: speed s / (1 + k s h), way ln(1 + k s h) / k, straight on."""
    loss = drag * math.sqrt(u * u + v * v + w * w) * h
    if loss <= -1.0:
        return (math.nan, math.nan, math.nan, math.nan, math.nan, math.nan)
    way = h * (math.log1p(loss) / loss if abs(loss) > 1e-12 else 1.0)
    keep = 1.0 / (1.0 + loss)
    return (x + u * way, y + v * way, z + w * way, u * keep, v * keep, w * keep)


@njit(cache=True)
def fly(position_m, velocity_mps, gravity_mps2, drag, dt_s):
    """Where a ball is, and how fast, after dt_s (negative: was before). (3,), (3,), (3,), 1 / m, s -> two tuples.

    x'' = g - k |x'| x' by Strang's splitting: half of gravity's kick, exact flight with drag alone, the other half; in
    equal steps of a tick at most. Without drag it is the exact parabola for any dt; with drag, second order, and run
    backwards in the same steps it comes back to rounding. nan where the past is longer than longest_past_s.
    """
    x, y, z = position_m[0], position_m[1], position_m[2]
    u, v, w = velocity_mps[0], velocity_mps[1], velocity_mps[2]
    steps = max(1, math.ceil(abs(dt_s) / LONGEST_STEP_S - 1e-6)) if drag != 0.0 else 1
    h = dt_s / steps
    gx, gy, gz = 0.5 * h * gravity_mps2[0], 0.5 * h * gravity_mps2[1], 0.5 * h * gravity_mps2[2]
    for _ in range(steps):
        x, y, z, u, v, w = _drift(x, y, z, u + gx, v + gy, w + gz, drag, h)
        u, v, w = u + gx, v + gy, w + gz
    return (x, y, z), (u, v, w)
