"""The measures of a run, on runs made up so that what they must find is known beforehand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from behaviours.blends.arm_ways import INTERPOLATED, SLERPED, SWUNG
from behaviours.components import Phase
from behaviours.measure import measures
from behaviours.measure.head_measures import GRAVITY, PHYSICS_HZ, head_acceleration_g, hic15
from behaviours.measure.observing import HandWay, Line, Seam, Track, in_reach, way_of
from engine.body.capsules import CAPSULES, body_capsules
from engine.body.kinematics import joints_of
from engine.body.overlap import PAIRS
from engine.body.skeleton import ELBOWS, JOINT_COUNT, LEFT_HIP, NECK, PELVIS, SHOULDERS, WRISTS, Pose, joint_index
from engine.maths import quaternion
from engine.maths.shapes import nearest_between
from tests.behaviours.people import BODY, standing

STILL = standing()
LEFT_ELBOW = joint_index("left_elbow")


def track_of(poses, phases, *, planted=(True, True), stands=(True, True), clip=STILL) -> Track:
    """A run that shows these poses in these phases; the clip stands still wherever it plays."""
    track = Track(BODY)
    for tick, (pose, phase) in enumerate(zip(poses, phases, strict=True)):
        track.tick.append(tick)
        track.phase.append(phase)
        track.root_m.append(pose.root_m)
        track.rotations.append(pose.rotations)
        track.planted.append(np.array(planted))
        track.stands.append(stands)
        track.clip.append(0)
        track.played.append(clip if phase == Phase.PLAY else None)
        track.head_mps.append(np.empty((0, 3)))
    track.made_from.append(clip)
    return track


def moved(x_m=0.0, z_m=0.0) -> Pose:
    return Pose(STILL.root_m + [x_m, 0.0, z_m], STILL.rotations)


def bent(joint: int, degrees: float, about: str = "y") -> Pose:
    """Standing, but for one joint."""
    axis = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}[about]
    rotations = STILL.rotations.copy()
    rotations[joint] = quaternion.from_rotation_vector(tuple(math.radians(degrees) * k for k in axis))
    return Pose(STILL.root_m, rotations)


def test_a_foot_flagged_planted_slides_as_far_as_it_is_moved():
    poses = [moved(0.001 * k) for k in range(6)]
    assert measures.foot_slide_max_m(track_of(poses, [Phase.PROTECT] * 6)) == pytest.approx(0.005, abs=1e-12)
    # a new stretch is counted from its own begin
    phases = [Phase.PROTECT] * 3 + [Phase.RESPOND] + [Phase.RECOVER_BLEND] * 2
    assert measures.foot_slide_max_m(track_of(poses, phases)) == pytest.approx(0.002, abs=1e-12)


@pytest.mark.parametrize("phase", [Phase.RESPOND, Phase.DOWN, Phase.PLAY])
def test_no_slide_where_the_physics_or_the_clip_has_the_foot(phase):
    assert measures.foot_slide_max_m(track_of([moved(0.1 * k) for k in range(3)], [phase] * 3)) == 0.0


def test_a_foot_that_stands_but_settles_is_told_apart():
    poses = [moved(0.01 * k) for k in range(3)]
    settling = track_of(poses, [Phase.RECOVER_BLEND] * 3, planted=(False, True))
    assert measures.settling_feet(settling).tolist() == [[True, False]] * 3
    assert measures.drift_max_m(settling, measures.settling_feet(settling)) == pytest.approx(0.02, abs=1e-12)
    lifted = track_of(poses, [Phase.RECOVER_BLEND] * 3, planted=(False, True), stands=(False, True))
    assert not measures.settling_feet(lifted).any()


def test_an_elbow_bent_backwards_is_beyond_its_limit_by_that_much():
    # the elbow bends forward with negative Y, and not backwards at all
    track = track_of([STILL, bent(LEFT_ELBOW, 20.0)], [Phase.PROTECT, Phase.RECOVER_RETURN])
    found = measures.joint_limit_excess(track)
    assert math.degrees(found["recover_return"].value) == pytest.approx(20.0, abs=1e-6)
    assert found["recover_return"].what == "left_elbow"
    assert found["recover_return"].tick == 1
    assert found["protect"].value == 0.0
    assert measures.greatest(found) == found["recover_return"]


def test_what_the_clip_itself_oversteps_is_not_ours():
    clip = bent(LEFT_ELBOW, 15.0)
    track = track_of([bent(LEFT_ELBOW, 20.0)], [Phase.PROTECT], clip=clip)
    assert math.degrees(measures.greatest(measures.joint_limit_excess(track)).value) == pytest.approx(5.0, abs=1e-6)
    other = track_of([bent(LEFT_ELBOW, 20.0)], [Phase.PROTECT], clip=bent(joint_index("right_elbow"), 15.0))
    assert math.degrees(measures.greatest(measures.joint_limit_excess(other)).value) == pytest.approx(20.0, abs=1e-6)


def test_before_a_reaction_nothing_counts_and_after_it_all_does():
    wrong = bent(LEFT_ELBOW, 20.0)
    before = track_of([wrong, STILL], [Phase.PLAY, Phase.PROTECT])
    assert measures.greatest(measures.joint_limit_excess(before)).value == 0.0
    after = track_of([STILL, wrong], [Phase.PROTECT, Phase.PLAY])
    assert math.degrees(measures.joint_limit_excess(after)["play"].value) == pytest.approx(20.0, abs=1e-6)


def test_an_arm_across_the_body_is_as_deep_as_its_capsules_say():
    across = bent(SHOULDERS[0], 30.0, about="x")
    for degrees in (40.0, 60.0):  # the left arm swung through the trunk
        trial = bent(SHOULDERS[0], -degrees, about="x")
        found = measures.greatest(measures.overlap(track_of([STILL, trial], [Phase.PROTECT] * 2)))
        assert found.value == pytest.approx(deepest_m(trial), abs=1e-9)
    assert found.what.startswith("left_")
    assert found.value > 0.03
    assert measures.greatest(measures.overlap(track_of([across], [Phase.PROTECT]))).value == 0.0
    own = track_of([trial], [Phase.PROTECT], clip=trial)
    assert measures.greatest(measures.overlap(own)).value == 0.0


def deepest_m(pose: Pose) -> float:
    """By the plain definition: radii less the distance of the axes, of every pair that counts, beyond standing's."""

    def depths(of: Pose) -> np.ndarray:
        shape, (at, turned) = body_capsules(BODY), joints_of(BODY, of)
        ends = [
            [at[j] + np.array(quaternion.rotate(turned[j], end)) for end in (shape.start_m[c], shape.end_m[c])]
            for c, j in enumerate(shape.joint)
        ]
        out = []
        for a, b in PAIRS:
            s, t = nearest_between(*ends[a], *ends[b])
            gap = (1 - s) * ends[a][0] + s * ends[a][1] - (1 - t) * ends[b][0] - t * ends[b][1]
            out.append(shape.radius_m[a] + shape.radius_m[b] - np.linalg.norm(gap))
        return np.array(out)

    return float((depths(pose) - np.maximum(depths(STILL), 0.0)).max())


def test_arms_are_held_against_head_trunk_and_each_other():
    names = {(CAPSULES[a], CAPSULES[b]) for a, b in PAIRS}
    assert ("left_hand", "head") in names
    assert ("right_hand", "neck") in names
    assert ("right_forearm", "upper_chest") in names
    assert ("left_forearm", "right_hand") in names
    assert not any("thigh" in b for _, b in names)


def line(off_m=0.0, ways=(HandWay.STRAIGHT, HandWay.STRAIGHT), weight=0.5) -> Line:
    """Every joint half-way along a metre of X, and so far off it."""
    start, end = np.zeros((JOINT_COUNT, 3)), np.tile([1.0, 0.0, 0.0], (JOINT_COUNT, 1))
    between = np.tile([weight, off_m, 0.0], (JOINT_COUNT, 1))
    return Line(0, between, start, end, ways, between[0], (start[0], end[0]))


def test_lines_are_left_by_as_much_as_the_joint_is_beside_them():
    lines = [line(0.002), line(-0.004), line()]
    assert measures.hand_line_deviation_max_m(lines) == pytest.approx(0.004)
    assert measures.com_line_deviation_max_m(lines) == pytest.approx(0.004)
    assert measures.neck_line_deviation_max_m(lines) == pytest.approx(0.004)
    assert measures.off_line_m(line(0.003, weight=1.2), NECK) == pytest.approx(0.003)  # an overshoot goes on
    assert measures.off_line_m(line(0.003, weight=-0.4), NECK) == pytest.approx(math.hypot(0.003, 0.4))
    assert measures.hand_line_deviation_max_m([]) == 0.0


def test_only_hands_that_go_straight_are_held_against_their_line():
    lines = [line(0.1, (HandWay.BOWED, HandWay.LED)), line(0.2, (HandWay.BEYOND_REACH, HandWay.STRAIGHT))]
    assert measures.hand_line_deviation_max_m(lines) == pytest.approx(0.2)
    assert measures.hand_line_deviation_max_m(lines, (HandWay.BOWED, HandWay.LED)) == pytest.approx(0.1)
    assert measures.hand_frames(lines) == {"straight": 1, "bowed": 1, "led": 1, "beyond_reach": 1}


def test_how_a_hand_goes():
    bent_arm = joints_of(BODY, bent(ELBOWS[0], -90.0))[0]
    straight_arm = joints_of(BODY, STILL)[0]
    assert in_reach(BODY, 0, bent_arm)
    assert not in_reach(BODY, 0, straight_arm)
    assert way_of(BODY, 0, INTERPOLATED, 0.0, bent_arm) == HandWay.STRAIGHT
    assert way_of(BODY, 0, SLERPED, 0.01, bent_arm) == HandWay.LED
    assert way_of(BODY, 0, SWUNG, 0.0, bent_arm) == HandWay.BOWED
    assert way_of(BODY, 0, INTERPOLATED, 0.0, straight_arm) == HandWay.BEYOND_REACH


def test_a_seam_jumps_by_the_worst_joint():
    here, mps = np.zeros((JOINT_COUNT, 3)), np.zeros((JOINT_COUNT, 3))
    there, faster = here.copy(), mps.copy()
    there[WRISTS[0]], faster[LEFT_HIP] = (0.0, 0.03, 0.04), (0.0, 0.0, -2.0)
    track = Track(BODY)
    assert measures.seam_jumps(track) == (0.0, 0.0)
    track.seams += [Seam(3, Phase.PROTECT, here, here, mps, mps), Seam(9, Phase.PLAY, here, there, mps, faster)]
    assert measures.seam_jumps(track) == pytest.approx((0.05, 2.0))
    place, speed = measures.jump_of(track.seams[1])
    assert (place.what, speed.what, place.tick) == ("left_wrist", "left_hip", 9)


def test_a_pop_is_a_change_of_velocity_within_a_tick():
    poses = [moved(), moved(), moved(0.05), moved(0.05), moved(0.05)]
    found = measures.snap(track_of(poses, [Phase.PROTECT] * 5))
    assert found.value == pytest.approx(0.05 * 120)
    even = [moved(0.05 * k) for k in range(5)]
    assert measures.snap(track_of(even, [Phase.PROTECT] * 5)).value < 1e-9
    assert measures.snap(track_of(poses, [Phase.RESPOND] * 5)).value == 0.0


def test_the_fastest_joint_under_the_physics_is_that_of_its_ticks_alone():
    poses = [moved(), moved(0.5), moved(0.6), moved(0.65), moved(2.0)]
    track = track_of(poses, [Phase.PROTECT, Phase.RESPOND, Phase.RESPOND, Phase.DOWN, Phase.PLAY])
    found = measures.fastest_in_physics(track)
    assert found.value == pytest.approx(0.1 * 120)
    assert found.tick == 2


def test_what_the_clip_does_is_no_pop_of_ours():
    poses = [moved(), moved(), moved(), moved(0.05), moved(0.05)]
    track = track_of(poses, [Phase.PROTECT] + [Phase.PLAY] * 4)
    assert measures.snap(track).value == pytest.approx(6.0)
    for k in range(1, 5):
        track.played[k] = poses[k]
    assert measures.snap(track).value < 1e-9


def test_of_a_way_back_that_the_clip_leads_its_share_of_the_clip_is_no_pop_of_ours():
    poses = [moved(), moved(), moved(), moved(0.025), moved(0.025)]
    track = track_of(poses, [Phase.PROTECT] + [Phase.RECOVER_RETURN] * 4)
    clip = [moved(), moved(), moved(), moved(0.05), moved(0.05)]
    assert measures.snap(track).value == pytest.approx(3.0)
    track.led_by = {tick: (0.5, clip[k]) for k, tick in enumerate(track.tick) if k > 0}
    assert measures.snap(track).value < 1e-9


def test_the_com_s_margin_is_that_of_the_planted_feet():
    upright = measures.com_margin_min_m(track_of([STILL], [Phase.PROTECT]))
    tipped = measures.com_margin_min_m(track_of([STILL, bent(PELVIS, 10.0)], [Phase.PROTECT] * 2))
    assert upright is not None
    assert tipped is not None
    assert 0.02 < upright < 0.2
    assert tipped < upright
    assert measures.com_margin_min_m(track_of([STILL], [Phase.PROTECT], planted=(False, False))) is None


def test_a_steady_acceleration_of_the_head_is_itself():
    track = Track(BODY)
    acceleration_g, steps = 20.0, 4
    for tick in range(6):
        at = (np.arange(steps) + tick * steps + 1) / PHYSICS_HZ
        track.head_mps.append(np.outer(acceleration_g * GRAVITY * at, [0.6, 0.0, 0.8]))
    found = head_acceleration_g(track)
    assert len(found) == 6 * steps - 1
    np.testing.assert_allclose(found, acceleration_g, rtol=1e-9)
    # HIC of a constant: a^2.5 times the longest window allowed
    longest_s = int(0.015 * PHYSICS_HZ) / PHYSICS_HZ
    assert hic15(found) == pytest.approx(acceleration_g**2.5 * longest_s, rel=1e-9)
    assert hic15(found[:3]) == pytest.approx(acceleration_g**2.5 * 3 / PHYSICS_HZ, rel=1e-9)
    assert len(head_acceleration_g(Track(BODY))) == 0
