"""A tick of a whole reaction, perception to return, against the same with every access of the systems checked."""

from __future__ import annotations

from demos.benchmarks import Benchmark

TICKS = 240


def prepare() -> Benchmark:
    from behaviours.simulation import Simulation
    from demos.running import open_scenario, start

    first = start(*open_scenario("sway"))
    clip = first.world.assets.clips[0]
    begin = first.world.snapshot()
    checked = Simulation(first.scenario, lambda spec: clip, checked=True)

    def run(simulation):
        simulation.world.restore(begin)
        for _ in range(TICKS):
            simulation.step()
        return simulation.world.digest()

    def check(ours, reference):
        assert ours == reference

    return Benchmark(
        "a tick of a reaction", lambda: run(first), "the same, every access checked", lambda: run(checked), check, TICKS
    )
