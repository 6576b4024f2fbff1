"""Arms pushed out of the body: by little, smoothly, alike on both sides, and not at all where all is well."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.blends.arm_ways import BEYOND_RAD, INTERPOLATED, SWUNG
from behaviours.blends.hand_ways import APART_M
from behaviours.blends.pushed_out import LINE_APART_M, deeper_into, keep_arms_out, let_lines_be, push_arms_out
from engine.body.kinematics import joints_of
from engine.body.limits import excess_rad
from engine.body.overlap import PAIRS, overlaps_m, pair_name
from engine.body.skeleton import ELBOWS, SHOULDERS, WRISTS, Pose
from engine.clips.mirror import mirror_pose
from tests.behaviours.people import BODY
from tests.behaviours.two_poses import SHAPE, at_ease, on_guard, with_arm

HALF_LIFE_S = 0.035
APART = np.full(len(PAIRS), -APART_M)


def across(inwards_deg: float) -> Pose:
    """The left forearm before the chest, the farther inwards the deeper in it."""
    return with_arm(at_ease(), 0, (-inwards_deg, -18.0, -60.0), 80.0)


def depths_m(pose: Pose) -> np.ndarray:
    return overlaps_m(BODY, Pose(pose.root_m[None], pose.rotations[None]))[0]


def pushed(pose: Pose, allowed_m=APART) -> Pose:
    rotations = pose.rotations.copy()
    push_arms_out(BODY, SHAPE, allowed_m, pose.root_m, rotations)
    return Pose(pose.root_m, rotations)


def arms_m(pose: Pose) -> np.ndarray:
    return joints_of(BODY, pose)[0][[*ELBOWS, *WRISTS]]


@pytest.mark.parametrize("inwards_deg", [10.0, 20.0, 30.0, 40.0])
def test_an_arm_in_the_chest_comes_out_of_it(inwards_deg):
    pose = across(inwards_deg)
    assert depths_m(pose).max() > 0.01
    out = pushed(pose)
    assert depths_m(out).max() < 0.005
    moved_m = np.linalg.norm(arms_m(out) - arms_m(pose), axis=1)
    assert moved_m.max() < 3.0 * (depths_m(pose).max() + APART_M)
    assert (excess_rad(BODY, out.rotations) - excess_rad(BODY, pose.rotations)).max() < BEYOND_RAD


def test_two_forearms_that_cross_both_give_way():
    left = with_arm(at_ease(), 0, (-25.0, -66.0, -40.0), 70.0)
    crossed = with_arm(left, 1, (-25.0, -54.0, -40.0), 70.0)
    assert depths_m(crossed).max() > 0.02
    out = pushed(crossed)
    assert depths_m(out).max() < 0.005
    wrists_m = np.linalg.norm(arms_m(out) - arms_m(crossed), axis=1)[2:]
    assert wrists_m.max() < 2.0 * wrists_m.min()


def test_what_is_clear_is_left_exactly_as_it_is():
    for pose in (at_ease(), on_guard()):
        np.testing.assert_array_equal(pushed(pose, depths_m(pose)).rotations, pose.rotations)


def test_a_hand_on_its_line_is_let_come_nearer():
    allowed_m = APART.copy()
    let_lines_be(np.array([INTERPOLATED, SWUNG]), allowed_m)
    for n, allowed in enumerate(allowed_m):
        assert allowed == (-LINE_APART_M if "left" in pair_name(n) else -APART_M)


def test_a_mirrored_pose_is_pushed_to_the_mirror_image():
    pose = across(20.0)
    np.testing.assert_allclose(arms_m(pushed(mirror_pose(pose))), arms_m(mirror_pose(pushed(pose))), atol=1e-9)


def test_an_arm_taken_through_the_chest_slides_along_it_without_a_pop():
    """The second difference of where it is falls with the step, by half at least: a jump would stay, as large."""
    inwards_deg, fine = np.linspace(-15.0, 40.0, 221), []
    for step in (1, 2):
        places = np.array([arms_m(pushed(across(angle))) for angle in inwards_deg[::step]])
        fine.append(np.linalg.norm(np.diff(places, 2, axis=0), axis=2).max())
    assert fine[1] / fine[0] > 1.8
    assert fine[0] < 5e-4


def test_a_push_begins_unnoticeably():
    """Twice as deep beyond what is allowed, eight times the push: at first, nothing of it is felt in velocity."""
    pose, moved_m = across(20.0), []
    for over_m in (0.00005, 0.0001):
        allowed_m = depths_m(pose)
        allowed_m[allowed_m.argmax()] -= over_m
        moved_m.append(np.linalg.norm(arms_m(pushed(pose, allowed_m)) - arms_m(pose)))
    assert moved_m[0] < 1e-4
    assert 6.0 < moved_m[1] / moved_m[0] < 9.0


def test_a_seam_is_left_as_it_is_and_what_it_leaves_over_goes_into_no_body():
    """At the seam what was shown is shown, however deep; from there on the old motion has to come out."""
    source, shown = on_guard(), across(30.0)
    deeper_m = np.empty(len(PAIRS))
    deeper_into(BODY, SHAPE, source.rotations, shown.rotations, deeper_m)
    assert deeper_m.max() > 0.01

    def left_over(elapsed_s: float) -> Pose:
        rotations = shown.rotations.copy()
        keep_arms_out(BODY, SHAPE, source.rotations, deeper_m, elapsed_s, HALF_LIFE_S, shown.root_m, rotations)
        return Pose(shown.root_m, rotations)

    np.testing.assert_allclose(left_over(0.0).rotations, shown.rotations, atol=1e-12)
    assert depths_m(left_over(0.3)).max() < 0.005
    moved_m = [np.linalg.norm(arms_m(left_over(t)) - arms_m(shown), axis=1).max() for t in (1e-3, 2e-3)]
    assert moved_m[1] < 1e-4  # and it begins to without a jump in velocity
    turned = left_over(0.3).rotations
    others = [j for j in range(len(turned)) if j not in (*SHOULDERS, *ELBOWS)]
    np.testing.assert_array_equal(turned[others], shown.rotations[others])
