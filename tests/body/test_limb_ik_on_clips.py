"""Limb IK on motion capture: real elbows are no perfect hinges, real knees lock, real arms hang straight down."""

import math

import numpy as np
import pytest

from engine.body import kinematics, limb_ik
from engine.body.skeleton import ANKLES, WRISTS
from engine.clips.importing import import_clip

CLIPS = ["asfamc/02_01.amc", "asfamc/02_03.amc", "asfamc/135_04.amc", "bvh/13_26.bvh"]  # walk, run, kick, wave


@pytest.fixture(params=CLIPS, scope="module")
def clip(request, shared_mocap):
    return import_clip(shared_mocap / request.param)


def test_every_frame_that_is_asked_for_nothing_stays_as_it_is(clip):
    positions, orientations = kinematics.joints_of(clip.body, clip.pose)
    for k in range(0, clip.frames, 5):
        r, p, o = clip.pose.rotations[k].copy(), positions[k].copy(), orientations[k].copy()
        for side in range(2):
            arm, leg = limb_ik.arm_swivel(p, o, side), limb_ik.leg_swivel(p, o, side)
            wrist, ankle, foot = p[WRISTS[side]].copy(), p[ANKLES[side]].copy(), o[ANKLES[side]].copy()
            limb_ik.apply_arm(clip.body, r, p, o, side, wrist, arm)
            limb_ik.apply_leg(clip.body, r, p, o, side, ankle, foot, leg)
        np.testing.assert_allclose(p, positions[k], atol=1e-12)
        np.testing.assert_allclose(np.abs((r * clip.pose.rotations[k]).sum(1)), 1.0, atol=1e-12)


def test_carried_swivels_never_jump_between_frames(clip):
    """Walking arms pass through hanging, kicking legs through level: no reference may turn over there."""
    positions, orientations = kinematics.joints_of(clip.body, clip.pose)
    swivels = np.array([
        [swivel for side in range(2) for swivel in (
            limb_ik.arm_swivel(p, o, side, limb_ik.CARRIED), limb_ik.leg_swivel(p, o, side))]
        for p, o in zip(positions, orientations, strict=True)
    ])  # fmt: skip
    steps = np.abs(np.diff(np.unwrap(swivels, axis=0), axis=0))
    assert math.degrees(steps.max()) < 20.0 * 120.0 / clip.fps
