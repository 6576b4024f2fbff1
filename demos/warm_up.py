"""A tiny run through everything that is compiled, so that set-up pays for it and no tick ever does."""

from __future__ import annotations


def whole_reaction() -> None:
    """The embedded clip, a ball, the blow and the recovery: every kernel that a scenario can need is called once."""
    from demos.running import open_scenario, start

    simulation = start(*open_scenario("sway"))
    for _ in range(simulation.ticks):
        simulation.step()
