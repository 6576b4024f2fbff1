"""One tick of 64 projectiles as columns of the world, against 64 Python objects."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from demos.benchmarks import Benchmark

COUNT = 64
TICK_S = 1.0 / 120.0
GRAVITY_MPS2 = np.array([0.0, 0.0, -9.81])


@dataclass
class Projectile:
    """What one would write first."""

    position_m: np.ndarray
    velocity_mps: np.ndarray

    def fly(self):
        self.position_m = self.position_m + self.velocity_mps * TICK_S + 0.5 * GRAVITY_MPS2 * TICK_S**2
        self.velocity_mps = self.velocity_mps + GRAVITY_MPS2 * TICK_S


def prepare() -> Benchmark:
    from engine.core.schedule import Schedule, Stage, system
    from engine.core.world import Component, World, column

    class Flight(Component):
        """A body in free flight."""

        position_m = column(3)
        velocity_mps = column(3)

    step_m, step_mps = 0.5 * GRAVITY_MPS2 * TICK_S**2, GRAVITY_MPS2 * TICK_S

    @system(Stage.SENSE, reads=(Flight,), writes=(Flight,))
    def fly(world, tick):
        flight = world[Flight]
        flight.position_m += flight.velocity_mps * TICK_S
        flight.position_m += step_m
        flight.velocity_mps += step_mps

    chance = np.random.default_rng(2)
    starts, velocities = chance.normal(size=(COUNT, 3)), chance.normal(size=(COUNT, 3))
    world = World(components=(Flight,), seed=0)
    rows = [
        world.row(world.spawn(Flight(position_m=start, velocity_mps=velocity)))
        for start, velocity in zip(starts, velocities, strict=True)
    ]
    schedule = Schedule([fly])
    objects = [Projectile(start, velocity) for start, velocity in zip(starts, velocities, strict=True)]

    def columns():
        schedule.tick(world)
        return world[Flight].position_m[rows[-1]]

    def each():
        for projectile in objects:
            projectile.fly()
        return objects[-1].position_m

    def check(ours, reference):
        np.testing.assert_allclose(ours, reference, atol=1e-9)

    return Benchmark(f"a tick of {COUNT} projectiles", columns, f"{COUNT} Python objects", each, check)
