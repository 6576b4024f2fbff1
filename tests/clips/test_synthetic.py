"""`sway`, the clip that needs no file: a person who stands, shifts weight and breathes, on feet that never move."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.kinematics import com_of, joints_of
from engine.body.limits import excess_rad
from engine.body.skeleton import ANKLES, BACK, ELBOWS, HEAD, KNEES, PELVIS, SHOULDERS
from engine.body.support import margin_m, polygon_of, sole_points
from engine.clips.playback import planted_at, sample
from engine.clips.synthetic import PERIOD_S, sway
from engine.maths import rotations

TIMES_S = np.linspace(0.0, 2.2 * PERIOD_S, 700)


@pytest.fixture(scope="module")
def clip():
    return sway()


def test_the_soles_lie_on_the_floor_and_never_move(clip):
    first = None
    for time_s in TIMES_S:
        soles = sole_points(clip.body, *joints_of(clip.body, sample(clip, time_s)))
        first = soles if first is None else first
        np.testing.assert_allclose(soles, first, atol=1e-6)
        np.testing.assert_allclose(soles[..., 2], 0.0, atol=1e-6)
        assert planted_at(clip, time_s).all()


def test_weight_shifts_within_the_feet_and_the_chest_breathes(clip):
    com = com_of(clip.body, clip.pose)
    assert 0.04 < np.ptp(com[:, 1]) < 0.10
    places, turned = joints_of(clip.body, clip.pose)
    for k in range(0, clip.frames, 7):
        polygon = polygon_of(clip.body, places[k], turned[k], clip.planted[k])
        assert margin_m(polygon, com[k, :2]) > 0.02
    chest_pitch = np.degrees(rotations.to_rotation_vector(clip.pose.rotations[:, BACK])[:, 1])
    breaths = np.sum(np.diff(np.sign(chest_pitch - chest_pitch.mean())) != 0) / 2
    assert breaths == pytest.approx(2, abs=0.5)
    assert 0.8 < np.ptp(chest_pitch) < 2.0


def test_it_stands_upright_and_ahead_within_its_joints(clip):
    places, turned = joints_of(clip.body, clip.pose)
    np.testing.assert_allclose(clip.pose.root_m[0, :2], 0.0, atol=1e-12)
    assert float(rotations.heading(turned[0, PELVIS])) == pytest.approx(0.0, abs=1e-12)
    assert places[:, HEAD, 2].min() > 1.5
    gaze = rotations.rotate(turned[:, HEAD], np.array([1.0, 0.0, 0.0]))
    assert gaze[:, 0].min() > 0.98
    for k in range(0, clip.frames, 7):
        assert excess_rad(clip.body, clip.pose.rotations[k]).max() == 0.0
    bends = rotations.to_rotation_vector(clip.pose.rotations[:, [*ELBOWS, *KNEES]])[..., 1]
    assert bends[:, :2].max() < -0.1
    assert bends[:, 2:].min() > 0.05
    across = places[:, SHOULDERS[0]] - places[:, SHOULDERS[1]]
    assert across[:, 1].min() > 0.3


def test_it_goes_round_exactly(clip):
    for time_s in (0.5, 3.3, 7.9):
        once, again = sample(clip, time_s), sample(clip, time_s + 3 * PERIOD_S)
        np.testing.assert_allclose(again.root_m, once.root_m, atol=1e-9)
        np.testing.assert_allclose(again.rotations, once.rotations, atol=1e-9)


def test_it_is_the_same_every_time_and_another_for_another_body(clip):
    again = sway()
    assert again.key == clip.key
    assert again.pose.rotations.tobytes() == clip.pose.rotations.tobytes()
    woman = sway("female", 60.0)
    assert woman.key != clip.key
    assert woman.body.part_mass_kg.sum() == pytest.approx(60.0, rel=1e-3)
    places, _ = joints_of(woman.body, woman.pose)
    ankles = places[:, list(ANKLES)]
    np.testing.assert_allclose(ankles, np.broadcast_to(ankles[0], ankles.shape), atol=1e-9)
