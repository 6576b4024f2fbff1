"""What the core costs a tick, and that columns are what makes a thousand run like one.

Times are printed by `pytest --benchmark-enable tests/benchmarks`. What must hold on any machine is a ratio of two
things measured side by side, each at its best of many; the absolute bounds are an order of magnitude wide.
"""

from __future__ import annotations

import timeit

import numpy as np
import pytest
from numba import njit

from engine.core.schedule import Schedule, Stage, system
from engine.core.world import Component, World, column

COUNT = 64
TICK_S = 1.0 / 120.0
GRAVITY_MPS2 = np.array([0.0, 0.0, -9.81])


class Flight(Component):
    """A body in free flight."""

    position_m = column(3)
    velocity_mps = column(3)


class Character(Component):
    """About as much as one character's pose, its blends and the physics behind it take: 2.4 thousand numbers."""

    rotations = column(8, 21, 4)
    positions_m = column(8, 21, 3)
    physics = column(1200)
    phase = column(dtype=np.int64)


@njit(cache=True)
def fly_rows(rows, position_m, velocity_mps, dt_s):
    """Free fall, exact for constant gravity."""
    for row in rows:
        for axis in range(3):
            pull_mps2 = -9.81 if axis == 2 else 0.0
            position_m[row, axis] += dt_s * (velocity_mps[row, axis] + 0.5 * pull_mps2 * dt_s)
            velocity_mps[row, axis] += pull_mps2 * dt_s


@system(Stage.SENSE, writes=(Flight,))
def fly(world, tick):
    flight = world[Flight]
    fly_rows(world.rows(Flight), flight.position_m, flight.velocity_mps, TICK_S)


class Projectile:
    """What one would write first: an object each, NumPy vectors inside."""

    def __init__(self, position_m, velocity_mps):
        self.position_m = position_m
        self.velocity_mps = velocity_mps

    def fly(self):
        self.position_m = self.position_m + TICK_S * (self.velocity_mps + 0.5 * GRAVITY_MPS2 * TICK_S)
        self.velocity_mps = self.velocity_mps + GRAVITY_MPS2 * TICK_S


def _starts():
    grid = np.arange(COUNT * 3, dtype=np.float64).reshape(COUNT, 3)
    return grid, np.flip(grid, axis=0) / 7.0


@pytest.fixture
def flying():
    """A world of 64 projectiles and what ticks it."""
    world = World((Character, Flight), seed=1)
    world.spawn(Character())
    for position_m, velocity_mps in zip(*_starts(), strict=True):
        world.spawn(Flight(position_m=position_m, velocity_mps=velocity_mps))
    schedule = Schedule([fly])
    schedule.tick(world)  # compiled
    return world, schedule


def _objects():
    return [Projectile(position_m, velocity_mps) for position_m, velocity_mps in zip(*_starts(), strict=True)]


def _fly_each(objects):
    for projectile in objects:
        projectile.fly()


def _best_us(function, number=200, repeat=15):
    return min(timeit.repeat(function, number=number, repeat=repeat)) / number * 1e6


def test_columns_and_objects_fly_alike(flying):
    world, schedule = flying
    objects = _objects()
    for _ in range(119):
        schedule.tick(world)
    for _ in range(120):
        _fly_each(objects)
    rows = world.rows(Flight)
    np.testing.assert_allclose(world[Flight].position_m[rows], [one.position_m for one in objects], rtol=1e-12)
    closed_form_m = _starts()[0] + _starts()[1] + 0.5 * GRAVITY_MPS2
    np.testing.assert_allclose(world[Flight].position_m[rows], closed_form_m, rtol=1e-12, atol=1e-12)


def test_a_tick_of_64_projectiles(benchmark, flying):
    world, schedule = flying
    before = world.tick
    benchmark(schedule.tick, world)
    assert world.tick > before


def test_a_tick_of_64_python_objects(benchmark):
    objects = _objects()
    benchmark(_fly_each, objects)
    assert objects[0].velocity_mps[2] < _starts()[1][0, 2]


def test_columns_are_many_times_faster_than_objects(flying):
    """Design, State: 6 us against 216 us. Half of that ratio is still the point."""
    world, schedule = flying
    objects = _objects()
    columns_us = _best_us(lambda: schedule.tick(world))
    objects_us = _best_us(lambda: _fly_each(objects), number=10)
    assert objects_us > 18 * columns_us, f"{columns_us:.1f} us against {objects_us:.1f} us"


def test_a_thousand_cost_less_than_sixteen_times_64(flying):
    """The cost of a system that does not depend on how many there are is paid once."""
    world, schedule = flying
    few_us = _best_us(lambda: schedule.tick(world))
    for _ in range(15 * COUNT):
        world.spawn(Flight(velocity_mps=(1, 2, 3)))
    many_us = _best_us(lambda: schedule.tick(world))
    assert many_us < 16 * few_us


def test_digest_of_20_kilobytes(benchmark, flying):
    world, _ = flying
    assert 15_000 < len(world.snapshot().state) < 25_000
    digest = benchmark(world.digest)
    assert digest == world.snapshot().digest


def test_snapshot_of_20_kilobytes(benchmark, flying):
    snapshot = benchmark(flying[0].snapshot)
    assert snapshot.tick == flying[0].tick


def test_restore_of_20_kilobytes(benchmark, flying):
    world, schedule = flying
    snapshot = world.snapshot()
    schedule.tick(world)
    benchmark(world.restore, snapshot)
    assert world.digest() == snapshot.digest


def test_access_to_a_component(benchmark, flying):
    world, _ = flying
    assert benchmark(world.__getitem__, Flight) is world[Flight]


def test_the_core_stays_out_of_the_way(flying):
    """Aims: access below 1 us, a digest about 30 us. Ten times that would be a fault on any machine."""
    world, _ = flying
    assert _best_us(lambda: world[Flight].position_m) < 10.0
    assert _best_us(lambda: world.rows(Flight)) < 10.0
    assert _best_us(world.digest) < 300.0
