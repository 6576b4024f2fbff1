"""Footage is the run: every frame what the world had at its tick."""

import numpy as np

from behaviours.components import Flight, Posture, Reaction
from demos.exporting.footage import PHASE_NAMES, film
from engine.maths import rotations
from tests.exporting.conftest import run


def test_every_frame_is_the_world_at_its_tick(footage):
    simulation = run()
    for frame in range(len(footage.time_s)):
        while simulation.world.tick < frame * 4:  # 120 ticks, 30 frames a second
            simulation.step()
        for row, person in enumerate(footage.people):
            assert np.array_equal(person.pose.root_m[frame], simulation.world[Posture].root_m[row])
            turned = simulation.world[Posture].rotations[row]
            assert rotations.angle_between(person.pose.rotations[frame], turned).max() < 1e-7
            assert person.phase[frame] == simulation.world[Reaction].phase[row]
        rows = simulation.world.rows(Flight)
        assert [bool(ball.seen[frame]) for ball in footage.balls] == [True] * len(rows) + [False] * (1 - len(rows))
        for row, ball in zip(rows, footage.balls, strict=False):
            assert np.array_equal(ball.position_m[frame], simulation.world[Flight].position_m[row])


def test_what_happened_is_marked(footage):
    kinds = [kind for _, kind in footage.marks]
    assert kinds[:2] == ["perceived", "contact"]
    assert set(kinds[2:]) <= {"contact"}  # a ball may come off one hand and meet the other
    assert footage.time_s[-1] == 1.4
    assert PHASE_NAMES[footage.people[0].phase[0]] == "play"
    assert {PHASE_NAMES[phase] for phase in footage.people[0].phase} >= {"play", "protect", "respond"}
    assert {PHASE_NAMES[phase] for phase in footage.people[1].phase} == {"play"}


def test_frames_between_ticks_lie_between_them():
    """At 50 a second most frames fall between two ticks: a ball in free flight is then on the chord of its path."""
    taken = film(run(), 50.0, "fast")
    ball = taken.balls[0]
    flying = np.flatnonzero(ball.seen & (taken.time_s < 0.6))
    steps_m = np.linalg.norm(np.diff(ball.position_m[flying], axis=0), axis=1)
    assert len(steps_m) >= 8
    assert np.ptp(steps_m) < 0.01 * steps_m.mean()  # gravity changes its speed a little, frames not at all


def test_a_ball_not_there_yet_waits_where_it_will_be(footage):
    ball = footage.balls[0]
    first = int(np.argmax(ball.seen))
    assert first == 13  # thrown in the tick that begins at 0.4 s
    assert np.array_equal(ball.position_m[0], ball.position_m[first])
    assert np.allclose(np.linalg.norm(ball.turned, axis=1), 1.0)
