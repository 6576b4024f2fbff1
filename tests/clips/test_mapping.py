"""What comes out on the canonical skeleton for a figure whose pose is known, whatever convention it was written in."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.kinematics import joints_of
from engine.body.skeleton import (
    ANKLES,
    BACK,
    ELBOWS,
    HIPS,
    JOINTS,
    KNEES,
    LEFT_ELBOW,
    LEFT_KNEE,
    LEFT_WRIST,
    NECK,
    PELVIS,
    RIGHT_ELBOW,
    RIGHT_KNEE,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
)
from engine.clips.importing import import_clip
from engine.clips.rig import part_of
from engine.core.errors import BadInput
from engine.maths import rotations
from tests.clips.people import ARMS_HANG, T_POSE, swing_arms, write_person

STILL = [ARMS_HANG] * 30
LIMBS = [*SHOULDERS, *ELBOWS, *WRISTS, *HIPS, *KNEES, *ANKLES, *TOES]


def turned_by_deg(clip, joint):
    """How far (F,) a joint is turned from its identity."""
    return np.degrees(rotations.angle_between(np.array([1.0, 0, 0, 0]), clip.pose.rotations[:, joint]))


def test_hanging_arms_and_straight_legs_are_the_identity(tmp_path):
    clip = import_clip(write_person(tmp_path / "still.bvh", STILL))
    for joint in range(len(JOINTS)):
        assert turned_by_deg(clip, joint).max() < 1e-3, JOINTS[joint]


def test_limbs_keep_the_subjects_own_lengths_and_hang_along_z(tmp_path):
    clip = import_clip(write_person(tmp_path / "still.bvh", STILL))
    for joints, length in ((ELBOWS, 0.28), (WRISTS, 0.26), (KNEES, 0.42), (ANKLES, 0.41)):
        np.testing.assert_allclose(clip.body.offset_m[list(joints)], [[0, 0, -length]] * 2, atol=1e-6)
    np.testing.assert_allclose(clip.body.offset_m[SHOULDERS[0]], [0.0, 0.15, 0.0], atol=1e-6)
    np.testing.assert_allclose(clip.body.offset_m[TOES[1]], [0.13, 0.0, -0.05], atol=1e-6)


def test_elbows_bend_about_minus_y_and_knees_about_y(tmp_path):
    bent = {
        **ARMS_HANG,
        "LeftForeArm": (0, -70, 0),
        "RightForeArm": (0, 50, 0),
        "LeftLeg": (0, 0, 60),
        "RightLeg": (0, 0, 30),
    }
    clip = import_clip(write_person(tmp_path / "bent.bvh", [bent] * 30))
    for joint, degrees in ((LEFT_ELBOW, -70), (RIGHT_ELBOW, -50), (LEFT_KNEE, 60), (RIGHT_KNEE, 30)):
        vector = np.degrees(rotations.to_rotation_vector(clip.pose.rotations[0, joint]))
        np.testing.assert_allclose(vector, [0.0, degrees, 0.0], atol=1e-3)


def test_a_hinge_that_is_off_in_the_file_is_put_right_without_moving_a_joint(tmp_path):
    """The same bends about an axis 25 degrees off the elbow's: the upper arm turns about itself to make up for it."""
    off = []
    for pose in swing_arms(60):
        arm = {"LeftArm": (-90.0, 0.0, 25.0), "RightArm": (90.0, 0.0, -10.0)}
        off.append({**pose, **arm})
    clip = import_clip(write_person(tmp_path / "off.bvh", off))
    swing = rotations.rotate(clip.pose.rotations[:, [LEFT_ELBOW, RIGHT_ELBOW]], np.array([0.0, 0.0, -1.0]))
    np.testing.assert_allclose(swing[..., 1], 0.0, atol=1e-6)
    assert swing[..., 0].min() > 0.1
    assert clip.report.position_error_m < 1e-6


@pytest.mark.parametrize(
    ("unit", "z_up"),
    [(1.0, True), (100.0, False), (100.0, True), (1000.0, False), (39.3701, False), (0.45 / 0.0254, False)],
)
def test_unit_and_up_axis_make_no_difference(tmp_path, unit, z_up):
    poses, roots = swing_arms(40), np.cumsum(np.full((40, 3), [0.002, 0.0, 0.01]), axis=0) + [0.3, 0.94, 0.2]
    plain = import_clip(write_person(tmp_path / "plain.bvh", poses, roots=roots))
    other = import_clip(write_person(tmp_path / "other.bvh", poses, roots=roots, unit=unit, z_up=z_up))
    np.testing.assert_allclose(joints_of(other.body, other.pose)[0], joints_of(plain.body, plain.pose)[0], atol=1e-4)
    assert other.report.scale_to_m == pytest.approx(1.0 / unit, rel=1e-4)
    assert (other.report.up_axis, plain.report.up_axis) == ("+Z" if z_up else "+Y", "+Y")


def test_a_unit_that_makes_no_human_is_scaled_and_said(tmp_path):
    clip = import_clip(write_person(tmp_path / "game.bvh", STILL, unit=5.5))
    assert clip.report.leg_length_m == pytest.approx(0.83)
    assert "no known unit" in clip.report.notes[0]


def test_it_starts_over_the_origin_facing_ahead_on_the_floor_wherever_the_file_stood(tmp_path):
    turned = [{**pose, "Hips": (0.0, 130.0, 0.0)} for pose in swing_arms(30)]
    roots = np.tile([3.0, 1.44, -2.0], (30, 1))
    clip = import_clip(write_person(tmp_path / "elsewhere.bvh", turned, roots=roots))
    plain = import_clip(write_person(tmp_path / "plain.bvh", swing_arms(30)))
    np.testing.assert_allclose(joints_of(clip.body, clip.pose)[0], joints_of(plain.body, plain.pose)[0], atol=1e-5)
    assert clip.report.floor_m - plain.report.floor_m == pytest.approx(0.5, abs=1e-5)
    assert abs(clip.report.facing_deg - plain.report.facing_deg) == pytest.approx(130.0, abs=1e-4)
    np.testing.assert_allclose(clip.pose.root_m[0, :2], 0.0, atol=1e-12)


def test_colons_and_other_namings_are_the_same_person(tmp_path):
    plain = import_clip(write_person(tmp_path / "plain.bvh", swing_arms(20)))
    other = import_clip(write_person(tmp_path / "other.bvh", swing_arms(20), prefix="mixamorig:"))
    np.testing.assert_array_equal(other.pose.rotations, plain.pose.rotations)


@pytest.mark.parametrize(
    ("name", "part"),
    [
        ("mixamorig:LeftUpLeg", (0, "upleg")),
        ("lShin", (0, "shin")),
        ("rradius", (1, "radius")),
        ("left_lower_arm", (0, "lowerarm")),
        ("LeftLowerArm", (0, "lowerarm")),
        ("shin.R", (1, "shin")),
        ("calf_l", (0, "calf")),
        ("RightToeBase", (1, "toebase")),
        ("LeftHand2", (0, "hand")),
        ("lowerback", (None, "lowerback")),
        ("Spine1", (None, "spine")),
        ("Reference", (None, "reference")),
    ],
)
def test_sides_and_parts_are_told_from_names(name, part):
    assert part_of(name) == part


def without(*names):
    return [joint for joint in T_POSE if joint[0] not in names]


def test_missing_joints_are_filled_in_and_named(tmp_path):
    joints = without("LeftToeBase", "RightToeBase", "LeftHand", "RightHand", "Head", "Neck")
    clip = import_clip(write_person(tmp_path / "few.bvh", swing_arms(20), joints=joints))
    assert clip.report.missing_joints == ["neck", "head", "left_wrist", "right_wrist", "left_toe", "right_toe"]
    positions, _ = joints_of(clip.body, clip.pose)
    assert np.isfinite(positions).all()
    assert 0.2 < np.linalg.norm(clip.body.offset_m[LEFT_WRIST]) < 0.3
    assert clip.body.offset_m[TOES[0], 0] > 0.08
    assert positions[0, NECK, 2] == pytest.approx(positions[0, SHOULDERS[0], 2], abs=0.01)


def test_one_spine_joint_leaves_the_waist_half_way_and_the_chest_where_it_was(tmp_path):
    joints = [
        (name, "Hips" if parent == "Spine" else parent, (0.0, 0.28, 0.0) if name == "Spine1" else offset)
        for name, parent, offset in without("Spine")
    ]
    poses = [{**pose, "Spine1": (8.0, 0.0, 20.0)} for pose in swing_arms(20)]
    clip = import_clip(write_person(tmp_path / "one.bvh", poses, joints=joints))
    assert clip.report.missing_joints == ["waist"]
    np.testing.assert_allclose(clip.body.offset_m[[WAIST, BACK]], [[0, 0, 0.14]] * 2, atol=1e-6)
    assert turned_by_deg(clip, WAIST).max() < 1e-4
    assert clip.report.position_error_m < 1e-6


def test_several_spine_joints_make_one_and_the_chest_turns_as_it_did(tmp_path):
    joints = [*without("Spine1"), ("Spine1", "Extra", (0.0, 0.09, 0.0)), ("Extra", "Spine", (0.0, 0.09, 0.0))]
    bow = {"Spine": (0.0, 0.0, 10.0), "Extra": (0.0, 0.0, 15.0), "Spine1": (0.0, 0.0, 5.0)}
    clip = import_clip(write_person(tmp_path / "three.bvh", [{**ARMS_HANG, **bow}] * 20, joints=joints))
    _, orientations = joints_of(clip.body, clip.pose)
    vector = np.degrees(rotations.to_rotation_vector(orientations[0, BACK]))
    np.testing.assert_allclose(vector, [0.0, 30.0, 0.0], atol=1e-3)
    # the chain bends a little between its joints, so the chest lies a little nearer than one straight bone has it
    assert 0.0 < clip.report.position_error_m < 0.002


def test_what_is_no_person_is_refused_by_name(tmp_path):
    for lost, message in (
        (("LeftForeArm", "LeftHand"), "expected a left"),
        (("RightFoot", "RightToeBase"), "below RightLeg"),
    ):
        path = write_person(tmp_path / "no.bvh", STILL, joints=without(*lost))
        with pytest.raises(BadInput, match=message):
            import_clip(path)


def test_the_lost_bones_of_a_common_converter_are_put_back(tmp_path):
    dropped = []
    for name, parent, offset in T_POSE:
        above_chest = name in ("Neck", "LeftShoulder", "RightShoulder")
        dropped.append((name, parent, (0.0, 0.0, 0.0) if above_chest else offset))
    for side in ("Left", "Right"):
        dropped.append((f"{side}FingerBase", f"{side}Hand", (0.0, 0.0, 0.0)))
    clip = import_clip(write_person(tmp_path / "dropped.bvh", STILL, joints=dropped))
    np.testing.assert_allclose(clip.body.offset_m[NECK], [0.0, 0.0, 0.18], atol=1e-6)
    np.testing.assert_allclose(clip.body.offset_m[WRISTS[0]], [0.0, 0.0, -1.5 * 0.26], atol=1e-6)
    assert len(clip.report.notes) == 3


def test_every_limb_is_a_single_turn_of_its_own_frame(tmp_path):
    """Left stays left: lifting the left arm sideways is a positive turn about X of the left shoulder alone."""
    lifted = {**ARMS_HANG, "LeftArm": (-30.0, 0.0, 0.0)}
    clip = import_clip(write_person(tmp_path / "lifted.bvh", [lifted] * 20))
    vectors = np.degrees(rotations.to_rotation_vector(clip.pose.rotations[0]))
    np.testing.assert_allclose(vectors[SHOULDERS[0]], [60.0, 0.0, 0.0], atol=1e-3)
    others = [joint for joint in LIMBS if joint != SHOULDERS[0]]
    np.testing.assert_allclose(vectors[others], 0.0, atol=1e-3)
    positions, _ = joints_of(clip.body, clip.pose)
    assert positions[0, LEFT_WRIST, 1] > 0.5
    assert positions[0, PELVIS, 0] == pytest.approx(0.0)
