"""Feet before the rules: planted ones stay to the last bit, one in the air is put on the nearest ground, or left."""

import math

import numpy as np
import pytest

from behaviours.protect.prepare import prepare
from behaviours.protect.task import AtPerception
from behaviours.settings import Settings
from engine.body.footing import leg_length_m
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, HIPS, LEFT_HIP, LEFT_KNEE, Pose
from engine.body.support import sole_points
from engine.maths import quaternion
from tests.behaviours.people import BODY, BOTH, coming, met, standing

LEFT_UP = np.array([False, True])


def stepping(lift_rad: float = 0.6, knee_rad: float = 0.9) -> Pose:
    """The left foot in the air, ahead."""
    pose = standing()
    pose.rotations[LEFT_HIP] = quaternion.about_y(-lift_rad)
    pose.rotations[LEFT_KNEE] = quaternion.about_y(knee_rad)
    return pose


def moved(pose: Pose, by) -> Pose:
    return Pose(pose.root_m + np.asarray(by), pose.rotations.copy())


def ankles(pose: Pose):
    positions, orientations = joints_of(BODY, pose)
    return positions[list(ANKLES)], orientations[list(ANKLES)]


@pytest.mark.parametrize("azimuth", [-60, 15, 100])
def test_planted_feet_stay(azimuth):
    found = met(coming(azimuth, speed=0.9, size=0.9))
    for pose in (found.rules, found.sustained):
        assert ankles(pose)[0] == pytest.approx(ankles(standing())[0], abs=1e-4)
        assert ankles(pose)[1] == pytest.approx(ankles(standing())[1], abs=1e-9)
    assert np.all(found.feet.step_m == 0.0)


def test_a_foot_in_the_air_is_put_down_flat_where_it_was_going():
    now, ahead = stepping(), moved(stepping(), (0.15, 0.0, -0.02))
    found = met(coming(10), now=now, ahead=ahead, planted=LEFT_UP)
    assert found.feet.held.tolist() == [True, True]
    positions, orientations = joints_of(BODY, found.sustained)
    soles = sole_points(BODY, positions, orientations)[0]
    assert soles[:, 2] == pytest.approx(0.0, abs=1e-3)  # all six points on the floor
    assert found.feet.ankle_m[0, :2] == pytest.approx(ankles(ahead)[0][0, :2], abs=1e-6)
    assert found.feet.step_m[0] > 0.03
    assert found.feet.step_m[1] == 0.0


def test_out_of_reach_it_goes_to_the_nearest_ground():
    far = moved(stepping(1.2, 0.1), (0.1, 0.0, 0.0))
    found = met(coming(10), now=stepping(), ahead=far, planted=LEFT_UP)
    place, wanted = found.feet.ankle_m[0], ankles(far)[0][0]
    hip = joints_of(BODY, found.rules)[0][HIPS[0]]
    assert found.feet.held[0]
    assert np.linalg.norm(place - hip) <= leg_length_m(BODY, 0) + 1e-6
    assert 0.0 < place[0] - hip[0] < wanted[0] - hip[0]  # on the way there, but not so far


def test_too_high_a_hip_leaves_the_foot_in_the_air():
    jump = moved(stepping(), (0.0, 0.0, 0.4))
    task = prepare(BODY, AtPerception(jump, jump, np.array([False, True])), coming(10), Settings())
    found = met(coming(10), now=jump, ahead=jump, planted=LEFT_UP)
    # the right foot is held in the air where it is; the left cannot reach the ground
    assert task.feet.held.tolist() == [False, True]
    assert not found.feet.held[0]


def test_the_pelvis_of_the_look_ahead_is_drawn_within_the_planted_legs_reach():
    ahead = moved(standing(), (0.45, 0.0, 0.0))
    found = met(coming(10), ahead=ahead)
    hips = joints_of(BODY, found.rules)[0][list(HIPS)]
    reach = np.linalg.norm(hips - ankles(standing())[0], axis=1)
    assert np.all(reach <= [leg_length_m(BODY, side) + 1e-6 for side in range(2)])
    assert ankles(found.sustained)[0] == pytest.approx(ankles(standing())[0], abs=1e-4)


def test_the_pelvis_keeps_its_momentum_where_the_legs_allow_it():
    found = met(coming(10), ahead=moved(standing(), (0.06, 0.02, -0.01)))
    assert found.rules.root_m[:2] == pytest.approx([0.06, 0.02], abs=0.01)


def test_in_the_air_the_upper_body_alone_protects():
    jump = moved(standing(), (0.0, 0.0, 0.5))
    found = met(coming(-30), now=jump, ahead=moved(jump, (0.1, 0, 0.05)), planted=~BOTH)
    assert found.case.name == "AIRBORNE"
    assert found.solver.stop == "not needed"
    assert found.sustained.root_m == pytest.approx(jump.root_m + [0.1, 0, 0.05])
    assert len(found.support_m) == 0
    assert not found.feet.held.any()


def test_a_landing_in_time_is_where_the_feet_are_held():
    jump, landing = moved(standing(), (0.0, 0.0, 0.5)), moved(standing(), (0.4, 0.0, 0.0))
    found = met(coming(-30), now=jump, ahead=landing, planted=BOTH, landing=True)
    assert ankles(found.sustained)[0] == pytest.approx(ankles(landing)[0], abs=1e-4)
    assert found.case.name != "AIRBORNE"
    assert math.isclose(found.feet.step_m[0], np.linalg.norm([0.4, 0.5]), rel_tol=1e-6)
