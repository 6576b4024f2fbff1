"""A stance under a clip, and boldness in what is made of a threat (S9)."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.components import Feet, Phase, Posture, Reaction, Sustained
from behaviours.scenario import parse_scenario
from behaviours.simulation import Simulation
from behaviours.wearing import as_felt, worn_by, worn_pose
from engine.body.kinematics import com_of, joints_of
from engine.body.limits import excess_beyond_rad
from engine.body.skeleton import ANKLES, TOES, WRISTS, Pose
from engine.clips.library import find_clip
from engine.clips.playback import sample

FEET = [*ANKLES, *TOES]
CLIPS = ("sway", "walk", "stand")


def clip_named(name, library_clip):
    return find_clip(name) if name == "sway" else library_clip(name)


@pytest.mark.parametrize("name", CLIPS)
@pytest.mark.parametrize(
    ("stance", "intensity"), [("hunched", 1.0), ("posture", 1.0), ("slovenly", 0.8), ("beauty-line", -1.0)]
)
def test_feet_stay_where_the_clip_has_them(name, stance, intensity, library_clip):
    clip = clip_named(name, library_clip)
    worn = worn_by(clip.body, stance, intensity)
    for time_s in np.linspace(0.0, clip.duration_s, 9):
        pose = sample(clip, time_s)
        coloured = worn_pose(clip.body, pose, worn)
        (at, turned), (was, were) = joints_of(clip.body, coloured), joints_of(clip.body, pose)
        assert np.abs(at[FEET] - was[FEET]).max() < 1e-9
        assert np.abs(np.abs((turned[FEET] * were[FEET]).sum(axis=1)) - 1.0).max() < 1e-9


@pytest.mark.parametrize("name", CLIPS)
def test_the_trunk_oversteps_no_limit_that_the_clip_does_not(name, library_clip):
    clip = clip_named(name, library_clip)
    worn = worn_by(clip.body, "hunched", 1.0)
    for time_s in np.linspace(0.0, clip.duration_s, 9):
        pose = sample(clip, time_s)
        beyond = excess_beyond_rad(clip.body, worn_pose(clip.body, pose, worn).rotations, pose.rotations)
        assert beyond[1:13].max() < 1e-9  # spine, head, arms; the legs follow the feet


def test_the_neutral_stance_changes_nothing():
    clip = find_clip("sway")
    pose = sample(clip, 1.0)
    same = worn_pose(clip.body, pose, worn_by(clip.body, "posture", 0.0))
    assert np.abs(same.root_m - pose.root_m).max() < 1e-9
    assert np.abs(np.abs((same.rotations * pose.rotations).sum(axis=1)) - 1.0).max() < 1e-9


def test_a_hunched_head_is_lower_and_a_proud_one_no_lower():
    clip = find_clip("sway")
    pose = sample(clip, 1.0)

    def head_m(stance, intensity):
        return joints_of(clip.body, worn_pose(clip.body, pose, worn_by(clip.body, stance, intensity)))[0][4]

    plain = joints_of(clip.body, pose)[0][4]
    assert head_m("hunched", 1.0)[2] < plain[2] - 0.02
    assert head_m("posture", 1.0)[2] > plain[2] - 0.01


@pytest.mark.parametrize("stance", ["slovenly", "recoil-strong"])
def test_a_pelvis_that_is_shifted_out_of_a_leg_s_reach_sinks_smoothly(stance, library_clip):
    """Over a walk at 120 Hz the pelvis's height has no corners.

    Without the rounded corner it is 6.4 mm a tick squared (92 m/s2) for the one and 4.6 for the other.
    """
    clip = library_clip("walk")
    worn = worn_by(clip.body, stance, 1.0)
    times_s = np.arange(0.0, 4.0, 1.0 / 120.0)
    heights_m = np.array([worn_pose(clip.body, sample(clip, t), worn).root_m[2] for t in times_s])
    assert 1000.0 * np.abs(np.diff(heights_m, 2)).max() < {"slovenly": 5.2, "recoil-strong": 2.6}[stance]


def test_what_is_felt_is_clamped_and_falls_with_boldness():
    assert as_felt(0.5, 0.0, 0.5) == 0.5
    assert as_felt(0.5, 1.0, 0.5) == 0.0
    assert as_felt(0.5, -1.0, 0.5) == 1.0
    assert as_felt(0.9, -1.0, 0.5) == 1.0


def sustained_with(clip: str, boldness: float) -> tuple[Simulation, Pose]:
    """The sustained pose of a character of this boldness against one and the same threat."""
    scenario = parse_scenario(
        f"""
        duration_s = 1.0
        [[character]]
        clip = "{clip}"
        start_s = 0.4
        boldness = {boldness}
        [[threat]]
        perceived_s = 0.1
        azimuth_deg = 25
        speed_mps = 26
        """
    )
    simulation = Simulation(scenario, lambda spec: find_clip(spec.clip))
    while simulation.world[Reaction].phase[0] == Phase.PLAY:
        simulation.step()
    s = simulation.world[Sustained]
    return simulation, Pose(s.root_m[0].copy(), s.rotations[0].copy())


@pytest.mark.parametrize("name", CLIPS)
def test_timid_and_bold_meet_the_same_threat_otherwise_and_both_in_balance(name, library_clip):
    body = clip_named(name, library_clip).body
    wrists = []
    for boldness in (-1.0, 1.0):
        simulation, sustained = sustained_with(name, boldness)
        wrists.append(joints_of(body, sustained)[0][list(WRISTS)])
        wanted = simulation.world[Sustained].com_wanted_m[0]
        assert np.hypot(*(com_of(body, sustained)[:2] - wanted)) < 0.02
        assert simulation.world[Feet].mode[0].any()
        assert np.isfinite(simulation.world[Posture].root_m[0]).all()
    assert np.linalg.norm(wrists[0] - wrists[1], axis=1).max() > 0.10
