"""What an Observer keeps of a run: every tick, both sides of every seam, every blend's lines, the clip's own poses."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.components import NOBODY, Phase, Playback
from behaviours.measure.measures import jump_of
from behaviours.measure.observing import BLENDED, HandWay
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import WRISTS
from engine.clips.library import find_clip
from engine.clips.playback import sample
from tests.behaviours.runs import AHEAD, phases, simulation_of, track_of


def test_it_keeps_every_tick(blocked):
    track = track_of(blocked)
    assert track.tick == list(range(blocked.ticks))
    for kept in (track.phase, track.root_m, track.rotations, track.planted, track.stands, track.played, track.clip):
        assert len(kept) == blocked.ticks
    assert track.pose.rotations.shape == (blocked.ticks, 21, 4)


def test_there_is_a_seam_at_every_change_of_phase_and_nowhere_else(blocked):
    track = track_of(blocked)
    changes = [k for k in range(1, len(track.phase)) if track.phase[k] != track.phase[k - 1]]
    assert [seam.tick for seam in track.seams] == changes
    assert [seam.into.name.lower() for seam in track.seams] == phases(blocked)[1:]


def test_a_seam_s_sides_are_what_was_shown_and_how_it_moves_on(blocked):
    track = track_of(blocked)
    at = joints_of(track.body, track.pose)[0]
    for seam in track.seams:
        if seam.into == Phase.RESPOND:
            continue  # this one lies at the end of its tick
        np.testing.assert_array_equal(seam.shown_m, at[seam.tick - 1])
        # the mean velocity of the next tick is near the one at its begin
        np.testing.assert_allclose(seam.after_mps, (at[seam.tick] - at[seam.tick - 1]) * 120, atol=0.6)
        np.testing.assert_allclose(seam.before_mps, (at[seam.tick - 1] - at[seam.tick - 2]) * 120, atol=0.6)


def test_the_physics_begins_where_the_body_is_shown(blocked):
    (blow,) = [seam for seam in track_of(blocked).seams if seam.into == Phase.RESPOND]
    place, speed = jump_of(blow)
    assert place.value < 1e-9
    assert speed.value == 0.0  # the impulse's is no seam


def test_a_blow_that_begins_elsewhere_would_be_seen():
    simulation = simulation_of([AHEAD], startle=False)
    world = simulation.world
    from behaviours.components import Ragdoll, Reaction

    while world[Reaction].phase[0] != Phase.RESPOND:
        simulation.schedule.tick(world)
        if world[Reaction].phase[0] == Phase.RESPOND:
            world[Ragdoll].state[0, 1] += 0.01  # the pelvis, a centimetre aside
            world[Ragdoll].before[0, 1] += 0.01
        simulation.observer.look(world)
    place, _ = jump_of(track_of(simulation).seams[-1])
    assert place.value == pytest.approx(0.01, abs=1e-6)


def test_the_clip_s_own_poses_are_those_of_the_clip(blocked):
    track, clip = track_of(blocked), find_clip("sway")
    playing = [k for k, phase in enumerate(track.phase) if phase == Phase.PLAY]
    assert [k for k, pose in enumerate(track.played) if pose is not None] == playing
    for k in playing[:5]:
        pose = sample(clip, 0.5 + (k + 1) / 120)
        np.testing.assert_allclose(track.played[k].rotations[1:], pose.rotations[1:], atol=1e-12)
    # from perception to a sixth of a second later, at the begin of every phase
    others = sum(seam.into != Phase.PLAY for seam in track.seams)
    assert len(track.made_from) == 21 * others
    assert len(track.own.root_m) == len(track.made_from) + len(playing)


def test_lines_are_told_in_blends_between_still_ends_alone(blocked, missed):
    for run in (blocked, missed):
        track = track_of(run)
        told = {line.tick for line in track.lines}
        assert told == {tick for tick, phase in zip(track.tick, track.phase, strict=True) if phase in BLENDED}


def test_a_line_s_ends_are_where_the_blend_begins_and_ends(missed):
    """Nothing came: the whole way from the clip to the sustained pose, and what holds it, is one blend."""
    track = track_of(missed)
    protect = [line for line in track.lines if track.phase[line.tick] == Phase.PROTECT]
    first = protect[0]
    shown = joints_of(track.body, track.pose)[0]
    np.testing.assert_allclose(first.start_m, shown[first.tick - 1], atol=1e-9)
    before = track.pose.root_m[first.tick - 1], track.pose.rotations[first.tick - 1]
    np.testing.assert_allclose(first.com_ends_m[0], com_of(track.body, type(track.pose)(*before)), atol=1e-9)
    for line in protect:
        np.testing.assert_array_equal(line.end_m, first.end_m)
        assert all(way in HandWay for way in line.ways)
    # it gets there, but for what is left of the overshoot
    last = [line for line in track.lines if track.phase[line.tick] == Phase.HOLD][-1]
    np.testing.assert_allclose(last.between_m[list(WRISTS)], first.end_m[list(WRISTS)], atol=0.06)


def test_looking_at_nobody_s_world_is_no_trouble():
    simulation = simulation_of([], duration_s=0.1)
    for _ in range(simulation.ticks):
        simulation.step()
    track = track_of(simulation)
    assert not track.seams
    assert not track.lines
    assert simulation.world[Playback].clip[0] != NOBODY
