"""A simulation as a machine: the same bits again, from any snapshot, under any grouping; every system true to its
word.
"""

from __future__ import annotations

import math

import numba
import numpy as np
import pytest

from behaviours.components import Blow, Flight, Phase, Posture, Reaction, Threat
from behaviours.playing import joint_frames
from behaviours.scenario import check_scenario
from behaviours.simulation import Simulation, apply_command
from engine.clips.library import find_clip
from engine.clips.mirror import mirror_clip
from engine.core.errors import BadInput
from engine.core.journal_file import load_journal, save_journal
from engine.core.recorder import Recorder, new_journal, replay
from engine.core.timeline import Timeline
from tests.behaviours.runs import (
    AHEAD,
    events,
    joints_until_contact,
    mirrored_back,
    phases,
    run,
    simulation_of,
    track_of,
)

FREE = {"free": True, "position_m": [8.0, -1.0, 1.6], "speed_mps": 16.0, "target": "head", "released_s": 0.1}


def digests(simulation, ticks: int) -> list[str]:
    found = []
    for _ in range(ticks):
        simulation.step()
        found.append(simulation.world.digest())
    return found


@pytest.fixture(scope="module")
def busy():
    """Digest of every tick of a run with a scripted and a free ball, and snapshots on the way."""
    simulation = simulation_of([AHEAD, FREE], observe=False)
    taken, found = {}, []
    for tick in range(simulation.ticks):
        if tick % 37 == 5 or simulation.world[Blow].ball[0] >= 0:
            taken[tick] = simulation.world.snapshot()
        simulation.step()
        found.append(simulation.world.digest())
    return simulation, taken, found


def test_every_system_reads_and_writes_what_it_declares():
    simulation = run(
        [AHEAD, FREE, AHEAD | {"perceived_s": 1.4, "azimuth_deg": -100.0}], duration_s=3.0, checked=True, observe=False
    )
    assert len([e for e in simulation.world.events if e.kind == "contact"]) >= 2


def test_the_same_run_twice_also_under_another_thread_count(busy):
    simulation, _, found = busy
    before = numba.get_num_threads()
    numba.set_num_threads(1)
    try:
        again = digests(simulation_of([AHEAD, FREE], observe=False), simulation.ticks)
    finally:
        numba.set_num_threads(before)
    assert again == found


def test_from_any_snapshot_it_goes_on_the_same(busy):
    _simulation, taken, found = busy
    assert any(s for s in taken), "no snapshot"
    other = simulation_of([AHEAD, FREE], observe=False)
    for tick, snapshot in taken.items():
        other.world.restore(snapshot)
        assert digests(other, 12) == found[tick : tick + 12], f"from tick {tick}"


def test_observing_changes_nothing(busy):
    _simulation, _, found = busy
    assert digests(simulation_of([AHEAD, FREE], observe=True), 200) == found[:200]


def test_a_recording_plays_back_and_is_checked(tmp_path):
    simulation = simulation_of(duration_s=1.5, observe=False)
    recorder = Recorder(simulation.world, simulation.step, apply_command, new_journal({}, simulation.world))
    for tick in range(120):
        if tick == 20:
            recorder.command({"do": "throw", "position_m": [6.0, 0.5, 1.7], "velocity_mps": [-14.0, -1.0, 1.5]})
        recorder.advance()
    save_journal(recorder.journal, tmp_path / "run.brace")
    fresh = simulation_of(duration_s=1.5, observe=False)
    again = replay(fresh.world, fresh.step, apply_command, load_journal(tmp_path / "run.brace"))
    while not again.at_end:
        again.advance()  # compares every tick; ReplayDiverged if one differs
    assert fresh.world.digest() == simulation.world.digest()
    assert any(event.kind == "contact" for event in fresh.world.events)


def test_rewinding_into_the_blow_and_on_again(busy):
    _, _, found = busy
    simulation = simulation_of([AHEAD, FREE], observe=False)
    world = simulation.world
    timeline = Timeline(world, simulation.step, apply_command, new_journal({}, world))
    for _ in range(160):
        timeline.advance()
    contact = next(event.tick for event in simulation.world.events if event.kind == "contact")
    for tick in (contact + 1, 31, contact + 2, 160):
        timeline.seek(tick)
        assert simulation.world.tick == tick
        assert simulation.world.digest() == found[tick - 1]


def test_unknown_commands_are_refused():
    simulation = simulation_of(observe=False)
    with pytest.raises(BadInput, match="expected 'throw'"):
        apply_command(simulation.world, {"do": "juggle"})


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"velocity_mps": None}, "velocity_mps"),
        ({"position_m": (np.nan, 0.0, 1.0)}, "position_m"),
        ({"velocity": (1.0, 0.0, 0.0)}, "unknown key 'throw.velocity'; expected one of velocity_mps"),
        ({"kind": "anvil"}, "unknown kind 'anvil'"),
        ({"at": 1}, "at character 1: there are 1, counted from 0"),
        ({"do": "threaten"}, "expected a table of keys"),
        ({"do": "threaten", "threat": {"speed_mps": -3.0}}, "threat.speed_mps"),
        ({"do": "threaten", "threat": {"at_character": 2}}, "at character 2"),
        ({"at": -1}, "greater than or equal to 0"),
    ],
)
def test_a_throw_that_no_ball_can_fly_is_refused(changes, message):
    simulation = simulation_of(observe=False)
    command = {"do": "throw", "position_m": (4.0, 0.0, 1.6), "velocity_mps": (-9.0, 0.0, 0.0)}
    command = {key: value for key, value in {**command, **changes}.items() if value is not None}
    before = simulation.world.digest()
    with pytest.raises(BadInput) as refused:
        apply_command(simulation.world, command)
    assert message in refused.value.message
    assert simulation.world.digest() == before


def test_places_of_a_throw_may_be_arrays():
    one, other = (simulation_of(observe=False).world for _ in range(2))
    place, velocity = (4.0, 0.5, 1.75), (-9.0, 0.25, 0.5)
    apply_command(one, {"do": "throw", "position_m": place, "velocity_mps": velocity, "mass_kg": 0.5})
    arrays = {"position_m": np.array(place, np.float32), "velocity_mps": np.array(velocity)}
    apply_command(other, {"do": "throw", "mass_kg": 0.5, **arrays})
    assert one.digest() == other.digest()
    (ball,) = one.rows(Flight)
    assert one[Flight].mass_kg[ball] == 0.5


@pytest.mark.parametrize("azimuth", [25.0, 80.0, 150.0])
@pytest.mark.parametrize("name", ["sway", "walk"])
def test_a_mirrored_threat_at_a_mirrored_clip_gives_the_mirrored_run(name, azimuth, library_clip):
    clip = library_clip(name)
    threat = AHEAD | {"azimuth_deg": azimuth, "size": 0.4}
    left = run([threat], clip=clip, duration_s=1.6)
    right = run([threat | {"azimuth_deg": -azimuth}], clip=mirror_clip(clip), duration_s=1.6)
    ours, theirs = joints_until_contact(track_of(left)), joints_until_contact(track_of(right))
    assert phases(left) == phases(right)
    assert "respond" in phases(left)
    np.testing.assert_allclose(ours, mirrored_back(theirs), atol=1e-6)
    assert np.ptp(ours, axis=0).max() > 0.2  # something happened


def test_ball_and_body_exchange_momentum_and_nothing_else():
    """Over the blow: what the ball loses, gravity and friction apart, goes with the impulse that was reported."""
    simulation = simulation_of([AHEAD], startle=False)
    before = None
    for _ in range(30):
        simulation.step()
    while not events(simulation, "contact"):
        before = simulation.world[Flight].velocity_mps[simulation.world.rows(Flight)[0]].copy()
        simulation.step()
    (contact,) = events(simulation, "contact")
    while simulation.world[Blow].ball[0] >= 0:
        simulation.step()
    ball = simulation.world.rows(Flight)[0]
    after, mass = simulation.world[Flight].velocity_mps[ball], simulation.world[Flight].mass_kg[ball]
    assert np.linalg.norm(after - before) * mass == pytest.approx(contact["impulse_Ns"], rel=0.05)
    assert np.linalg.norm(after) < np.linalg.norm(before)


def test_balls_that_lie_still_are_taken_away():
    ball = {"free": True, "position_m": [3.0, 4.0, 0.105], "velocity_mps": [0.0, 0.0, 0.0], "released_s": 0.0}
    simulation = simulation_of([ball], duration_s=7.0, observe=False)
    for _ in range(120):
        simulation.step()
    assert len(simulation.world.rows(Flight)) == 1
    for _ in range(700):
        simulation.step()
    assert len(simulation.world.rows(Flight)) == 0


def test_a_ball_that_passes_close_startles_and_no_more():
    ball = {"free": True, "position_m": [9.0, 0.55, 1.75], "velocity_mps": [-16.0, 0.0, 2.4], "released_s": 0.1}
    simulation = run([ball], startle=True, duration_s=2.5)
    assert phases(simulation) == ["play", "startle", "recover_return", "play"]
    assert events(simulation, "flinched")
    assert not events(simulation, "perceived")
    calm = run([ball], startle=False, duration_s=1.5)
    assert phases(calm) == ["play"]


def test_a_ball_far_aside_is_no_matter():
    ball = {"free": True, "position_m": [9.0, 2.5, 1.75], "velocity_mps": [-16.0, 0.0, 2.4], "released_s": 0.1}
    assert phases(run([ball], duration_s=1.5)) == ["play"]


def test_a_free_ball_that_will_hit_is_met():
    simulation = run([FREE], duration_s=2.5)
    assert "protect" in phases(simulation)
    assert events(simulation, "contact")
    assert events(simulation, "contact")[0]["part"].endswith(("hand", "forearm"))


def test_contact_s_is_when_it_arrives():
    simulation = run([{k: v for k, v in AHEAD.items() if k != "perceived_s"} | {"contact_s": 1.2}], duration_s=2.0)
    (perceived,) = events(simulation, "perceived")
    # one tick is not yet whole when it is perceived
    assert perceived["tick"] / 120 + perceived["ttc_s"] == pytest.approx(1.2, abs=1.5 / 120)
    assert events(simulation, "contact")[0]["at_s"] == pytest.approx(1.2, abs=0.05)


def test_angle_free_starts_early_moves_no_slower_and_fills_the_pause():
    threat = AHEAD | {"azimuth_deg": 85.0, "speed_mps": 28.0}
    usual = run([threat], startle=False, duration_s=1.2)
    free = run([threat], startle=False, duration_s=1.2, settings={"timing": {"angle_free": True}})
    struck = events(free, "contact")[0]["tick"]
    ours, theirs = track_of(free).pose.rotations, track_of(usual).pose.rotations

    def motion(rotations):
        return 1.0 - np.abs((rotations[1:] * rotations[:-1]).sum(axis=-1)).min(axis=1)

    early = slice(24, 24 + 20)
    assert motion(ours)[early].mean() > motion(theirs)[early].mean()  # the faster movement
    pause = motion(ours)[struck - 8 : struck - 2]
    assert (pause > 1e-9).all()  # and no freeze at its end


def test_two_people_and_two_balls_mind_their_own():
    from behaviours.scenario import check_scenario
    from behaviours.simulation import Simulation

    scenario = check_scenario({
        "duration_s": 1.8,
        "character": [{"clip": "sway"}, {"clip": "sway", "position_m": [0.0, 6.0], "heading_deg": 90.0}],
        "threat": [AHEAD, AHEAD | {"at_character": 1, "azimuth_deg": -30.0}],
    })  # fmt: skip
    simulation = Simulation(scenario, lambda spec: find_clip(spec.clip), observe=True)
    for _ in range(simulation.ticks):
        simulation.step()
    contacts = [event for event in simulation.world.events if event.kind == "contact"]
    # a ball may go from one hand to the other, but to nobody else
    met = {(event.entity, event.data["ball"]) for event in contacts}
    assert sorted(who for who, _ in met) == [simulation.world.entity(row) for row in (0, 1)]
    assert math.dist(
        simulation.observer.tracks[0].root_m[-1], simulation.observer.tracks[1].root_m[-1]
    ) == pytest.approx(6, abs=0.6)
    assert Phase(int(simulation.world[Reaction].phase[0])).name
    assert simulation.world[Threat].spent[simulation.world.rows(Threat)].all()


def test_without_more_a_character_gets_the_clip_and_the_mass_that_it_says():
    simulation = Simulation(check_scenario({"character": [{"clip": "sway", "mass_kg": 93.0}]}))
    (body,) = simulation.world.assets.bodies
    assert body.part_mass_kg.sum() == pytest.approx(93.0)
    joints_m, turned = joint_frames(simulation.world, 0)
    assert np.array_equal(joints_m[0], simulation.world[Posture].root_m[0])
    assert np.allclose(np.linalg.norm(turned, axis=1), 1.0, atol=1e-12)
