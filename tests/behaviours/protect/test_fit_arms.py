"""Both arms fitted in: inside their limits, out of the body and of each other, no farther from the rules than needed.

What is inside what is told by `engine.body.overlap`, which knows nothing of the fit.
"""

import math

import numpy as np
import pytest

from behaviours.protect.exact_feet import EXACT, stand_exactly
from behaviours.protect.fit_arms import fit_arms
from behaviours.protect.guard import across_arm, put_palm, turned_about
from behaviours.protect.prepare import aim_point, prepare
from behaviours.protect.task import AtPerception, new_posed
from behaviours.rules.block import fingers_from_up
from behaviours.rules.controls import controls_from_threat
from behaviours.settings import Block, Settings
from engine.body.kinematics import joints_of
from engine.body.limits import excess_rad
from engine.body.overlap import overlaps_m
from engine.body.skeleton import CLAVICLES, ELBOWS, MIRRORED, SHOULDERS, WRISTS, Pose
from engine.clips.mirror import FLIP_ROTATION
from engine.maths import quaternion
from tests.behaviours.people import BODY, BOTH, coming, standing

ARMS = [joint for joints in (CLAVICLES, SHOULDERS, ELBOWS, WRISTS) for joint in joints]


def task_for(azimuth, size=0.5, speed=0.5, target="head", weights=(1.0, 0.0), elevation=5.0):
    threat = coming(azimuth, elevation, size=size, speed=speed, target=target, weights=weights)
    at = AtPerception(standing(), standing(), BOTH)
    threat = threat._replace(line_point_m=aim_point(prepare(BODY, at, threat, Settings())))
    return prepare(BODY, at, threat, Settings()), controls_from_threat(speed, size)


def fitted(task, controls):
    posed = new_posed()
    stand_exactly(task, np.zeros(3), controls, posed, 1e-4)
    trouble = fit_arms(task, controls, posed)
    return posed, trouble


@pytest.mark.parametrize(("target", "weights"), [("head", (1, 0)), ("torso", (0.5, 0.5)), ("pelvis", (0, 1))])
@pytest.mark.parametrize("azimuth", [0, 40, 75, 95, 120, 180, -60, -90, -150])
@pytest.mark.parametrize("size", [0.0, 1.0])
def test_nothing_is_inside_anything_and_no_joint_beyond_its_limits(target, weights, azimuth, size):
    posed, _ = fitted(*task_for(azimuth, size, target=target, weights=tuple(map(float, weights))))
    pose = Pose(posed.positions[0], posed.rotations)
    assert overlaps_m(BODY, Pose(pose.root_m[None], pose.rotations[None])).max() < 5e-3
    assert excess_rad(BODY, pose.rotations)[ARMS].max() < 1e-9
    positions, orientations = joints_of(BODY, pose)
    assert posed.positions == pytest.approx(positions, abs=1e-9)
    for side in range(2):
        palm = positions[WRISTS[side]] + quaternion.rotate(orientations[WRISTS[side]], BODY.palm_m[side])
        assert posed.palms[side] == pytest.approx(palm, abs=1e-9)


def test_an_arm_that_nothing_hinders_stays_where_the_rules_want_it():
    task, controls = task_for(10, 0.3)
    wanted = new_posed()
    stand_exactly(task, np.zeros(3), controls, wanted, 1e-4)
    posed, trouble = fitted(task, controls)
    assert trouble < 3.0
    assert np.linalg.norm(posed.palms - wanted.palms, axis=1).max() < 0.03


def test_the_mirrored_arms_are_the_arms_mirrored():
    left, right = (fitted(*task_for(azimuth, 0.5)) for azimuth in (35, -35))
    assert right[1] == pytest.approx(left[1], rel=1e-3)
    there = right[0].rotations[MIRRORED] * FLIP_ROTATION
    turns = [quaternion.angle_between(tuple(a), tuple(b)) for a, b in zip(left[0].rotations, there, strict=True)]
    assert max(turns) < 0.02


def test_palms_are_put_where_they_are_wanted():
    task, controls = task_for(0)
    posed = new_posed()
    stand_exactly(task, np.zeros(3), controls, posed, EXACT + 1e-4)
    goal, hand = tuple(posed.positions[SHOULDERS[0]] + [0.35, 0.05, -0.05]), (math.sqrt(0.5), 0.0, -math.sqrt(0.5), 0.0)
    palm = put_palm(
        0, goal, hand, (0.0, 0.3, -1.0), 0.2, task.build.palm_m[0], task.build.elbow_rad[0], task.bones.offset_m,
        posed.rotations, posed.positions, posed.orientations,
    )  # fmt: skip
    assert palm == pytest.approx(goal, abs=1e-9)
    positions, orientations = joints_of(BODY, Pose(posed.positions[0], posed.rotations))
    assert positions[WRISTS[0]] == pytest.approx(posed.positions[WRISTS[0]], abs=1e-9)
    assert quaternion.angle_between(tuple(orientations[WRISTS[0]]), hand) < 1e-6


def test_an_elbow_points_as_nearly_as_it_can_where_it_is_wanted():
    n = (0.6, 0.0, 0.8)
    across = np.array(across_arm(n, (0.0, 0.3, -1.0)))
    assert across @ n == pytest.approx(0.0, abs=1e-12)
    around = [np.array(turned_about(n, tuple(across), a)) for a in np.linspace(0, 2 * math.pi, 73)[:-1]]
    assert max(range(72), key=lambda k: around[k] @ [0.0, 0.3, -1.0]) == 0


def test_fingers_point_up_before_the_face_and_down_before_the_hips():
    up, block = (0.0, 0.0, 1.0), Block()
    turns = [
        fingers_from_up((math.sqrt(1 - z * z), 0.0, z), up, block) for z in (0.9, 0.0, -0.3, -0.5, -0.7, -0.85, -1.0)
    ]
    assert turns[:3] == [0.0, 0.0, 0.0]
    assert turns[-2:] == pytest.approx([block.fingers_down_rad] * 2)
    assert np.all(np.diff(turns) >= 0.0)


def test_a_wrist_before_the_hips_is_not_bent_hard():
    for azimuth in (0, 20, -20):
        posed, _ = fitted(*task_for(azimuth, 0.3, target="pelvis", weights=(0.0, 1.0)))
        for side in range(2):
            bent = quaternion.angle_between(tuple(posed.rotations[WRISTS[side]]), (1.0, 0.0, 0.0, 0.0))
            assert math.degrees(bent) < 70.0
