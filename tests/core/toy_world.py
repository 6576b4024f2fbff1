"""A game for the tests of this room: balls fly, the wind pushes them, they bounce, wear out and are gone."""

from __future__ import annotations

import numpy as np

from engine.core.schedule import Schedule, Stage, system
from engine.core.world import Component, World, column

GRAVITY_MPS2 = 9.81
TICK_S = 1.0 / 120.0


class Flight(Component):
    """A body in free flight."""

    position_m = column(3)
    velocity_mps = column(3)


class Wear(Component):
    """How often a ball has bounced."""

    bounces = column(dtype=np.int64)
    cracked = column(dtype=bool)


class Marked(Component):
    """Somebody follows this one with their eyes."""


COMPONENTS = (Flight, Wear, Marked)


@system(Stage.SENSE, writes=(Flight,))
def fly(world, tick):
    rows = world.rows(Flight)
    flight = world[Flight]
    flight.velocity_mps[rows, 2] -= GRAVITY_MPS2 * TICK_S
    flight.velocity_mps[rows, 0] += world.random("wind").normal(0.0, 0.1)
    flight.position_m[rows] += flight.velocity_mps[rows] * TICK_S


@system(Stage.SIMULATE, reads=(Marked,), writes=(Flight, Wear))
def bounce(world, tick):
    flight = world[Flight]
    for row in world.rows(Flight, Wear):
        if flight.position_m[row, 2] < 0.0:
            flight.position_m[row, 2] *= -1.0
            flight.velocity_mps[row, 2] *= -0.8
            world[Wear].bounces[row] += 1
            world.emit("bounced", world.entity(row), height_m=flight.position_m[row, 2])


@system(Stage.SETTLE, writes=(Flight, Wear, Marked))
def wear_out(world, tick):
    for row in world.rows(Wear):
        if world[Wear].bounces[row] >= 3:
            world.emit("gone", world.entity(row))
            world.despawn(world.entity(row))


SYSTEMS = (wear_out, bounce, fly)  # out of order on purpose: stages put them right


def throw(world, command):
    """The one command there is: {"height_m": ..., "speed_mps": [x, y, z]}."""
    world.spawn(Flight(position_m=(0.0, 0.0, command["height_m"]), velocity_mps=command["speed_mps"]), Wear())


def toy(seed=7, balls=3, checked=False):
    """A world with some balls at different heights, and what steps it."""
    world = World(COMPONENTS, seed=seed)
    for number in range(balls):
        world.spawn(Flight(position_m=(0.0, number, 0.2 + 0.1 * number)), Wear())
    return world, Schedule(SYSTEMS, checked=checked).tick
