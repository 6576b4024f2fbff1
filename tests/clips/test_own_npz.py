"""Our own archives: what was written is read, under the names that its table promises; broken ones are named."""

from __future__ import annotations

import re

import numpy as np
import pytest

from engine.body.kinematics import com_of, joints_of
from engine.clips import own_npz
from engine.clips.importing import import_clip
from engine.clips.npz import read_npz
from engine.clips.own_npz import AMASS_JOINTS, motion_arrays, npz_bytes
from engine.clips.tracks import world_of
from engine.core.errors import BadInput
from engine.maths import rotations


@pytest.fixture
def clip(library_clip):
    return library_clip("sway")


@pytest.fixture
def arrays(clip):
    return motion_arrays(clip.body, clip.pose, clip.fps, "female")


def test_every_joint_is_read_where_it_was(tmp_path, clip, arrays):
    (tmp_path / "a.npz").write_bytes(npz_bytes(arrays))
    tracks = read_npz(tmp_path / "a.npz")
    assert (tracks.fps, tracks.scale_to_m) == (clip.fps, 1.0)
    assert np.abs(world_of(tracks)[0] - joints_of(clip.body, clip.pose)[0]).max() < 1e-12


def test_it_can_be_played_again(tmp_path, clip, arrays):
    (tmp_path / "a.npz").write_bytes(npz_bytes(arrays))
    again = import_clip(tmp_path / "a.npz")
    apart_m = joints_of(again.body, again.pose)[0] - joints_of(clip.body, clip.pose)[0]
    assert np.abs(apart_m).max() < 1e-4


def test_every_array_stands_in_the_table(arrays):
    documented = set(re.findall(r"`(\w+)`", own_npz.__doc__))
    assert arrays.keys() <= documented


def test_masses_and_world_frames_belong_together(clip, arrays):
    """The COM worked out by hand from the archive is the body's."""
    rows = arrays["part_joint"]
    centres = arrays["joints_m"][:, rows] + rotations.rotate(arrays["orientations_wxyz"][:, rows], arrays["part_com_m"])
    mass = arrays["part_mass_kg"]
    com = (centres * mass[:, None]).sum(axis=1) / mass.sum()
    assert np.abs(com - com_of(clip.body, clip.pose)).max() < 1e-12


def test_amass_joints_are_where_their_names_say(arrays):
    names, joints = list(arrays["amass_joint_names"]), arrays["amass_joints_m"]
    assert names == list(AMASS_JOINTS)
    assert len(names) == 22
    ours = {name: arrays["joints_m"][:, row] for row, name in enumerate(arrays["joint_names"])}
    assert np.array_equal(joints[:, names.index("left_foot")], ours["left_toe"])
    assert np.array_equal(joints[:, names.index("right_collar")], ours["right_clavicle"])
    heights = joints[0, :, 2]
    assert heights[0] < heights[3] < heights[6] < heights[9] < heights[12] < heights[15]  # up the spine to the head


def test_the_same_motion_gives_the_same_bytes(arrays):
    assert npz_bytes(arrays) == npz_bytes({name: array.copy() for name, array in arrays.items()})


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        ({"schema": np.array("brace-motion 9")}, "schema 'brace-motion 9'"),
        ({"root_m": np.zeros((0, 3))}, "root_m of shape (0, 3)"),
        ({"rotations_wxyz": np.zeros((2, 21, 4))}, "rotations_wxyz of shape (2, 21, 4)"),
        ({"offsets_m": np.full((21, 3), np.nan)}, "offsets_m with values that are not finite"),
        ({"mocap_framerate": np.array(0.0)}, "mocap_framerate 0"),
        ({"mocap_framerate": np.array(True)}, "mocap_framerate of shape ()"),
        ({"toe_tip_m": None}, "no array 'toe_tip_m'"),
    ],
)
def test_a_broken_archive_is_named(tmp_path, arrays, spoil, said):
    changed = {name: array for name, array in {**arrays, **spoil}.items() if array is not None}
    (tmp_path / "a.npz").write_bytes(npz_bytes(changed))
    with pytest.raises(BadInput) as trouble:
        read_npz(tmp_path / "a.npz")
    assert said in trouble.value.line()


def test_quaternions_that_are_none_are_refused(tmp_path, arrays):
    (tmp_path / "a.npz").write_bytes(npz_bytes(arrays | {"rotations_wxyz": 1.1 * arrays["rotations_wxyz"]}))
    with pytest.raises(BadInput, match="length is off"):
        read_npz(tmp_path / "a.npz")
