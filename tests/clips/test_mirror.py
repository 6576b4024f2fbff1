"""In the mirror left is right, and nothing else has changed."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import ANKLES, MIRRORED, Pose
from engine.body.support import sole_points
from engine.clips.importing import import_clip
from engine.clips.mirror import mirror_clip
from engine.clips.playback import sample
from engine.clips.synthetic import sway
from tests.clips.people import T_POSE, swing_arms, write_person

FLIP = np.array([1.0, -1.0, 1.0])


@pytest.fixture(scope="module")
def lopsided(tmp_path_factory):
    """Someone with a longer left arm, moving differently on each side."""
    joints = [(n, p, (0.31, 0.0, 0.0) if n == "LeftForeArm" else o) for n, p, o in T_POSE]
    path = write_person(tmp_path_factory.mktemp("m") / "lopsided.bvh", swing_arms(40), joints=joints)
    return import_clip(path)


def test_every_joint_sole_and_the_centre_of_mass_are_mirrored(lopsided):
    mirrored = mirror_clip(lopsided)
    places, turned = joints_of(lopsided.body, lopsided.pose)
    other_places, other_turned = joints_of(mirrored.body, mirrored.pose)
    np.testing.assert_allclose(other_places, places[:, MIRRORED] * FLIP, atol=1e-12)
    np.testing.assert_allclose(
        com_of(mirrored.body, mirrored.pose), com_of(lopsided.body, lopsided.pose) * FLIP, atol=1e-9
    )
    soles = sole_points(lopsided.body, places[3], turned[3])
    np.testing.assert_allclose(
        sole_points(mirrored.body, other_places[3], other_turned[3]), soles[::-1] * FLIP, atol=1e-12
    )


def test_a_mirror_in_a_mirror_is_the_clip(lopsided):
    twice = mirror_clip(mirror_clip(lopsided))
    np.testing.assert_array_equal(twice.pose.rotations, lopsided.pose.rotations)
    for name, value in lopsided.body._asdict().items():
        np.testing.assert_allclose(getattr(twice.body, name), value, atol=1e-15, err_msg=name)
    np.testing.assert_array_equal(twice.planted, lopsided.planted)


def test_parts_stay_in_the_order_of_their_joints(lopsided):
    body = mirror_clip(lopsided).body
    np.testing.assert_array_equal(body.part_joint, lopsided.body.part_joint)
    assert body.part_mass_kg.sum() == pytest.approx(lopsided.body.part_mass_kg.sum())
    assert (body.limit_low_rad <= body.limit_high_rad).all()


def test_its_loop_walks_on_to_the_other_side(library_clip):
    walk = library_clip("walk")
    mirrored = mirror_clip(walk)
    assert mirrored.key != walk.key
    for time_s in (0.7, 2.3, 9.1):
        pose = sample(walk, time_s)
        expected = Pose(pose.root_m * FLIP, pose.rotations)
        np.testing.assert_allclose(sample(mirrored, time_s).root_m, expected.root_m, atol=1e-12)
    planted = [list(ANKLES)[side] for side in np.flatnonzero(walk.planted[10])]
    assert [MIRRORED[ankle] for ankle in planted][::-1] == [
        list(ANKLES)[s] for s in np.flatnonzero(mirrored.planted[10])
    ]


def test_the_embedded_clip_mirrored_still_stands():
    clip = mirror_clip(sway())
    soles = sole_points(clip.body, *joints_of(clip.body, sample(clip, 2.0)))
    np.testing.assert_allclose(soles[..., 2], 0.0, atol=1e-6)
