"""What a limit forbids a planted leg is answered by the knee, as little as it must, the foot staying."""

import math

import numpy as np
import pytest

from behaviours.protect.apply_rules import apply_rules
from behaviours.protect.prepare import prepare
from behaviours.protect.task import AtPerception, new_posed
from behaviours.rules.controls import controls_from_threat
from behaviours.settings import Settings
from engine.body import limb_freedom as freedom
from engine.body.limits import from_components
from engine.body.skeleton import ANKLES, HIPS
from tests.behaviours.people import BODY, BOTH, coming, standing

LOW, HIGH = (-0.5, -0.6, -0.7), (0.5, 0.6, 0.7)


def test_overrun_is_nothing_inside_and_the_distance_outside():
    assert freedom.overrun_rad(LOW, HIGH, 0.0, from_components(0.4, -0.5, 0.6)) == 0.0
    assert freedom.overrun_rad(LOW, HIGH, 0.0, from_components(0.8, 0.0, 0.0)) == pytest.approx(0.3)
    assert freedom.overrun_rad(LOW, HIGH, 0.1, from_components(0.0, 0.0, -0.7)) == pytest.approx(0.1)
    assert freedom.overrun_rad(LOW, HIGH, 0.0, from_components(0.8, 0.0, 1.1)) == pytest.approx(0.5)


def posed_with(task, controls):
    posed = new_posed()
    apply_rules(task, np.zeros(3), controls, 0.01, posed)
    return posed


def task_with(**limits):
    """A task whose limits are drawn in at one joint: joint=(axis, low, high)."""
    task = prepare(BODY, AtPerception(standing(), standing(), BOTH), coming(20), Settings())
    for joint, (axis, low, high) in limits.items():
        task.start.low_rad[int(joint[1:]), axis], task.start.high_rad[int(joint[1:]), axis] = low, high
    return task


def test_a_free_limb_is_left_alone():
    posed = posed_with(task_with(), controls_from_threat(0.3, 0.3))
    assert np.all(posed.trouble == 0.0)


def test_a_knee_gives_way_and_the_foot_stays():
    controls = controls_from_threat(0.5, 0.9)
    free = posed_with(task_with(), controls)
    component = freedom.components(tuple(free.rotations[HIPS[0]]))[2]
    tight = task_with(**{f"j{HIPS[0]}": (2, min(component, 0) + math.radians(8), 1.0)})
    held = posed_with(tight, controls)
    assert held.trouble[0] == 0.0
    assert freedom.components(tuple(held.rotations[HIPS[0]]))[2] >= tight.start.low_rad[HIPS[0], 2]
    assert held.positions[ANKLES[0]] == pytest.approx(free.positions[ANKLES[0]], abs=1e-9)
    assert held.orientations[ANKLES[0]] == pytest.approx(free.orientations[ANKLES[0]], abs=1e-9)
