"""Springs as animators use them: set by how long they take, and exact, so that no result depends on the time step.

After Holden 2021, Spring-It-On (theorangeduck.com/page/spring-roll-call), and, for inertialisation, Bollo 2018 (GDC,
Gears of War): at a switch only the offset to the new motion is kept, with its velocity, and left to die away.
"""

from __future__ import annotations

import math

from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


@njit(cache=True)
def critical(value, velocity, goal, half_life_s, dt_s):
    """A critically damped spring after dt_s: (value, velocity). From rest, 0.6 of the way is left after one half-life.

    x(t) = goal + (j0 + (v + j0 y) t) e^(-y t), y = 4 ln 2 / (2 half-life).
    """
    y = 2.0 * math.log(2.0) / max(half_life_s, 1e-9)
    offset = value - goal
    slope = velocity + offset * y
    fade = math.exp(-y * dt_s)
    return goal + fade * (offset + slope * dt_s), fade * (velocity - slope * y * dt_s)


@njit(cache=True)
def decaying(value, velocity, half_life_s, dt_s):
    """The same towards zero: what is left of an offset at a switch, and of its velocity."""
    return critical(value, velocity, 0.0, half_life_s, dt_s)


@njit(cache=True)
def damped(value, velocity, goal, frequency_hz, damping_ratio, dt_s):
    """A spring that overshoots (damping ratio under 1), exactly, after dt_s: (value, velocity).

    x'' = -w^2 (x - goal) - 2 z w x', w = 2 pi f, 0 <= z < 1.
    """
    w = 2.0 * math.pi * frequency_hz
    z = min(max(damping_ratio, 0.0), 0.999999)
    ringing = w * math.sqrt(1.0 - z * z)
    offset = value - goal
    b = (velocity + z * w * offset) / ringing
    fade, c, s = math.exp(-z * w * dt_s), math.cos(ringing * dt_s), math.sin(ringing * dt_s)
    swing = fade * (offset * c + b * s)
    return goal + swing, fade * ringing * (b * c - offset * s) - z * w * swing


@inner_kernel
def critical3(value, velocity, goal, half_life_s, dt_s):
    """`critical` for three-vectors."""
    x, u = critical(value[0], velocity[0], goal[0], half_life_s, dt_s)
    y, v = critical(value[1], velocity[1], goal[1], half_life_s, dt_s)
    z, w = critical(value[2], velocity[2], goal[2], half_life_s, dt_s)
    return (x, y, z), (u, v, w)


@njit(cache=True)
def half_sine(t_s, duration_s):
    """The share of an impulse that a half-sine force has delivered by t_s: 0 before, (1 - cos) / 2, 1 after.

    The shape of a ball's force while it is flattened and springs back (spec A8).
    """
    if t_s <= 0.0:
        return 0.0
    if t_s >= duration_s:
        return 1.0
    return 0.5 * (1.0 - math.cos(math.pi * t_s / duration_s))
