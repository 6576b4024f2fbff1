"""The startle pose: a fifth of a recoil, both sides alike, the head 40 % of the way to the threat, arms kept out."""

import math

import numpy as np
import pytest

from behaviours.rules.startle import arms_recoiled, recoiled, startle_pose
from behaviours.settings import Settings
from engine.body.kinematics import joints_of
from engine.body.limits import excess_beyond_rad, from_components
from engine.body.overlap import overlaps_m, pair_name
from engine.body.skeleton import CLAVICLES, ELBOWS, HEAD, MIRRORED, SHOULDERS, WRISTS, Pose
from engine.clips.mirror import FLIP_ROTATION
from engine.maths import quaternion
from tests.behaviours.people import BODY, standing

DEFAULTS = Settings()


def with_arms(shoulder, elbow):
    """Somebody who stands with both arms so: local rotations of the left one, mirrored for the right."""
    pose = standing()
    for side in range(2):
        for joint, turn in ((SHOULDERS[side], shoulder), (ELBOWS[side], elbow)):
            pose.rotations[joint] = turn if side == 0 else np.array(turn) * FLIP_ROTATION
    return pose


def depths(pose):
    return overlaps_m(BODY, Pose(pose.root_m[None], pose.rotations[None]))[0]


def test_free_arms_go_a_fifth_of_the_way_to_the_recoil():
    # hands before the body, where nothing is in the way
    pose = with_arms(quaternion.about_y(-0.6), quaternion.about_y(-0.8))
    found, full = arms_recoiled(BODY, pose, DEFAULTS), recoiled(pose.rotations, DEFAULTS)
    for joint in CLAVICLES + SHOULDERS + ELBOWS:
        whole = quaternion.angle_between(tuple(pose.rotations[joint]), tuple(full[joint]))
        gone = quaternion.angle_between(tuple(pose.rotations[joint]), tuple(found[joint]))
        assert gone == pytest.approx(0.2 * whole, rel=1e-6)


def arms(swing_x_deg, swing_y_deg, twist_deg, elbow_deg):
    return from_components(*np.radians([swing_x_deg, swing_y_deg, twist_deg])), quaternion.about_y(
        -math.radians(elbow_deg)
    )


BEFORE_THE_BELLY, BEFORE_THE_CHEST = arms(-26, -31, 115, 34), arms(-31, -36, 96, 123)


@pytest.mark.parametrize("placed", [BEFORE_THE_BELLY, BEFORE_THE_CHEST])
def test_arms_go_no_deeper_into_the_body_than_the_clip_has_them(placed):
    pose = with_arms(*placed)
    own = np.maximum(depths(pose), 0.0)
    plain = pose.rotations.copy()
    full = recoiled(pose.rotations, DEFAULTS)
    for joint in CLAVICLES + SHOULDERS + ELBOWS:
        plain[joint] = quaternion.slerp(pose.rotations[joint], full[joint], 0.2)
    deeper = depths(Pose(pose.root_m, plain)) - own
    assert deeper.max() > 2e-3, "nothing to be mended"
    found = depths(startle_pose(BODY, pose, (1.0, 0.0, 0.0), DEFAULTS)) - own
    assert found.max() <= 1e-9, pair_name(int(found.argmax()))


@pytest.mark.parametrize("placed", [BEFORE_THE_BELLY, BEFORE_THE_CHEST])
def test_both_sides_alike(placed):
    rotations = arms_recoiled(BODY, with_arms(*placed), DEFAULTS)
    there = rotations[MIRRORED] * FLIP_ROTATION
    assert [quaternion.angle_between(tuple(a), tuple(b)) for a, b in zip(rotations, there, strict=True)] == (
        pytest.approx(np.zeros(len(rotations)), abs=1e-7)
    )


@pytest.mark.parametrize("azimuth_deg", [-70, 20, 60])
def test_the_head_turns_two_fifths_of_the_way_to_the_threat(azimuth_deg):
    toward = (math.cos(math.radians(azimuth_deg)), math.sin(math.radians(azimuth_deg)), 0.0)
    found = startle_pose(BODY, standing(), toward, DEFAULTS)
    _, orientations = joints_of(BODY, found)
    assert math.degrees(quaternion.heading(orientations[HEAD])) == pytest.approx(0.4 * azimuth_deg, abs=1e-6)


def test_no_joint_leaves_its_limits_and_the_root_stays():
    pose = with_arms(quaternion.about_y(-2.9), quaternion.about_y(-2.7))
    found = startle_pose(BODY, pose, (-1.0, 0.3, 0.0), DEFAULTS)
    assert excess_beyond_rad(BODY, found.rotations, pose.rotations).max() < 1e-9
    assert found.root_m == pytest.approx(pose.root_m)
    assert found.rotations[list(WRISTS)] == pytest.approx(pose.rotations[list(WRISTS)])
