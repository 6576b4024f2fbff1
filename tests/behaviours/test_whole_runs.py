"""Whole runs as a machine: the same bits for any frame rate, any number of threads, and after going back; also through
a fall, and on motion capture as it comes from the files beside a checkout.
"""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
import pytest

from behaviours.components import Phase, Reaction
from behaviours.measure.measures import seam_jumps
from behaviours.simulation import apply_command
from demos.frames import frames_of
from engine.clips.library import find_clip
from engine.core.clock import TICK_RATE_HZ, Clock
from engine.core.recorder import new_journal
from engine.core.timeline import Timeline
from tests.behaviours.knocked import HEAVY
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
from tests.conftest import ROOT

FALL = {**HEAVY, "elevation_deg": 10.0, "azimuth_deg": 150.0, "perceived_s": 0.1, "ttc_s": 0.4}
TICKS = 150


def fresh(threat=AHEAD, **more):
    return simulation_of([threat], observe=False, **more)


@pytest.fixture(scope="module")
def digests():
    """Of every tick of a reaction from perception to recovery."""
    simulation, found = fresh(), []
    for _ in range(TICKS):
        simulation.step()
        found.append(simulation.world.digest())
    assert simulation.world[Reaction].struck[0]
    return found


@pytest.mark.parametrize("fps", [7.0, 24.0, 30.0, 59.94, 144.0])
def test_films_at_any_frame_rate_show_the_same_run(fps, digests):
    simulation = fresh()
    for alpha in frames_of(simulation.world, simulation.step, TICKS, fps):
        assert 0.0 <= alpha <= 1.0
        tick = simulation.world.tick
        assert tick == 0 or simulation.world.digest() == digests[tick - 1]
    assert simulation.world.tick > TICKS - TICK_RATE_HZ / fps - 1


@pytest.mark.parametrize("seed", range(3))
def test_frames_of_any_length_group_the_same_ticks(seed, digests):
    """The outer loop as a window runs it: frames take what they take, some of them very long."""
    chance, clock, simulation = np.random.default_rng(seed), Clock(), fresh()
    while simulation.world.tick < TICKS:
        passed_s = float(chance.choice([0.001, 0.008, 0.017, 0.033, 0.12, 0.4]))
        due = clock.ticks_due(passed_s)
        assert due <= 31  # at most a quarter of a second is caught up on
        for _ in range(min(due, TICKS - simulation.world.tick)):
            simulation.step()
        if simulation.world.tick:
            assert simulation.world.digest() == digests[simulation.world.tick - 1]


def test_looking_between_ticks_changes_nothing(digests):
    from demos.filming import moment

    simulation = fresh()
    for tick in range(60):
        simulation.step()
        if tick % 7 == 3:
            for alpha in (0.0, 0.3, 1.0):
                moment(simulation.world, alpha, ghosts=("clip", "rules", "sustained"))
    assert simulation.world.digest() == digests[59]


def test_any_number_of_threads_gives_the_same_bits(digests):
    """In processes of their own: Numba fixes its threads when it starts."""
    code = (
        "from tests.behaviours.test_whole_runs import TICKS, fresh\n"
        "simulation = fresh()\n"
        "for _ in range(TICKS): simulation.step()\n"
        "import numba\n"
        "print(numba.config.NUMBA_NUM_THREADS, simulation.world.digest())\n"
    )
    for threads in ("1", "2"):
        done = subprocess.run(
            [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True,
            env={**os.environ, "NUMBA_NUM_THREADS": threads, "PYTHONPATH": str(ROOT)},
        )  # fmt: skip
        assert done.stdout.split() == [threads, digests[-1]]


@pytest.fixture(scope="module")
def fallen():
    """Somebody knocked down: the digest of every tick."""
    simulation, found = fresh(FALL, duration_s=3.0), []
    for _ in range(simulation.ticks):
        simulation.step()
        found.append(simulation.world.digest())
    assert simulation.world[Reaction].phase[0] == Phase.DOWN
    return found


def test_stepping_back_through_a_fall_and_on_again(fallen):
    simulation = fresh(FALL, duration_s=3.0)
    timeline = Timeline(simulation.world, simulation.step, apply_command, new_journal({}, simulation.world))
    for _ in range(len(fallen)):
        timeline.advance()
    entered = {event.data["name"]: event.tick for event in simulation.world.events if event.kind == "phase"}
    # into the middle of every phase, back and forth, and tick by tick over the edge of each
    for name in ("down", "protect", "respond", "down"):
        timeline.seek(entered[name] + 4)
        assert simulation.world.digest() == fallen[entered[name] + 3]
        for _ in range(7):
            timeline.step_back()
            assert simulation.world.digest() == fallen[simulation.world.tick - 1]
        for _ in range(9):
            timeline.advance()
            assert simulation.world.digest() == fallen[simulation.world.tick - 1]
    timeline.seek(len(fallen))
    assert simulation.world.digest() == fallen[-1]


def test_a_ball_thrown_in_the_past_makes_another_future(fallen):
    simulation = fresh(FALL, duration_s=3.0)
    timeline = Timeline(simulation.world, simulation.step, apply_command, new_journal({}, simulation.world))
    for _ in range(200):
        timeline.advance()
    timeline.seek(30)
    timeline.command({"do": "throw", "position_m": [6.0, 2.0, 1.7], "velocity_mps": [-14.0, -4.0, 1.5]})
    for _ in range(60):
        timeline.advance()
    assert simulation.world.digest() != fallen[89]
    assert timeline.last_tick == 90


# a walk, a fight, a run to a stop, kicks, somebody who stands: file, second, azimuth
BESIDE = [
    ("asfamc/07_04.amc", 1.0, 40.0),
    ("asfamc/14_02.amc", 5.6, -20.0),
    ("asfamc/16_08.amc", 0.2, 70.0),
    ("asfamc/135_04.amc", 2.0, -120.0),
    ("bvh/13_26.bvh", 7.0, 10.0),
    ("asfamc/49_18.amc", 3.0, 30.0),
]


@pytest.mark.parametrize(("file", "start_s", "azimuth"), BESIDE)
def test_real_people_react_and_go_on(file, start_s, azimuth, shared_mocap):
    """The whole of fig. 4.1 on motion capture as the laboratory gives it away."""
    clip = find_clip(str(shared_mocap / file))
    threat = AHEAD | {"azimuth_deg": azimuth}
    simulation = run([threat], clip=clip, startle=True, duration_s=2.4, start_s=start_s)
    names = phases(simulation)
    assert names[:2] == ["play", "startle"]
    assert names[-1] == "play"
    assert {"protect", "respond", "recover_blend", "recover_return"} <= set(names)
    (contact, *_) = events(simulation, "contact")
    assert abs(contact["late_s"]) <= 1 / 120
    metrics = simulation.report()["metrics"]
    assert metrics["foot_slide_max_m"] < 0.002
    assert metrics["recovered_to"] == clip.name
    assert seam_jumps(track_of(simulation))[0] < 0.0005
    assert np.isfinite(track_of(simulation).pose.rotations).all()


def test_straight_knees_are_mirrored_to_the_last_digits_too(shared_mocap):
    """A straight leg's angle has half the digits of its length, and a seam's velocity shows every one of them."""
    clip = find_clip(str(shared_mocap / "asfamc" / "16_08.amc"))
    threat = {**AHEAD, "target": "pelvis", "elevation_deg": 10.691112481163444, "speed_mps": 25.042311465784135}
    threat |= {"size": 0.9999580864780446}

    def joints_m(side: float, mirrored: bool) -> np.ndarray:
        thrown = [threat | {"azimuth_deg": side * -36.21944153085971, "perceived_s": 0.15}]
        whole = run(thrown, clip=clip, startle=True, start_s=0.3311649982192084, mirrored=mirrored, duration_s=1.2)
        return joints_until_contact(track_of(whole))

    np.testing.assert_allclose(joints_m(1.0, False), mirrored_back(joints_m(-1.0, True)), rtol=0.0, atol=1e-6)


def test_one_who_stands_on_one_leg_in_the_files_stands_on_it_in_the_sustained_pose(shared_mocap):
    from behaviours.components import Feet

    clip = find_clip(str(shared_mocap / "asfamc" / "49_18.amc"))
    simulation = simulation_of([AHEAD], clip=clip, startle=False, start_s=3.0)
    while simulation.world[Reaction].phase[0] != Phase.PROTECT:
        simulation.step()
    assert simulation.world[Feet].mode[0, 0] != 0
    left = simulation.world[Feet].ankle_m[0, 0].copy()
    for _ in range(30):
        simulation.step()
    np.testing.assert_array_equal(simulation.world[Feet].ankle_m[0, 0], left)
