"""The figures of the sustained pose: they add up, meet their bars on the embedded clip, and see what is wrong."""

import math

import numpy as np
import pytest

from behaviours.protect.pose_report import PoseCase, pose_case
from behaviours.settings import Settings
from demos.benchmarks.pose_bars import RESTARTS, arm_depth, limit_excess, lines_of, pose_bars, pose_cases
from engine.body.skeleton import ELBOWS, SHOULDERS, Pose
from engine.clips.library import find_clip
from engine.maths import quaternion


@pytest.fixture(scope="module")
def clips():
    return {"sway": find_clip("sway")}


def test_the_figures_add_up_and_meet_their_bars(clips):
    bars = pose_bars(8, 3, clips)
    assert sum(bars.cases_by_name.values()) == bars.cases == 8
    assert bars.restarts == RESTARTS * (8 - bars.cases_by_name["airborne"])
    assert bars.poses_improved <= bars.restarts_improved <= bars.restarts
    assert bars.feet_off_because_hip_high == bars.feet_off_floor
    assert bars.worst_limit_excess_deg < 0.5
    assert bars.worst_arm_depth_mm < 5.0
    assert bars.worst_com_m < 0.02
    assert len(lines_of(bars)) == 6


def test_cases_are_seeded_and_half_of_them_come_from_ahead(clips):
    cases = pose_cases(clips, 40, 5)
    assert cases == pose_cases(clips, 40, 5)
    assert all(abs(case.azimuth_deg) <= 75.0 for _, case in cases[::2])
    assert any(abs(case.azimuth_deg) > 75.0 for _, case in cases[1::2])


def test_a_bent_elbow_and_a_hand_in_the_head_are_seen(clips):
    posed = pose_case(clips["sway"], PoseCase(0.5, 20.0, 5.0, 26.0, 0.5), Settings())
    sustained = posed.protection.sustained
    assert limit_excess(posed, sustained)[0] < 0.01
    bent = Pose(sustained.root_m, sustained.rotations.copy())
    bent.rotations[ELBOWS[0]] = quaternion.about_y(math.radians(30.0))  # the wrong way
    excess_deg, joint = limit_excess(posed, bent)
    assert excess_deg == pytest.approx(30.0, abs=1e-6)
    assert joint == "left_elbow"
    assert arm_depth(posed.body, sustained)[0] < 5.0
    folded = Pose(sustained.root_m, np.tile([1.0, 0.0, 0.0, 0.0], (len(sustained.rotations), 1)))
    folded.rotations[SHOULDERS[0]] = quaternion.about_x(math.radians(-90.0))  # the left arm through the chest
    depth_mm, pair = arm_depth(posed.body, folded)
    assert depth_mm > 20.0
    assert pair.startswith("left_")
