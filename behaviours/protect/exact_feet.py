"""The pose that is shown: planted feet exactly where they are planted, both arms fitted in."""

from __future__ import annotations

import numpy as np

from behaviours.protect.apply_rules import apply_rules
from behaviours.protect.fit_arms import fit_arms
from behaviours.protect.task import Posed, Task
from engine.body.skeleton import HIPS
from engine.maths import vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

EXACT = 0.0  # leg reach without the soft end: for poses that are shown
LOWERINGS = 20  # each closes what is missing but for the leg's slant


def pose_exactly(task: Task, shift: np.ndarray, controls: np.ndarray, posed: Posed, tolerance_m: float) -> np.ndarray:
    """Writes the pose with planted feet where they are planted and both arms as they are shown; returns how far the
    pelvis had to give (3,), metres.

    No kernel itself: Python needs both halves for themselves too, and would wait seconds for the code of all three.
    """
    given = stand_exactly(task, shift, controls, posed, tolerance_m)
    fit_arms(task, controls, posed)
    return given


@njit(cache=True)
def stand_exactly(task, shift, controls, posed, tolerance_m):
    """Writes the pose with planted feet where they are planted, arms as the rules want them; returns how far the
    pelvis had to give (3,), metres.

    The pelvis is lowered by what is missing, which leaves the COM over the same ground. Only where the foot lies
    farther to the side than the leg is long is it drawn towards it.
    """
    given, most = np.zeros(3), np.zeros(3)
    apply_rules(task, shift, controls, EXACT, posed)
    for _ in range(LOWERINGS):
        short = 0
        most[:] = 0.0
        for side in range(2):
            if task.feet.held[side] and posed.foot_miss_m[side] > tolerance_m:
                short += 1
                hip, ankle = vector.at(posed.positions, HIPS[side]), vector.at(task.feet.ankle_m, side)
                x, y, z = _missing(hip, ankle, task.build.leg_m[side])
                most[0] += x
                most[1] += y
                most[2] = min(most[2], z)
        if short == 0:
            break
        given[0] += most[0] / short
        given[1] += most[1] / short
        given[2] += most[2]
        apply_rules(task, shift + given, controls, EXACT, posed)
    return given


@inner_kernel
def _missing(hip, ankle, leg_m):
    """What brings one hip within reach of its foot: down; along the leg too, where it lies farther aside than down."""
    reach = leg_m - 1e-6
    x, y, z = vector.subtract(hip, ankle)
    level = reach * reach - x * x - y * y
    if level > 0.25 * reach * reach:
        return (0.0, 0.0, np.sqrt(level) - z)
    return vector.scale((x, y, z), reach / vector.length((x, y, z)) - 1.0)
