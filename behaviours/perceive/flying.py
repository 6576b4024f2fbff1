"""Balls in the air and on the floor: flight by the one ballistic function, spin, and bounces off the ground."""

from __future__ import annotations

import math

import numpy as np

from behaviours.components import Flight, Posture
from behaviours.timing import TICK_S
from engine.core.schedule import Stage, system
from engine.maths import quaternion
from engine.maths.ballistics import GRAVITY_MPS2, fly
from engine.maths.kernel import njit
from engine.physics.impact import HOLLOW, contact_impulse

ROLLING = 0.02  # resistance of a ball that rolls on a hard floor, as a share of its weight
STILL_MPS, FAR_M, REST_TICKS = 0.05, 60.0, 5 * 120
UP = (0.0, 0.0, 1.0)


@njit(cache=True)
def bounce(velocity, spin, radius_m, restitution, friction):
    """What is left of velocity and spin after the ground has pushed back: the impact law of `engine.physics.impact`."""
    gives = np.diag(np.array([1.0 + 1.0 / HOLLOW, 1.0 + 1.0 / HOLLOW, 1.0]))  # of a unit mass, at its lowest point
    # the point of contact moves with the ball and with its spin: v + w x (0, 0, -r)
    gap = (velocity[0] - spin[1] * radius_m, velocity[1] + spin[0] * radius_m, velocity[2])
    j = contact_impulse(gives, gap, UP, restitution, friction)
    turn = 1.0 / (HOLLOW * radius_m)
    return (
        (velocity[0] + j[0], velocity[1] + j[1], velocity[2] + j[2]),
        (spin[0] + turn * j[1], spin[1] - turn * j[0], spin[2]),
    )


@njit(cache=True)
def fly_one_tick(position, velocity, spin, turned, radius_m, drag, restitution, friction, dt_s):
    """A ball one tick on, in place. It lands at the instant its skin meets the ground, not at the end of the tick."""
    p, v = fly(position, velocity, GRAVITY_MPS2, drag, dt_s)
    w = (spin[0], spin[1], spin[2])
    if p[2] < radius_m and v[2] < 0.0:
        start_z, end_z = position[2], p[2]
        share = 0.0 if start_z <= radius_m else (start_z - radius_m) / (start_z - end_z)
        p, v = fly(position, velocity, GRAVITY_MPS2, drag, share * dt_s)
        left_s = (1.0 - share) * dt_s
        v, w = bounce(v, w, radius_m, restitution, friction)
        if v[2] < -GRAVITY_MPS2[2] * dt_s:  # would not leave the ground for a whole tick: it slides, then rolls
            v, w = bounce((v[0], v[1], GRAVITY_MPS2[2] * left_s), w, radius_m, 0.0, friction)
            slow = max(0.0, 1.0 + ROLLING * GRAVITY_MPS2[2] * left_s / max(math.hypot(v[0], v[1]), 1e-9))
            v, w = (v[0] * slow, v[1] * slow, 0.0), (w[0] * slow, w[1] * slow, w[2] * slow)
            p = (p[0] + v[0] * left_s, p[1] + v[1] * left_s, radius_m)
        else:
            p, v = fly((p[0], p[1], radius_m), v, GRAVITY_MPS2, drag, left_s)
    q = quaternion.from_rotation_vector((w[0] * dt_s, w[1] * dt_s, w[2] * dt_s))
    q = quaternion.normalise(quaternion.multiply(q, turned))
    for k in range(3):
        position[k], velocity[k], spin[k] = p[k], v[k], w[k]
    for k in range(4):
        turned[k] = q[k]


@njit(cache=True)
def fly_all(rows, position, velocity, spin, turned, radius_m, drag, restitution, friction, dt_s):
    """One tick for the balls in these rows of the `Flight` columns."""
    for row in rows:
        fly_one_tick(
            position[row],
            velocity[row],
            spin[row],
            turned[row],
            radius_m[row],
            drag[row],
            restitution[row],
            friction[row],
            dt_s,
        )


@system(Stage.SENSE, reads=(Flight, Posture), writes=(Flight,))
def clear_away(world, tick):
    """Balls that have lain still for long, or are far from everybody, are taken away: a state that is played for
    hours stays small.
    """
    rows = world.rows(Flight)
    if not len(rows):
        return
    f, people = world[Flight], world[Posture].root_m[world.rows(Posture)]
    still = (f.velocity_mps[rows] ** 2).sum(axis=1) < STILL_MPS**2
    away = ((f.position_m[rows, None] - people) ** 2).sum(axis=2).min(axis=1, initial=np.inf) > FAR_M**2
    f.rested[rows] = np.where(still | away, f.rested[rows] + 1, 0)
    for row in rows[f.rested[rows] > REST_TICKS]:
        world.despawn(world.entity(row))


@system(Stage.SENSE, reads=(Flight,), writes=(Flight,))
def fly_balls(world, tick):
    """Threats fly (and bounce, and roll)."""
    rows = world.rows(Flight)
    if not len(rows):
        return
    f = world[Flight]
    f.before_m[rows] = f.position_m[rows]
    f.before_turned[rows] = f.turned[rows]
    fly_all(
        rows.astype(np.int64), f.position_m, f.velocity_mps, f.spin_radps, f.turned,
        f.radius_m, f.drag_per_m, f.restitution, f.friction, TICK_S,
    )  # fmt: skip
