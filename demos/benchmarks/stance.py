"""One reaching stance (stance paper, section 5), against the same method in plain numpy and SciPy."""

from __future__ import annotations

import numpy as np

from demos.benchmarks import Benchmark

SET, INTENSITY, TARGET_M = "reach-eager", 0.6, (0.58, -0.3, 1.25)
APART_M = 0.01  # both searches stop within their tolerances, not at the same point


def prepare() -> Benchmark:
    from behaviours.stance import solver, torso
    from behaviours.stance.solve import solve_stance
    from demos.benchmarks import plain_stance
    from engine.body.anthropometry import standard_body

    body = standard_body()

    def ours():
        return solve_stance(body, SET, INTENSITY, reach_right_m=TARGET_M)

    case = ours()
    bounds = torso.amplitude_bounds(body, case.plan.classes, case.plan.opposed)

    def plain():
        return plain_stance.solve(body, case.plan, case.wishes, bounds, solver.STOPS_IMPROVING)

    def check(ours, reference):
        assert ours.outcome.cycles > 0  # both really had something to find
        assert ours.outcome.yields == 0
        assert np.abs(ours.joints_m - reference[0]).max() < APART_M

    return Benchmark("one stance that reaches", ours, "plain numpy and SciPy, same method", plain, check)
