"""One stance of a shape set, balanced (stance paper, 4 and 5), against the same method in plain numpy and SciPy.

A stance that also reaches is some forty times as much work; `brace bench --stance` times that, once.
"""

from __future__ import annotations

import numpy as np

from demos.benchmarks import Benchmark

SET, INTENSITY, OBJECT_M = "recoil-strong", 0.8, (1.2, 0.4, 1.3)
APART_M = 1e-5


def prepare() -> Benchmark:
    from behaviours.stance.solve import solve_stance
    from demos.benchmarks import plain_stance
    from engine.body.anthropometry import standard_body

    body = standard_body()
    case = solve_stance(body, SET, INTENSITY, object_m=OBJECT_M)

    def ours():
        return solve_stance(body, SET, INTENSITY, object_m=OBJECT_M)

    def plain():
        return plain_stance.balanced(body, case.plan, case.unknowns, np.zeros(2))[0]

    def check(ours, reference):
        assert np.abs(ours.joints_m - reference).max() < APART_M

    return Benchmark("one stance", ours, "plain numpy and SciPy, same method", plain, check)
