"""One sustained pose (thesis 3.3), against SciPy's BFGS on the very same compiled objective from the same start."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from demos.benchmarks import Benchmark

WORSE_SHARE = 0.01  # how much above SciPy's least total error ours may end


def prepare() -> Benchmark:
    from scipy.optimize import minimize

    from behaviours.protect.solve_pose import solve_bfgs
    from behaviours.protect.task import new_posed
    from behaviours.protect.total_error import FORMS, RESIDUALS, residuals_into, total_error
    from behaviours.rules.controls import CONTROL_COUNT

    task, reference, start, settings = standing_task()
    form, solver = FORMS.index(settings.objective.form), settings.solver
    posed, controls, residuals = new_posed(), np.empty(CONTROL_COUNT), np.empty(RESIDUALS)

    def error(variables):
        residuals_into(task, reference, variables, controls, posed, residuals)
        return total_error(residuals, reference, form)

    def slope(variables):
        steps = solver.offset * np.eye(len(variables))
        return [(error(variables + step) - error(variables - step)) / (2 * solver.offset) for step in steps]

    def ours():
        found = solve_bfgs(
            task, reference, form, start, posed, solver.offset, solver.tolerance, solver.iterations, solver.restarts
        )
        return found.value

    def scipys():
        return minimize(error, start, jac=slope, method="BFGS").fun

    def check(ours, reference):
        assert ours <= reference * (1.0 + WORSE_SHARE)
        assert ours < 0.5 * error(start)  # both really had something to find

    return Benchmark("one sustained pose, ten variables", ours, "SciPy's BFGS, same objective", scipys, check)


def standing_task() -> tuple[Any, Any, np.ndarray, Any]:
    """Somebody standing straight, a volleyball at the head from the front left: task, reference, start, settings."""
    from behaviours.perceive.perceived import PerceivedThreat, aim_of
    from behaviours.protect.sustained import protect
    from behaviours.protect.task import AtPerception
    from behaviours.settings import Settings
    from engine.body.anthropometry import standard_body
    from engine.body.skeleton import JOINT_COUNT, LEFT_ANKLE, LEFT_HIP, LEFT_KNEE, Pose

    body, settings = standard_body(), Settings()
    height_m = -body.offset_m[[LEFT_HIP, LEFT_KNEE, LEFT_ANKLE], 2].sum() - body.sole_m[0, 0, 2]
    standing = Pose(np.array([0.0, 0.0, height_m]), np.tile([1.0, 0.0, 0.0, 0.0], (JOINT_COUNT, 1)))
    travel = (-math.cos(math.radians(30)), -math.sin(math.radians(30)), 0.0)
    joint, offset_m = aim_of(body, "head")
    threat = PerceivedThreat(travel, travel, (0.0, 0.0, 1.6), joint, offset_m)
    found = protect(body, AtPerception(standing, standing, np.array([True, True])), threat, settings)
    return found.task, found.reference, np.concatenate([np.zeros(3), found.controls_initial]), settings
