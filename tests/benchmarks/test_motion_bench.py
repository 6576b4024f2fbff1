"""`brace bench --motion`: its cases, its sums and its tables on rows made up beforehand, and a small run of it."""

from __future__ import annotations

import math
import multiprocessing
import signal
import time

import numpy as np
import pytest

from behaviours.measure.measures import Worst
from demos.benchmarks import motion, motion_cases
from demos.benchmarks.motion_cases import (
    AHEAD_DEG,
    NEW_ONE_IN,
    Case,
    make_cases,
    make_knock_downs,
    scenario_of,
    where_from,
)
from demos.benchmarks.motion_phases import phase_lines, search_lines, some_figures
from demos.benchmarks.motion_run import asymmetry_m, play, run_case
from demos.benchmarks.motion_table import figures_of, lines_of
from demos.benchmarks.pose_bars import PoseBars
from engine.clips.library import find_clip
from tests.behaviours.runs import mirrored_back

CASE = Case(0, "sway", 0.5, True, "head", 30.0, 5.0, 26.0, 0.5)
NOTHING = Worst(0.0, 0, "")


def row(number: int = 0, **changed):
    """A case in which everything was well."""
    return {
        "case": CASE._replace(number=number), "contact_error_s": 0.0, "first_contact": "left_hand", "head_peak_g": 5.0,
        "bare_head_peak_g": 50.0, "passed_head_peak_g": 4.0, "foot_slide_max_m": 0.0, "hand_line_deviation_max_m": 0.0,
        "com_line_deviation_max_m": 0.0, "seam_position_jump_max_m": 0.0, "seam_velocity_jump_max_mps": 0.0,
        "joint_limit_excess_max_rad": 0.0, "overlap_max_m": 0.0, "protect_ms": [0.2, 0.3], "snap": NOTHING,
        "fastest": NOTHING, "snap_phase": "protect", "foot_ticks": 100, "settling_foot_ticks": 10,
        "settling_before_m": 0.0,
        "settling_after_m": 0.0, "promise_error_s": 0.0, "line_ticks": 50,
        "hand_frames": {"straight": 60, "bowed": 20, "led": 15, "beyond_reach": 5}, "led_astray_m": 0.0,
        "neck_line_m": 0.0, "two_sequences_ticks": 31, "reacting_ticks": 120, "seams": 5,
        "limit_by_phase": {"protect": NOTHING}, "overlap_by_phase": {"protect": NOTHING},
        "seam_by_phase": {"protect": (NOTHING, NOTHING)}, "searched": [],
    } | changed  # fmt: skip


def figure(rows, name, poses=None):
    (found,) = [one for one in figures_of(rows, poses) if one.name.startswith(name)]
    return found


def test_cases_are_seeded_and_spread_over_clips_and_directions():
    clips = {"sway": find_clip("sway"), "other": find_clip("sway")}
    cases = make_cases(clips, 400, seed=3)
    assert cases == make_cases(clips, 400, seed=3)
    assert cases != make_cases(clips, 400, seed=4)
    assert [case.clip for case in cases[:4]] == ["sway", "other"] * 2
    azimuths = np.array([case.azimuth_deg for case in cases])
    assert 0.55 < np.mean(np.abs(azimuths) <= AHEAD_DEG) < 0.8  # a half, and a third of the other
    assert np.abs(azimuths).max() > 170.0
    assert 0.6 < np.mean([case.target == "head" for case in cases]) < 0.8
    assert all(0.0 <= case.start_s <= clips["sway"].duration_s for case in cases)
    assert np.mean([case.recover == "new" for case in cases]) == pytest.approx(1 / NEW_ONE_IN, abs=0.02)


def test_a_case_as_a_scenario():
    scenario = scenario_of(CASE)
    (threat,) = scenario.threat
    assert (threat.azimuth_deg, threat.speed_mps, threat.size) == (30.0, 26.0, 0.5)
    mirrored = scenario_of(CASE, mirrored=True)
    assert mirrored.threat[0].azimuth_deg == -30.0
    assert mirrored.character[0].mirrored
    assert not scenario_of(CASE, protects=False).character[0].protects
    heavy = scenario_of(CASE._replace(mass_kg=12.0, recover="new"))
    assert heavy.threat[0].mass_kg == 12.0
    assert heavy.duration_s > 6.0


def test_knock_downs_are_heavy_and_from_both_sides():
    falls = make_knock_downs({"sway": find_clip("sway")}, 6, seed=1)
    assert all(case.knocks_down and case.mass_kg > 9.0 and case.recover == "new" for case in falls)
    assert {abs(case.azimuth_deg) > 90.0 for case in falls} == {True, False}


def test_the_greatest_of_a_figure_its_case_and_how_many_are_over():
    rows = [row(0), row(1, foot_slide_max_m=0.0015), row(2, foot_slide_max_m=0.003), row(3, foot_slide_max_m=0.0021)]
    slide = figure(rows, "planted feet slide")
    assert slide.value == pytest.approx(3.0)
    assert not slide.met
    assert (slide.cases, slide.failing) == (4, 2)
    assert slide.worst["case"].number == 2
    assert figure(rows[:2], "planted feet slide").met
    assert "400 ticks" in slide.counted
    assert "40 ticks" in slide.counted


def test_a_bar_is_met_at_the_bar_and_not_above_it():
    for name, key, at in (("beyond joint limits", "joint_limit_excess_max_rad", math.radians(0.5)),
                          ("arms inside", "overlap_max_m", 0.005), ("COM off", "com_line_deviation_max_m", 0.005),
                          ("hands off", "hand_line_deviation_max_m", 0.003),
                          ("jump of velocity", "seam_velocity_jump_max_mps", 0.05),
                          ("contact off its plan", "contact_error_s", 1 / 120)):  # fmt: skip
        assert figure([row(**{key: at * (1 - 1e-9)})], name).met, name
        assert not figure([row(**{key: at * 1.01})], name).met, name


def test_shares_and_medians():
    rows = [row(k, head_peak_g=5.0 if k else 60.0) for k in range(10)]
    spared = figure(rows, "head is hit less hard")
    assert spared.value == pytest.approx(90.0)
    assert spared.met
    assert spared.worst["case"].number == 0
    assert figure(rows, "median cut of the head").value == pytest.approx(90.0)
    rows[1]["passed_head_peak_g"], rows[2]["passed_head_peak_g"] = 6.0, None
    same_ball = figure(rows, "hit less hard by the very same ball")
    assert same_ball.value == pytest.approx(100.0 / 9.0)
    assert (same_ball.cases, same_ball.bar) == (9, "-")
    assert figure(rows, "median cut of the very same ball").value == pytest.approx(-25.0)
    met_by_head = [row(k, first_contact="head" if k < 2 else "right_forearm") for k in range(10)]
    arms = figure(met_by_head, "head threats from ahead")
    assert arms.value == pytest.approx(80.0)
    assert (arms.met, arms.failing) == (False, 2)


def test_a_ball_that_touches_nobody_is_left_out_but_not_where_it_must_be_met():
    rows = [row(0), row(7, contact_error_s=None, first_contact=None, head_peak_g=None)]
    contact = figure(rows, "contact off its plan")
    assert contact.cases == 1
    assert "1 balls" in contact.counted
    assert "7" in contact.counted
    assert figure(rows, "head threats from ahead").value == pytest.approx(50.0)
    assert figure(rows, "head is hit").cases == 1


@pytest.mark.parametrize("value", [math.inf, math.nan])
def test_what_is_no_number_meets_no_bar(value):
    found = figure([row(0), row(1, asymmetry_m=value), row(2, asymmetry_m=0.0)], "mirrored run")
    assert not found.met
    assert (found.cases, found.failing) == (2, 1)
    assert found.worst["case"].number == 1


def test_nothing_to_count_is_not_met():
    none = figure([row(asymmetry_m=None)], "mirrored run")
    assert math.isnan(none.value)
    assert not none.met
    assert none.cases == 0


def test_the_poses_have_their_lines():
    bars = PoseBars(
        100, 300, 3, 2, "some", {"balanced": 90, "unrecovered": 10}, 5, 4, "a foot", *[0.0, "", 0] * 2, 0.0, ""
    )
    restarts = figure([row()], "poses that no perturbed restart", bars)
    assert restarts.value == pytest.approx(98.0)
    assert not restarts.met
    assert "90 balanced" in restarts.counted
    feet = figure([row()], "feet off the floor", bars)
    assert (feet.value, feet.met, feet.worst_words) == (1.0, False, "a foot")


def test_the_table_says_what_is_met_and_what_is_counted():
    lines = lines_of(figures_of([row(overlap_max_m=0.1)]))
    (arms,) = [line for line in lines if line.startswith("arms inside")]
    assert " NO " in arms
    assert "case 0: sway" in arms
    (feet,) = [line for line in lines if line.startswith("planted feet")]
    assert " yes " in feet
    assert any(line.startswith("  hands off their straight lines, mm: 60 of 100 ticks") for line in lines)


def test_where_it_arises_names_phase_and_part():
    bad = {"limit_by_phase": {"protect": Worst(math.radians(30.0), 40, "left_elbow")}, "snap": Worst(9.0, 40, "head")}
    head, *lines = phase_lines([row(0), row(1, **bad), row(2, **bad)])
    (protect,) = [line for line in lines if line.startswith("protect")]
    assert protect.split()[:4] == ["protect", "30.0", "2", "left_elbow"]
    assert protect.split()[-3:] == ["9.0", "2", "head"]
    assert head.startswith("where it arises")


def test_the_search_and_the_falls_are_told():
    new = CASE._replace(recover="new")
    entered = {"kind": "searched", "chosen": "new", "clip": "dance", "distance_m": 0.125}
    falls = [
        row(0, fell=True, got_up=True, stands_again=True, lies_mps=0.01, lowest_m=0.02, rises_m=0.1),
        row(1, fell=True, got_up=False, stands_again=False, lies_mps=0.02, lowest_m=0.01, rises_m=0.2,
            searched=[{"kind": "stays_down", "reason": "no motion that gets up"}]),
        row(2, fell=False, got_up=False, stands_again=False, lies_mps=None, lowest_m=None, rises_m=0.0),
    ]  # fmt: skip
    text = "\n".join(search_lines([row(case=new, searched=[entered]), row(case=new)], False, falls))
    assert "2 struck who ask" in text
    assert "dance 1; windows 0.125 m off" in text
    assert "3 thrown at, 2 fall, 1 get up" in text
    assert "0.02 m/s" in text
    assert "fetch --extra" in text
    assert "1 stay down: no motion that gets up" in text
    assert {one.name.split(",")[0] for one in some_figures(falls)} >= {"jump of place at a seam", "beyond joint limits"}


def test_missing_clips_are_named():
    assert "MISSING: stand, fight, dance, run to a stop" in where_from({"walk": find_clip("sway")})


def test_without_files_beside_the_checkout_the_fetched_ones_do(monkeypatch, tmp_path, library_clip):
    library_clip("walk")
    monkeypatch.setattr(motion_cases, "BESIDE", tmp_path)
    clips = motion_cases.find_clips()
    words = where_from(clips)
    assert "walk" in clips
    assert "walk 2" not in clips
    assert "none beside the checkout" in words
    assert "run to a stop" in words.partition("MISSING: ")[2]
    if "punch" in motion_cases.ready_names():
        assert clips["fight"].name == "punch"


def test_a_small_run_of_it(monkeypatch):
    clips = {"sway": find_clip("sway")}
    monkeypatch.setattr(motion, "find_clips", lambda: clips)
    found = motion.bench(3, seed=5, processes=1)
    assert len(found.rows) == 3
    assert len(found.falls) == 1
    assert found.poses.cases == 3
    assert all(one["finite"] for one in found.rows)
    lines = lines_of(figures_of(found.rows, found.poses))
    assert not any(" nan " in line for line in lines if "mirrored" not in line)
    assert len(some_figures(found.falls)) > 5
    assert phase_lines(found.falls)
    again = run_case(found.rows[1]["case"], clips)
    timed = ("protect_ms",)
    assert {k: v for k, v in again.items() if k not in timed} == {
        k: v for k, v in found.rows[1].items() if k not in timed
    }


def test_interrupted_it_ends_its_processes_at_once(library_clip):
    library_clip("walk")

    def ctrl_c(rows, total):
        raise KeyboardInterrupt

    hears = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt):
        motion.bench(40, processes=2, progress=ctrl_c)
    deadline = time.monotonic() + 10.0
    while multiprocessing.active_children() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert not multiprocessing.active_children()
    assert signal.getsignal(signal.SIGINT) is hears


def test_the_mirror_is_held_up_to_the_right_run():
    clips = {"sway": find_clip("sway")}
    ours, theirs = (play(scenario_of(CASE, mirrored=mirrored), clips).track for mirrored in (False, True))
    assert asymmetry_m(ours, theirs) < 1e-6
    assert asymmetry_m(ours, ours) > 0.05  # a run is not its own mirror image
    from engine.body.kinematics import joints_of

    first = joints_of(theirs.body, theirs.pose)[0][:30]
    np.testing.assert_allclose(mirrored_back(first), joints_of(ours.body, ours.pose)[0][:30], atol=1e-6)
