"""Legs that stand keep the limits of hips and ankles: knees swing aside, heels rise, an old motion gives way."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.blends.leg_limits import (
    EARLY_RAD,
    GIVE_RAD,
    HEEL_GIVE_RAD,
    bounds_between,
    bounds_over,
    free_knee,
    keep_leg,
    pushed,
    raise_heel,
)
from behaviours.settle.seams import MOMENT
from behaviours.settle.settled_legs import Footing, stand
from behaviours.settle.settling import PASSES_RAD, beyond_left
from behaviours.timing import TICK_S
from engine.body import support
from engine.body.kinematics import joints_of
from engine.body.limb_ik import apply_leg
from engine.body.limits import beyond_limits, excess_rad
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, KNEES, MIRRORED, TOES, Pose
from engine.clips.mirror import mirror_pose
from engine.maths import quaternion, springs
from tests.behaviours.people import BODY, standing
from tests.behaviours.two_poses import held

REST = standing().rotations
STILL = np.zeros((JOINT_COUNT, 3))


def squatting(down_m: float, forward_m: float = 0.0, turned_deg: float = 0.0, swivel_deg: float = 0.0):
    """(pose, positions, orientations): standing, the pelvis so much lower and farther ahead, the feet flat where they
    were, turned out, the knees at a swivel.
    """
    feet, pose = held(standing()), standing()
    rotations, root_m = pose.rotations.copy(), pose.root_m + [forward_m, 0.0, -down_m]
    positions, orientations = joints_of(BODY, Pose(root_m, rotations))
    for side, sign in enumerate((1.0, -1.0)):
        turned = quaternion.about_z(sign * np.radians(turned_deg))
        swivel = np.radians(swivel_deg)
        apply_leg(BODY, rotations, positions, orientations, side, feet.ankle_m[side], turned, swivel, 0.0)
    return Pose(root_m, rotations), positions, orientations


def excess_deg(rotations, joint: int) -> float:
    return float(np.degrees(excess_rad(BODY, rotations)[joint]))


def kept(squat, how=keep_leg):
    """The rotations of a squat whose legs are kept within limits, one way."""
    pose, positions, orientations = squat
    rotations, at, turned = pose.rotations.copy(), positions.copy(), orientations.copy()
    for side in range(2):
        how(BODY, bounds_between(BODY, REST, REST, 0.5, side), 1.0, side, rotations, at, turned)
    return rotations


def test_a_limit_pushes_gently_and_in_the_end_as_far_as_one_is_beyond_it():
    far = np.linspace(0.0, 6.0 * GIVE_RAD, 61)
    found = np.array([pushed(-np.inf, 1.0, 1.0 + x) for x in far])
    np.testing.assert_allclose(np.diff(found[:, 0]) / np.diff(far), 0.5 * (found[1:, 1] + found[:-1, 1]), atol=1e-9)
    np.testing.assert_allclose(found[21:, 0], far[21:] - GIVE_RAD, atol=1e-12)
    assert pushed(-1.0, 1.0, 0.99) == (0.0, 0.0)
    assert pushed(-1.0, 1.0, -1.5)[0] == -pushed(-1.0, 1.0, 1.5)[0]


def test_legs_within_their_limits_are_left_alone_to_the_last_bit():
    squat = squatting(0.15)
    np.testing.assert_array_equal(kept(squat), squat[0].rotations)


@pytest.mark.parametrize("down_m", [0.25, 0.27, 0.29])
def test_the_heel_rises_for_an_ankle_that_is_bent_too_far_and_the_toes_stay(down_m):
    squat = squatting(down_m, 0.02)
    assert excess_deg(squat[0].rotations, ANKLES[0]) > 1.0
    rotations = kept(squat, raise_heel)
    assert excess_rad(BODY, rotations)[list(ANKLES)].max() < GIVE_RAD + HEEL_GIVE_RAD
    before, after = (
        support.sole_points(BODY, *joints_of(BODY, Pose(squat[0].root_m, r))) for r in (squat[0].rotations, rotations)
    )
    heels, toes = support.SOLE_POINTS.index("heel_inner"), support.SOLE_POINTS.index("toe_inner")
    np.testing.assert_allclose(after[:, toes:], before[:, toes:], atol=1e-9)
    assert (after[:, heels, 2] - before[:, heels, 2]).min() > 0.002


def test_the_knee_swings_aside_for_a_foot_that_points_too_far_out():
    squat = squatting(0.1, turned_deg=30.0)
    assert excess_deg(squat[0].rotations, ANKLES[0]) > 3.0
    rotations = kept(squat, free_knee)
    assert excess_rad(BODY, rotations)[list(ANKLES)].max() < GIVE_RAD
    positions, orientations = joints_of(BODY, Pose(squat[0].root_m, rotations))
    for joint in (*HIPS, *ANKLES, *TOES):
        np.testing.assert_allclose(positions[joint], squat[1][joint], atol=1e-9)
    assert quaternion.angle_between(orientations[ANKLES[0]], squat[2][ANKLES[0]]) < 1e-7


@pytest.mark.parametrize("how", [raise_heel, free_knee, keep_leg])
def test_nothing_jumps_while_a_pelvis_sinks(how):
    """A millimetre of the pelvis moves no knee, and no heel, by more than a few."""
    depths_m = np.arange(0.2, 0.4, 0.001)
    at = []
    for down_m in depths_m:
        squat = squatting(down_m, 0.04, turned_deg=14.0)
        at.append(joints_of(BODY, Pose(squat[0].root_m, kept(squat, how)))[0][[*KNEES, *ANKLES]])
    steps_m = np.linalg.norm(np.diff(at, axis=0), axis=2)
    assert steps_m.max() < 0.008
    assert np.abs(np.diff(steps_m, axis=0)).max() < 0.003


def test_a_mirrored_leg_is_kept_as_the_mirror_image():
    squat = squatting(0.33, 0.05, turned_deg=20.0)
    turned = squat[0].rotations.copy()
    turned[0] = quaternion.about_x(0.1)
    positions, orientations = joints_of(BODY, Pose(squat[0].root_m, turned))
    ours = Pose(squat[0].root_m, kept((Pose(squat[0].root_m, turned), positions, orientations)))
    assert np.abs(ours.rotations - turned).max() > 0.01
    other = mirror_pose(Pose(squat[0].root_m, turned))
    theirs = Pose(other.root_m, kept((other, *joints_of(BODY, other))))
    mirrored_m = joints_of(BODY, theirs)[0][MIRRORED] * [1.0, -1.0, 1.0]
    np.testing.assert_allclose(mirrored_m, joints_of(BODY, ours)[0], atol=1e-9)


def test_each_end_of_a_blend_keeps_what_it_has_beyond_its_limits():
    """At either end there is nothing to mend, however far beyond its limits that is."""
    deep = squatting(0.36, 0.05)
    for first, last, weight in ((deep[0].rotations, REST, 0.0), (REST, deep[0].rotations, 1.0)):
        rotations, at, turned = deep[0].rotations.copy(), deep[1].copy(), deep[2].copy()
        bounds = bounds_between(BODY, first, last, weight, 0)
        assert keep_leg(BODY, bounds, 1.0, 0, rotations, at, turned) == 0.0
        np.testing.assert_array_equal(rotations, deep[0].rotations)


def carried_on(source, forward_m: float, beyond=STILL):
    """The pose of a source, both feet held, whose pelvis an old motion has carried on, put on its feet."""
    at, turned = joints_of(BODY, source)
    ankles = list(ANKLES)
    pose = Pose(source.root_m + [forward_m, 0.0, 0.0], source.rotations.copy())
    longest = (2.0, 2.0)  # the old legs': nothing sinks
    footing = Footing(source.root_m, source.rotations, beyond, at[ankles], turned[ankles], np.ones(2), longest)
    stand(BODY, footing, pose.root_m, pose.rotations)
    return pose


def test_a_pelvis_that_runs_on_is_slowed_down_and_stopped_by_hips_and_ankles():
    """The farther it would run on, the farther it is, less and less so; never so far that a joint passes its limit."""
    source = squatting(0.06)[0]
    far_m = np.arange(0.0, 0.5, 0.01)
    poses = [carried_on(source, ahead_m) for ahead_m in far_m]
    went_m = np.array([pose.root_m[0] - source.root_m[0] for pose in poses])
    assert max(excess_rad(BODY, pose.rotations)[HIPS[0] :].max() for pose in poses) < np.radians(0.5)
    np.testing.assert_allclose(went_m[:10], far_m[:10], atol=1e-12)
    assert went_m[-1] < 0.8 * far_m[-1]
    assert np.abs(np.diff(went_m, 2)).max() < 0.005


def test_what_the_old_motion_had_beyond_its_limits_is_let_be():
    deep, positions, orientations = squatting(0.29, 0.03)
    beyond = np.zeros((JOINT_COUNT, 3))
    own = excess_rad(BODY, deep.rotations)[ANKLES[0]]
    beyond[list(ANKLES), 1] = -own - EARLY_RAD
    rotations = deep.rotations.copy()
    keep_leg(BODY, bounds_over(BODY, REST, beyond, 0), 1.0, 0, rotations, positions, orientations)
    assert np.abs(rotations - deep.rotations).max() < 0.01
    beyond[list(ANKLES), 1] = -0.5 * own - EARLY_RAD
    half = bounds_over(BODY, REST, beyond, 0)
    keep_leg(BODY, half, 1.0, 0, rotations, positions, orientations)
    allowed_deg = 0.5 * excess_deg(deep.rotations, ANKLES[0])
    assert excess_deg(rotations, ANKLES[0]) == pytest.approx(allowed_deg, abs=0.35)


def beyond_early(rotations):
    return beyond_limits(BODY.limit_low_rad + EARLY_RAD, BODY.limit_high_rad - EARLY_RAD, rotations)


def test_a_foot_that_leaves_its_limits_at_speed_goes_on_for_a_hair():
    """The knee that swings aside for it does not leave at once as fast as it: no seam jumps by that (0.05 m/s)."""
    deep, at = squatting(0.30, 0.03, turned_deg=10.0, swivel_deg=15.0)[:2]
    ankles, radps, moment_s = list(ANKLES), 6.0, MOMENT * TICK_S
    assert (beyond_early(deep.rotations)[ankles, 1] < -EARLY_RAD).all()

    def old(elapsed_s: float) -> np.ndarray:
        """Both feet turn farther up, out of their limits."""
        rotations, up = deep.rotations.copy(), quaternion.about_y(-radps * elapsed_s)
        for ankle in ankles:
            rotations[ankle] = quaternion.multiply(rotations[ankle], up)
        return rotations

    def knees_m(elapsed_s: float, beyond) -> np.ndarray:
        pose = Pose(deep.root_m.copy(), old(elapsed_s))
        feet, left = joints_of(BODY, pose)[1][ankles], beyond_left(beyond, elapsed_s, 0.05)
        stand(BODY, Footing(deep.root_m, REST, left, at[ankles], feet, np.ones(2), (2.0, 2.0)), *pose)
        return joints_of(BODY, pose)[0][list(KNEES)]

    beyond = np.array([beyond_early(deep.rotations), np.zeros((JOINT_COUNT, 3))])
    still_m = knees_m(0.0, beyond)
    without_mps = np.linalg.norm(knees_m(moment_s, beyond) - still_m, axis=1).max() / moment_s
    beyond[1] = (beyond_early(old(moment_s)) - beyond[0]) / moment_s
    jump_mps = np.linalg.norm(knees_m(moment_s, beyond) - still_m, axis=1).max() / moment_s
    assert jump_mps < 0.01
    assert without_mps > 4.0 * jump_mps


@pytest.mark.parametrize("radps", [0.0, 0.3, -0.3, 6.0, -6.0, 100.0])
def test_what_is_left_beyond_limits_goes_on_outwards_by_no_more_than_a_hair(radps):
    beyond = np.zeros((2, JOINT_COUNT, 3))
    beyond[0, ANKLES[0], 1], beyond[1, ANKLES[0], 1], beyond[1, KNEES[0], 1] = 0.2, radps, radps
    times_s = np.linspace(0.0, 0.3, 4001)
    left = np.array([beyond_left(beyond, t, 0.05) for t in times_s])
    dying = 0.2 * np.array([springs.decaying(1.0, 0.0, 0.05, t)[0] for t in times_s])
    more = left[:, ANKLES[0], 1] - dying
    assert left[0, ANKLES[0], 1] == 0.2
    assert more.min() > -1e-12
    assert more.max() == pytest.approx(PASSES_RAD if radps > 1.0 else more.max(), rel=0.01)
    assert more.max() <= PASSES_RAD * 1.000001 if radps > 0.0 else more.max() == 0.0
    first_s = 1e-7
    rate = (beyond_left(beyond, first_s, 0.05)[ANKLES[0], 1] - 0.2) / first_s
    assert rate == pytest.approx(max(radps, 0.0), abs=1e-3, rel=0.02)
    assert np.abs(left[:, KNEES[0]]).max() == 0.0  # a joint within its limits drawn in leaves nothing
