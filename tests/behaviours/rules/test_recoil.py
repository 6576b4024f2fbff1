"""Recoil by its outcome: shoulders up and forward on both sides; arms drawn in, hands forward and up."""

import numpy as np
import pytest

from behaviours.rules.recoil import raise_clavicle, retract_arm
from behaviours.settings import Recoil
from engine.body.kinematics import joints_of
from engine.body.skeleton import SHOULDERS, WRISTS, Pose
from tests.behaviours.people import BODY, standing


def moved_by(rule, amount):
    pose = standing()
    rotations = pose.rotations.copy()
    for side in range(2):
        rule(rotations, side, amount, Recoil())
    return joints_of(BODY, Pose(pose.root_m, rotations))[0] - joints_of(BODY, pose)[0]


def test_both_shoulders_rise_and_come_forward():
    moved = moved_by(raise_clavicle, 1.0)[list(SHOULDERS)]
    assert np.all(moved[:, 2] > 0.05)
    assert np.all(moved[:, 0] > 0.01)


def test_both_sides_alike():
    moved = moved_by(raise_clavicle, 0.6)
    left, right = moved[list(SHOULDERS)]
    assert left == pytest.approx(right * [1, -1, 1], abs=1e-12)


def test_the_control_scales_it():
    rise = [moved_by(raise_clavicle, c)[SHOULDERS[0], 2] for c in (0.0, 0.5, 1.0)]
    assert rise[0] == 0.0
    assert 0.0 < rise[1] < rise[2]


def test_retracted_arms_bring_the_hands_forward_and_up():
    hands = moved_by(retract_arm, 1.0)[list(WRISTS)]
    assert np.all(hands[:, 0] > 0.05)
    assert np.all(hands[:, 2] > 0.3)
