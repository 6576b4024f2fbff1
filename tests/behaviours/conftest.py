"""Runs that several files look at: simulated once."""

from __future__ import annotations

import pytest

from behaviours.components import Flight
from tests.behaviours.runs import AHEAD, run, simulation_of


@pytest.fixture(scope="session")
def blocked():
    """The embedded clip, somebody who startles, a ball at the head from the front left: the whole of fig. 4.1."""
    return run([AHEAD], startle=True, duration_s=3.0)


@pytest.fixture(scope="session")
def unseen():
    """The same ball at somebody who sees nothing coming."""
    return run([AHEAD], protects=False, duration_s=2.0)


@pytest.fixture(scope="session")
def missed():
    """The ball is taken out of the air before it arrives."""
    simulation = simulation_of([AHEAD], startle=False, duration_s=3.0)
    for _ in range(simulation.ticks):
        if simulation.world.tick == 80:
            simulation.world.despawn(simulation.world.entity(int(simulation.world.rows(Flight)[0])))
        simulation.step()
    return simulation
