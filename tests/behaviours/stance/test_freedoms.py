"""The paper's 48 degrees of freedom (section 3), and that stances move nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.stance import frame
from behaviours.stance.freedoms import FREEDOMS, count
from behaviours.stance.shape_sets import SETS
from behaviours.stance.solve import solve_stance
from engine.body.skeleton import ANKLES, JOINT_COUNT, PELVIS
from engine.maths import quaternion


def test_there_are_forty_eight():
    assert count() == 48


@pytest.mark.parametrize("name", SETS)
def test_a_stance_moves_these_alone(body, name):
    entry = SETS[name]
    reach_m = (0.45, -0.25, 1.3) if name.startswith("reach") else None
    for intensity in (entry.low, 0.4, entry.high):
        stance = solve_stance(body, name, intensity, object_m=(0.9, 0.5, 1.2), reach_right_m=reach_m)
        for joint in set(range(JOINT_COUNT)) - {PELVIS, *ANKLES}:
            angles = dict(zip("XYZ", frame.angles(stance.pose.rotations[joint]), strict=True))
            still = set("XYZ") - set(FREEDOMS[joint][1] if joint in FREEDOMS else "")
            assert all(abs(angles[axis]) < 1e-7 for axis in still), (joint, angles)


def test_an_ankle_turns_about_x_and_then_z(body):
    """Whatever the legs do, the hinge of shin and foot has no third turn: undone about X and then Z, nothing is
    left.
    """
    stance = solve_stance(body, "recoil-strong", 1.0, object_m=(0.9, 0.5, 1.2))
    for ankle in ANKLES:
        w, x, y, z = stance.pose.rotations[ankle]
        # q = about project Y (a) * about project X (b): w = ca cb, x = ca sb, y = sa cb, z = -sa sb
        assert w * z == pytest.approx(-x * y, abs=1e-12)
        a, b = 2.0 * np.arctan2(y, w), 2.0 * np.arctan2(x, w)
        again = quaternion.multiply(quaternion.about_y(a), quaternion.about_x(b))
        assert abs(np.dot(again, stance.pose.rotations[ankle])) == pytest.approx(1.0, abs=1e-9)
