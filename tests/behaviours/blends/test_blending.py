"""The blend between two still poses (thesis 4.3), against what it promises: lines, feet, head, both knee rules."""

from __future__ import annotations

import numpy as np
import pytest
from numba import njit

from behaviours.blends.arm_ways import BEYOND_RAD
from behaviours.blends.blending import primary_support
from behaviours.blends.held_feet import FootGoals, Knees, reachable, swivel_at
from behaviours.measure.measures import distance_from_line
from engine.body.kinematics import com_of, joints_of
from engine.body.limb_ik import apply_leg
from engine.body.limits import excess_rad
from engine.body.skeleton import ANKLES, BACK, HEAD, HIPS, KNEES, NECK, PELVIS, WAIST, WRISTS, Pose
from engine.clips.mirror import mirror_pose
from engine.maths import quaternion
from tests.behaviours.people import BODY, coming, met, standing
from tests.behaviours.two_poses import at_ease, between, components_to_rotation, end_of, held, on_guard

WEIGHTS = np.linspace(0.0, 1.0, 21)


@pytest.fixture(scope="module")
def guarded() -> Pose:
    """The sustained pose against a ball at the head, from the front left."""
    return met(coming(30.0)).sustained


@pytest.fixture(scope="module")
def way(guarded):
    """From standing to it: joints (T, J, 3), orientations (T, J, 4), poses."""
    poses = [between(standing(), guarded, weight) for weight in WEIGHTS]
    both = Pose(np.array([pose.root_m for pose in poses]), np.array([pose.rotations for pose in poses]))
    return *joints_of(BODY, both), both


def test_a_blend_begins_and_ends_exactly_where_it_should(guarded):
    for weight, wanted in ((0.0, standing()), (1.0, guarded)):
        shown = joints_of(BODY, between(standing(), guarded, weight, goals=held(wanted)))[0]
        np.testing.assert_allclose(shown, joints_of(BODY, wanted)[0], atol=1e-7)


def test_com_hands_and_neck_are_on_their_lines(guarded, way):
    joints_m, _, poses = way
    first, last = joints_of(BODY, standing())[0], joints_of(BODY, guarded)[0]
    com = com_of(BODY, poses)
    assert distance_from_line(com, com_of(BODY, standing()), com_of(BODY, guarded)).max() < 0.002
    for wrist in WRISTS:
        assert distance_from_line(joints_m[:, wrist], first[wrist], last[wrist]).max() < 1e-6
    assert distance_from_line(joints_m[:, NECK], first[NECK], last[NECK]).max() < 0.008


def test_held_feet_stay_to_a_hair(way):
    joints_m, turned, _ = way
    for ankle in ANKLES:
        np.testing.assert_allclose(joints_m[:, ankle], joints_m[[0], ankle].repeat(len(WEIGHTS), 0), atol=1e-9)
        assert max(quaternion.angle_between(turned[0, ankle], q) for q in turned[:, ankle]) < 1e-7


def test_the_head_is_slerped_in_the_world(guarded, way):
    first, last = end_of(standing()).orientations[HEAD], end_of(guarded).orientations[HEAD]
    for weight, turned in zip(WEIGHTS, way[1], strict=True):
        assert quaternion.angle_between(turned[HEAD], quaternion.slerp(first, last, weight)) < 1e-6


def test_no_joint_goes_beyond_limits_that_its_ends_keep(guarded, way):
    ends = np.maximum(excess_rad(BODY, standing().rotations), excess_rad(BODY, guarded.rotations))
    assert np.degrees((excess_rad(BODY, way[2].rotations) - ends).max()) < 0.5


def test_a_mirrored_blend_is_the_mirror_image(guarded):
    shown = between(standing(), guarded, 0.4)
    mirrored = between(mirror_pose(standing()), mirror_pose(guarded), 0.4, support=1)
    back = mirror_pose(mirrored)
    np.testing.assert_allclose(joints_of(BODY, back)[0], joints_of(BODY, shown)[0], atol=1e-9)


def test_a_trunk_that_bows_keeps_its_neck_nearer_to_a_line():
    """As far as its spine folds for that: half of the arc at least."""
    bowed = standing()
    for joint in (WAIST, BACK):
        bowed.rotations[joint] = components_to_rotation(0.0, np.radians(30.0), 0.0)
    first, last = joints_of(BODY, standing())[0][NECK], joints_of(BODY, bowed)[0][NECK]
    shown = np.array([joints_of(BODY, between(standing(), bowed, weight))[0][NECK] for weight in WEIGHTS])
    slerped = []
    for weight in WEIGHTS:
        pose = standing()
        for joint in (WAIST, BACK):
            pose.rotations[joint] = components_to_rotation(0.0, weight * np.radians(30.0), 0.0)
        slerped.append(joints_of(BODY, pose)[0][NECK])
    arc = distance_from_line(np.array(slerped), first, last).max()
    assert arc > 0.02
    assert distance_from_line(shown, first, last).max() < 0.55 * arc


def in_a_stride(pose: Pose, forward_m: float, short_m: float, lean_deg: float) -> Pose:
    """The left foot 30 cm ahead, the right one as far behind; the pelvis so high that one leg is short of straight by
    so much, the trunk leaning back.
    """
    rotations, feet = pose.rotations.copy(), stride()
    rotations[WAIST] = components_to_rotation(0.0, -np.radians(lean_deg), 0.0)
    end = end_of(Pose(pose.root_m + [forward_m, 0.0, 0.0], rotations))
    heights_m = []
    for side in range(2):
        reach = sum(float(np.linalg.norm(BODY.offset_m[joint])) for joint in (KNEES[side], ANKLES[side])) - short_m
        x, y, z = end.positions[HIPS[side]] - feet.ankle_m[side]
        heights_m.append(np.sqrt(reach**2 - x**2 - y**2) - z)
    end = end_of(Pose(end.root_m + [0.0, 0.0, min(heights_m)], rotations))
    for side in range(2):
        ankle, turned = feet.ankle_m[side], feet.turned[side]
        apply_leg(BODY, end.rotations, end.positions, end.orientations, side, ankle, turned, 0.0, 0.0)
    return Pose(end.root_m, end.rotations)


def stride() -> FootGoals:
    feet = held(standing())
    return feet._replace(ankle_m=feet.ankle_m + np.array([[0.3, 0.0, 0.0], [-0.3, 0.0, 0.0]]))


@pytest.mark.parametrize("forward", [True, False])
def test_the_com_waits_on_its_line_for_a_leg_that_would_be_too_short(forward):
    """Over a leg that stays behind, straight, the trunk leaning the other way: hurrying on would make it worse."""
    first, last = in_a_stride(at_ease(), 0.0, 0.01, 0.0), in_a_stride(on_guard(), 0.2, 0.001, 25.0)
    if not forward:
        first, last = last, first
    ends = com_of(BODY, first), com_of(BODY, last)
    coms = np.array([com_of(BODY, between(first, last, w, goals=stride())) for w in np.linspace(0.0, 1.0, 41)])
    assert distance_from_line(coms, *ends).max() < 0.002


def test_the_primary_support_is_the_planted_foot_nearest_to_the_com():
    ankles = np.array([(0.0, 0.1, 0.1), (0.0, -0.1, 0.1)])
    both, right = np.array([True, True]), np.array([False, True])
    assert primary_support(both, ankles, np.array([0.0, 0.04, 1.0])) == 0
    assert primary_support(both, ankles, np.array([0.0, -0.04, 1.0])) == 1
    assert primary_support(right, ankles, np.array([0.0, 0.04, 1.0])) == 1
    assert primary_support(~both, ankles, np.array([0.0, 0.04, 1.0])) == 0


@njit
def _swivel(knees, weight, side, ankle_m, positions, orientations):
    return swivel_at(knees, weight, side, ankle_m, positions, orientations)


@njit
def _knee_at(body, rotations, positions, orientations, side, ankle_m, turned, swivel):
    apply_leg(body, rotations, positions, orientations, side, ankle_m, turned, swivel, 0.0)
    return positions[KNEES[side]].copy()


def crouching() -> Pose:
    """Standing, the pelvis 15 cm lower, the feet where they were."""
    low = Pose(standing().root_m - [0.0, 0.0, 0.15], standing().rotations)
    return between(low, low, 0.0, goals=held(standing()))


@pytest.mark.parametrize("side", [0, 1])
def test_the_least_rule_finds_the_nearest_place_for_a_knee(side):
    """The thesis's rule, against trying out every swivel."""
    end = end_of(crouching())
    before_m = end.positions[list(KNEES)] + np.array([[0.02, 0.05, 0.03], [-0.03, -0.06, 0.01]])
    ankle_m, turned = end.positions[ANKLES[side]].copy(), tuple(end.orientations[ANKLES[side]])
    knees = Knees((0.0, 0.0), (0.0, 0.0), True, before_m)

    def knee_at(swivel: float) -> np.ndarray:
        parts = (end.rotations.copy(), end.positions.copy(), end.orientations.copy())
        return _knee_at(BODY, *parts, side, ankle_m, turned, swivel)

    found = _swivel(knees, 0.3, side, ankle_m, end.positions, end.orientations)
    tried = [np.linalg.norm(knee_at(s) - before_m[side]) for s in np.linspace(-np.pi, np.pi, 721)]
    assert np.linalg.norm(knee_at(found) - before_m[side]) <= min(tried) + 1e-9
    assert max(tried) > min(tried) + 0.1


def test_the_ends_rule_goes_from_end_to_end():
    knees = Knees((0.1, -3.0), (0.5, 3.0), False, np.zeros((2, 3)))
    end = end_of(crouching())
    left, right = (
        _swivel(knees, 0.5, side, end.positions[ANKLES[side]], end.positions, end.orientations) for side in (0, 1)
    )
    assert left == pytest.approx(0.3)
    assert abs(right) == pytest.approx(np.pi)  # the shorter way round


def test_a_leg_in_the_air_stays_behind_its_plan_where_the_hip_would_not_go():
    """A foot far behind the body: the hip stops at its limit if the foot bears nothing, the sole as it was to be."""
    plan = held(at_ease())
    behind = plan.ankle_m + np.array([[-0.6, 0.0, 0.25], [0.0, 0.0, 0.0]])

    def over_rad(bears: float) -> float:
        goals = plan._replace(ankle_m=behind, bears=np.array([bears, 1.0]))
        pose = between(at_ease(), on_guard(), 0.5, goals=goals, support=1)
        return float(excess_rad(BODY, pose.rotations)[HIPS[0]])

    own = float(excess_rad(BODY, at_ease().rotations)[HIPS[0]])
    assert over_rad(1.0) > own + 0.1
    assert over_rad(0.0) < own + BEYOND_RAD


def test_a_foot_that_bears_is_never_left_behind_and_one_in_the_air_softly():
    """The leg's length against how far its goal is: exact for a bearing foot; else smooth, never full length."""
    end = end_of(standing())
    hip = end.positions[HIPS[0]]
    full = sum(float(np.linalg.norm(BODY.offset_m[joint])) for joint in (KNEES[0], ANKLES[0]))
    far = np.linspace(0.9 * full, 1.1 * full, 400)
    places = np.array([hip - [0.0, 0.0, d] for d in far])
    borne = np.array([reachable(BODY, tuple(hip), place, 0, 1.0) for place in places])
    np.testing.assert_allclose(borne, places, atol=1e-12)
    loose = np.linalg.norm(np.array([reachable(BODY, tuple(hip), place, 0, 0.0) for place in places]) - hip, axis=1)
    assert loose.max() < full
    assert (np.diff(loose) >= 0.0).all()
    np.testing.assert_allclose(loose[:50], far[:50], atol=1e-5)
    assert np.abs(np.diff(loose, 2)).max() < 1.0 * (far[1] - far[0]) ** 2 / 0.006


def test_the_pelvis_is_placed_by_the_support_foot_alone_where_nothing_is_held():
    """With both feet loose the support foot goes straight from end to end, and the pelvis with it."""
    there = Pose(standing().root_m + [0.2, 0.1, 0.0], on_guard().rotations)
    loose = held(standing())._replace(bound=np.zeros(2, bool), bears=np.zeros(2))
    half = joints_of(BODY, between(standing(), there, 0.5, goals=loose))[0]
    np.testing.assert_allclose(half[ANKLES[0]] - end_of(standing()).positions[ANKLES[0]], (0.1, 0.05, 0.0), atol=0.02)
    assert half[PELVIS, 2] == pytest.approx(standing().root_m[2], abs=0.02)
