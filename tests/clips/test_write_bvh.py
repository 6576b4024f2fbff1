"""Written BVH files say what the motion was: to our reader, to another's, and through any angle."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from engine.body.anthropometry import standard_body
from engine.body.kinematics import joints_of
from engine.body.skeleton import JOINT_COUNT, JOINTS, Pose
from engine.clips.bvh import read_bvh
from engine.clips.importing import import_clip
from engine.clips.tracks import world_of
from engine.clips.write_bvh import bvh_text, euler_zxy
from engine.maths import rotations

BODY = standard_body()


def wild(frames=40, seed=3):
    """Every joint anyhow, the root going about."""
    rng = np.random.default_rng(seed)
    turns = rotations.from_rotation_vector(rng.normal(scale=1.2, size=(frames, JOINT_COUNT, 3)))
    return Pose(rng.normal(scale=3.0, size=(frames, 3)), turns)


def in_file_axes(positions_m):
    """X left, Y up, Z ahead, centimetres; spelt out, not by the writer's own function."""
    ahead, left, up = np.moveaxis(positions_m, -1, 0)
    return 100.0 * np.stack([left, up, ahead], axis=-1)


def test_every_joint_is_read_where_it_was(tmp_path):
    pose = wild()
    (tmp_path / "a.bvh").write_text(bvh_text(BODY, pose, 120.0))
    tracks = read_bvh(tmp_path / "a.bvh")
    assert tracks.fps == pytest.approx(120.0, abs=1e-6)
    apart_cm = world_of(tracks)[0] - in_file_axes(joints_of(BODY, pose)[0])
    assert np.abs(apart_cm).max() < 1e-3  # a hundredth of a millimetre


def test_another_reader_sees_the_same(tmp_path):
    pybvh = pytest.importorskip("pybvh")
    pose = wild(frames=12)
    (tmp_path / "a.bvh").write_text(bvh_text(BODY, pose, 60.0))
    found = pybvh.read_bvh_file(tmp_path / "a.bvh")
    wanted = in_file_axes(joints_of(BODY, pose)[0])
    assert [node.name for node in found.nodes if not node.name.startswith("EndSite")] == list(JOINTS)
    assert np.abs(np.asarray(found.joint_positions()) - wanted).max() < 1e-2


def test_a_clip_that_went_out_comes_in_again(tmp_path, library_clip):
    """Through the whole import, which finds the same floor, facing and bones once more."""
    clip = library_clip("sway")
    (tmp_path / "sway.bvh").write_text(bvh_text(clip.body, clip.pose, clip.fps))
    again = import_clip(tmp_path / "sway.bvh")
    apart_m = joints_of(again.body, again.pose)[0] - joints_of(clip.body, clip.pose)[0]
    assert np.abs(apart_m).max() < 1e-4
    assert again.report.scale_to_m == 0.01
    assert again.report.up_axis == "+Y"


def test_angles_are_those_of_another_library():
    turns = wild(frames=5).rotations
    angles = euler_zxy(turns)
    oracle = Rotation.from_euler("ZXY", angles.reshape(-1, 3)).as_quat()[:, [3, 0, 1, 2]]
    assert rotations.angle_between(oracle, turns.reshape(-1, 4)).max() < 1e-7


def test_angles_never_jump_where_the_motion_does_not():
    """A joint that turns through the pole of its angles and on round more than once."""
    turn = np.linspace(0.0, 5.0 * np.pi, 401)
    assert np.isclose(turn, 0.5 * np.pi, rtol=0.0, atol=1e-12).any()  # the pole itself is among them
    about_x = rotations.from_rotation_vector(turn[:, None] * np.array([1.0, 0.0, 0.0]))
    quaternions = rotations.multiply(rotations.about_z(0.3), about_x)
    angles = euler_zxy(quaternions[:, None])[:, 0]
    assert np.abs(np.diff(angles, axis=0)).max() < 0.05
    again = rotations.from_euler("ZXY", angles)
    assert rotations.angle_between(again, quaternions).max() < 1e-7


def test_the_same_motion_gives_the_same_text():
    pose = wild(frames=3)
    assert bvh_text(BODY, pose, 30.0) == bvh_text(BODY, Pose(pose.root_m.copy(), -pose.rotations), 30.0)
