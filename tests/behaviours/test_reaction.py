"""The reaction as a whole: fig. 4.1 phase by phase, from perception to the clip again."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.components import Blend, Phase
from behaviours.measure.measures import foot_slide_max_m, seam_jumps
from behaviours.playing import clip_time_s
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.body.skeleton import WRISTS
from tests.behaviours.runs import AHEAD, events, phases, run, simulation_of, track_of


def test_the_phases_of_fig_4_1_in_their_order(blocked):
    wanted = ["play", "startle", "protect", "respond", "recover_blend", "recover_return", "play"]
    assert phases(blocked) == wanted


def test_phases_last_as_long_as_the_thesis_says(blocked):
    lasts = {row["name"]: row["to_s"] - row["from_s"] for row in blocked.report()["phases"][1:-1]}
    assert lasts["startle"] == pytest.approx(15 / 120, abs=1e-9)
    assert lasts["respond"] == pytest.approx(0.080, abs=TICK_S)
    assert lasts["recover_blend"] == pytest.approx(0.260, abs=TICK_S)
    assert lasts["recover_return"] == pytest.approx(0.375, abs=TICK_S)


def test_contact_is_within_a_tick_of_the_plan(blocked):
    contact, *_ = events(blocked, "contact")  # the other arm may be touched as the ball goes on
    assert abs(contact["late_s"]) <= TICK_S
    assert contact["part"].endswith(("hand", "forearm"))


def test_the_clip_runs_on_from_a_sixth_of_a_second_after_perception(blocked):
    (perceived,) = events(blocked, "perceived")
    ends = next(event for event in blocked.world.events if event.kind == "phase" and event.data["name"] == "play")
    at_perception = 0.5 + TICK_S + perceived["tick"] * TICK_S
    # the return pose is reached at the tick before the clip runs again
    then = clip_time_s(blocked.world, 0, ends.tick - 1)
    assert then == pytest.approx(at_perception + 1 / 6, abs=1e-9)


def test_planted_feet_stay_and_seams_are_smooth(blocked):
    track = track_of(blocked)
    assert foot_slide_max_m(track) < 0.002
    jump_m, jump_mps = seam_jumps(track)
    assert jump_m < 0.0005
    assert jump_mps < 0.05
    assert len(track.seams) >= 5


def test_nothing_jumps_between_ticks(blocked):
    """A kink of a joint's path bigger than any muscle: the second difference, the tick of the blow left out."""
    track = track_of(blocked)
    joints = joints_of(track.body, track.pose)[0]
    kinks = np.linalg.norm(np.diff(joints, 2, axis=0), axis=2).max(axis=1)
    under_physics = np.isin(track.phase, (Phase.RESPOND, Phase.RECOVER_BLEND))
    allowed = ~(under_physics[2:] | under_physics[1:-1] | under_physics[:-2])
    assert kinks[allowed].max() < 400.0 * TICK_S**2  # 40 g


def test_without_startle_protection_begins_at_once():
    simulation = simulation_of([AHEAD], startle=False)
    for _ in range(30):
        simulation.step()
    assert phases(simulation) == ["play", "protect"]
    assert events(simulation, "perceived")[0]["startle"] == "off"


def test_too_late_for_a_startle():
    simulation = simulation_of([AHEAD | {"ttc_s": 0.2}], startle=True)
    for _ in range(40):
        simulation.step()
    assert events(simulation, "perceived")[0]["startle"] == "too late"
    assert "startle" not in phases(simulation)


def test_struck_unprepared(unseen, blocked):
    assert phases(unseen)[:2] == ["play", "respond"]
    assert not events(unseen, "perceived")
    assert unseen.report()["metrics"]["first_contact"] == "head"
    # what protection is for
    assert blocked.report()["metrics"]["head_peak_g"] < 0.6 * unseen.report()["metrics"]["head_peak_g"]


def test_no_contact_is_held_for_a_third_of_a_second(missed):
    assert phases(missed) == ["play", "protect", "hold", "recover_return", "play"]
    lasts = {row["name"]: row["to_s"] - row["from_s"] for row in missed.report()["phases"]}
    assert lasts["hold"] == pytest.approx(1 / 3, abs=TICK_S)
    assert not events(missed, "contact")


def test_a_second_ball_while_recovering_is_met_too():
    later = AHEAD | {"azimuth_deg": -20.0, "perceived_s": 1.35}
    simulation = run([AHEAD, later], startle=False, duration_s=3.5)
    assert [event["tick"] * TICK_S for event in events(simulation, "perceived")] == pytest.approx([0.2, 1.35], abs=0.02)
    assert len({event["ball"] for event in events(simulation, "contact")}) == 2
    assert phases(simulation)[-1] == "play"
    jump_m, jump_mps = seam_jumps(track_of(simulation))
    assert jump_m < 0.0005
    assert jump_mps < 0.1


@pytest.mark.parametrize("later_s", [0.1, 0.6, 0.9])
def test_a_second_ball_that_is_seen_while_busy_with_the_first_is_met_as_soon_as_that_is_over(later_s):
    """It is noticed while the first is still awaited, met, or recovered from: kept in mind, not forgotten."""
    second = AHEAD | {"azimuth_deg": -20.0, "perceived_s": 0.2 + later_s, "ttc_s": 1.2}
    simulation = run([AHEAD, second], startle=False, duration_s=3.5)
    until_s = next(row["to_s"] for row in simulation.report()["phases"] if row["name"] == "recover_blend")
    first, taken_up = (event["tick"] * TICK_S for event in events(simulation, "perceived"))
    assert first == pytest.approx(0.2, abs=0.02)
    assert taken_up == pytest.approx(until_s, abs=2 * TICK_S)
    contacts = events(simulation, "contact")
    met = [event for event in contacts if event["ball"] != contacts[0]["ball"]]
    assert met[0]["part"].endswith(("hand", "forearm"))
    assert phases(simulation)[-1] == "play"
    jump_m, jump_mps = seam_jumps(track_of(simulation))
    assert jump_m < 0.0005
    assert jump_mps < 0.1


def test_a_guard_that_is_up_is_not_dropped_for_a_startle():
    second = AHEAD | {"azimuth_deg": -20.0, "perceived_s": 1.3}
    simulation = run([AHEAD, second], startle=True, duration_s=2.0)
    assert [event["startle"] for event in events(simulation, "perceived")] == ["taken", "on guard"]
    assert phases(simulation).count("startle") == 1


def test_a_movement_that_begins_too_late_is_cut_short_not_hurried():
    simulation = run([AHEAD | {"ttc_s": 0.06}], duration_s=1.0)
    assert "protect" in phases(simulation)
    joints = joints_of(track_of(simulation).body, track_of(simulation).pose)[0]
    protecting = np.isin(track_of(simulation).phase, (Phase.PROTECT,))[1:]
    speeds = np.linalg.norm(np.diff(joints, axis=0), axis=2)[protecting] / TICK_S
    assert speeds.max() < 12.0  # m/s, of a hand; at full tilt a throw has twice that


def test_a_heavy_blow_knocks_down_and_the_body_comes_to_rest():
    blow = AHEAD | {"kind": "custom", "mass_kg": 12.0, "radius_m": 0.2, "azimuth_deg": 0.0}
    simulation = run([blow], duration_s=4.0)
    assert "down" in phases(simulation)
    track = track_of(simulation)
    last, before = track.pose.root_m[-1], track.pose.root_m[-13]
    assert last[2] < 0.35  # lies
    assert np.linalg.norm(last - before) < 0.005  # and keeps still
    assert np.isfinite(track.pose.rotations).all()


def test_the_forearms_of_who_lies_do_not_stand_on_their_elbows():
    blow = AHEAD | {"kind": "custom", "mass_kg": 14.0, "radius_m": 0.2, "azimuth_deg": 40.0}
    track = track_of(run([blow], duration_s=4.0))
    wrists_m = joints_of(track.body, track.pose)[0][-1, list(WRISTS)]
    assert (wrists_m[:, 2] < 0.1).all()  # a forearm is 25 cm


def test_a_character_whose_state_is_no_number_stops_where_it_was_and_says_so():
    simulation = simulation_of([AHEAD], startle=False)
    for _ in range(60):
        simulation.step()
    world, last = simulation.world, track_of(simulation).pose.root_m[-1]
    world[Blend].to_root_m[0, 2] = np.nan
    for _ in range(30):
        simulation.step()
    (stopped,) = events(simulation, "stopped")
    assert (stopped["component"], stopped["field"], stopped["tick"]) == ("Blend", "to_root_m", 60)
    np.testing.assert_array_equal(track_of(simulation).pose.root_m[-1], last)
    assert simulation.report()["metrics"]["stopped"] == 1
