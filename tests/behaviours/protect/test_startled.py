"""A startle pose that can be stood in: as much of the reflex as legs and arms allow."""

from __future__ import annotations

import numpy as np

from behaviours.protect.startled import SHARES, within_reach
from engine.body.limits import excess_rad
from engine.body.overlap import overlaps_m
from engine.body.skeleton import HIPS, Pose
from engine.maths import quaternion
from tests.behaviours.people import BODY
from tests.behaviours.two_poses import at_ease, between, held, on_guard, with_arm


def stand(pose: Pose) -> Pose:
    """On the feet of somebody who stands at ease."""
    return between(pose, pose, 0.0, goals=held(at_ease()))


def moved(pose: Pose, metres) -> Pose:
    return Pose(pose.root_m + metres, pose.rotations.copy())


def deep_m(pose: Pose) -> float:
    return float(overlaps_m(BODY, Pose(pose.root_m[np.newaxis], pose.rotations[np.newaxis])).max())


def test_a_reflex_that_is_within_reach_is_left_as_it_is():
    startled = moved(on_guard(), [0.03, 0.0, -0.02])
    found = within_reach(BODY, at_ease(), at_ease(), startled, stand)
    np.testing.assert_allclose(found.root_m, startled.root_m, atol=1e-9)
    np.testing.assert_allclose(found.rotations[: HIPS[0]], startled.rotations[: HIPS[0]], atol=1e-9)


def test_the_pelvis_goes_only_as_far_as_the_hips_let_it():
    startled = moved(at_ease(), [0.7, 0.0, 0.0])
    assert excess_rad(BODY, stand(startled).rotations).max() > 0.1  # what it is there for
    found = within_reach(BODY, at_ease(), startled, startled, stand)
    assert excess_rad(BODY, found.rotations).max() < 0.006
    assert 0.0 < found.root_m[0] - at_ease().root_m[0] < 0.7


def test_the_pelvis_turns_only_as_far_as_standing_feet_let_it():
    """Somebody who turns fast has a pelvis, a moment ahead, that the feet do not yet go with."""
    startled = at_ease()
    startled.rotations[0] = quaternion.about_z(np.radians(100.0))
    assert excess_rad(BODY, stand(startled).rotations).max() > 0.1  # what it is there for
    found = within_reach(BODY, at_ease(), startled, startled, stand)
    assert excess_rad(BODY, found.rotations).max() < 0.006
    assert 0.0 < quaternion.heading(found.rotations[0]) < np.radians(99.0)


def test_arms_recoil_only_so_far_as_is_free():
    startled = with_arm(at_ease(), 0, (-5.0, 10.0, 0.0), 10.0)
    assert deep_m(startled) > 0.02
    found = within_reach(BODY, at_ease(), at_ease(), startled, lambda pose: pose)
    assert deep_m(found) < 0.003
    gone, wanted = (np.abs(pose.rotations - at_ease().rotations).max() for pose in (found, startled))
    assert min(SHARES[SHARES > 0.0]) * 0.9 < gone / wanted < 1.0
