"""One trial in both formats is one motion: the strongest check there is of two independent readers and of the
mapping."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.kinematics import joints_of
from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    ELBOWS,
    HEAD,
    HIPS,
    JOINTS,
    KNEES,
    NECK,
    PELVIS,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
)
from engine.clips.importing import import_clip
from engine.maths import rotations

LEGS = [PELVIS, WAIST, BACK, *HIPS, *KNEES, *ANKLES, *TOES]
UPPER = [WAIST, BACK, NECK, HEAD, *CLAVICLES, *SHOULDERS, *ELBOWS, *WRISTS]


@pytest.fixture(scope="module", params=["01_01", "02_01", "07_04"])
def pair(request, shared_mocap):
    amc = import_clip(shared_mocap / "asfamc" / f"{request.param}.amc")
    return amc, import_clip(shared_mocap / "bvh" / f"{request.param}.bvh")


def test_the_added_t_pose_is_dropped(pair):
    amc, bvh = pair
    assert (amc.report.rest_frames_dropped, bvh.report.rest_frames_dropped) == (0, 1)
    assert amc.frames == bvh.frames


def test_the_legs_agree_within_a_tenth_of_a_millimetre(pair):
    places = [joints_of(clip.body, clip.pose)[0][:, LEGS] for clip in pair]
    apart_m = np.linalg.norm(places[0] - places[1], axis=-1)
    assert apart_m.max() < 1e-4, JOINTS[LEGS[int(apart_m.max(axis=0).argmax())]]


def test_the_upper_body_is_turned_alike_within_a_tenth_of_a_degree(pair):
    turned = [joints_of(clip.body, clip.pose)[1][:, UPPER] for clip in pair]
    apart_deg = np.degrees(rotations.angle_between(*turned))
    assert apart_deg.max() < 0.1, JOINTS[UPPER[int(apart_deg.max(axis=0).argmax())]]


def test_the_lost_thorax_and_forearm_are_put_back_to_a_centimetre(pair):
    places = [joints_of(clip.body, clip.pose)[0] for clip in pair]
    assert np.linalg.norm(places[0] - places[1], axis=-1).max() < 0.01


def test_the_feet_stand_in_the_same_frames(pair):
    assert (pair[0].planted != pair[1].planted).mean() < 0.001


def test_elbows_and_knees_are_hinges_about_their_own_y(pair):
    for clip in pair:
        bones = rotations.rotate(clip.pose.rotations[:, [*ELBOWS, *KNEES]], np.array([0.0, 0.0, -1.0]))
        assert np.abs(bones[..., 1]).max() < 1e-4
        assert bones[:, :2, 0].min() > -0.05  # elbows forwards
        assert bones[:, 2:, 0].max() < 0.05  # knees backwards


def test_the_retargeted_copies_move_alike(shared_mocap):
    """The Daz copies are other bodies, in centimetres and without toes: directions of limbs agree to about ten
    degrees."""
    for name, limit_deg in (("11_01", 12.0), ("135_04", 12.0)):
        amc = import_clip(shared_mocap / "asfamc" / f"{name}.amc")
        daz = import_clip(shared_mocap / "bvh" / f"{name}_daz.bvh")
        assert daz.report.rest_frames_dropped == 4
        assert daz.report.missing_joints == ["left_toe", "right_toe"]
        directions = []
        for clip, first in ((amc, 3), (daz, 0)):
            places = joints_of(clip.body, clip.pose)[0][first:]
            bones = [
                places[:, b] - places[:, a]
                for a, b in zip([*HIPS, *KNEES, *SHOULDERS], [*KNEES, *ANKLES, *ELBOWS], strict=True)
            ]
            directions.append(np.stack([bone / np.linalg.norm(bone, axis=-1, keepdims=True) for bone in bones], axis=1))
        frames = min(len(d) for d in directions)
        inner = np.sum(directions[0][:frames] * directions[1][:frames], axis=-1)
        assert np.degrees(np.arccos(np.clip(inner, -1, 1))).mean() < limit_deg
