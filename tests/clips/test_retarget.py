"""A motion on another body: the same motion there, on the same floor, its standing feet standing still."""

from __future__ import annotations

import numpy as np
import pytest

from engine.body.anthropometry import standard_body
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, HIPS, KNEES, PELVIS, TOES, Pose
from engine.body.support import sole_points
from engine.clips.clip import Clip
from engine.clips.contacts import runs
from engine.clips.mirror import mirror_clip
from engine.clips.retarget import CROUCHING, legs_m, retarget_clip, same_body
from engine.clips.synthetic import sway
from engine.maths import rotations

CLIPS = ("walk", "run", "dance", "hop", "kneel", "sway", "getup_faceup")
SIZES_M = (1.55, 1.95)


def soles_of(clip: Clip) -> np.ndarray:
    """(F, 2, 6, 3) the sole points in the world."""
    at, turned = joints_of(clip.body, clip.pose)
    return np.array([sole_points(clip.body, at[f], turned[f]) for f in range(clip.frames)])


def on_feet(clip: Clip) -> np.ndarray:
    """(F, 2) where a foot, and not its knee, carries the body."""
    at, _ = joints_of(clip.body, clip.pose)
    return at[:, list(KNEES), 2] > CROUCHING * legs_m(clip.body)


def slide_m(clip: Clip, counted: np.ndarray) -> float:
    """The farthest that a ball of a planted foot goes from where it stood, along the ground, in the frames counted."""
    at, _ = joints_of(clip.body, clip.pose)
    worst = 0.0
    for side, toe in enumerate(TOES):
        for first, last in runs(clip.planted[:, side] & counted[:, side]):
            there = at[first : last + 1, toe, :2]
            worst = max(worst, float(np.linalg.norm(there - there[0], axis=1).max()))
    return worst


def test_on_its_own_body_a_clip_is_itself():
    clip = sway()
    assert retarget_clip(clip, clip.body) is clip
    assert retarget_clip(clip, sway().body) is clip


@pytest.mark.parametrize("height_m", SIZES_M)
@pytest.mark.parametrize("name", CLIPS)
def test_feet_keep_to_the_floor_and_stand_as_still_as_before(library_clip, name, height_m):
    clip = library_clip(name)
    moved = retarget_clip(clip, standard_body(height_m))
    scale = legs_m(moved.body) / legs_m(clip.body)
    before, after = soles_of(clip)[..., 2].min(axis=-1), soles_of(moved)[..., 2].min(axis=-1)
    counted = on_feet(clip)
    # a leg folded as far as a knee goes, rocking up from the back, may be a little long
    np.testing.assert_allclose(after[counted], scale * before[counted], atol=2e-3 if name == "getup_faceup" else 1e-6)
    assert slide_m(moved, counted) <= scale * slide_m(clip, counted) + 1e-6
    # and whoever kneels or lies is on the floor too
    at, at_before = (joints_of(c.body, c.pose)[0][..., 2].min(axis=1) for c in (moved, clip))
    assert np.minimum(after.min(axis=1), at).min() > scale * np.minimum(before.min(axis=1), at_before).min() - 0.03


@pytest.mark.parametrize("name", CLIPS)
def test_only_legs_are_turned_and_little(library_clip, name):
    """What is not a leg keeps its rotation to the bit; the feet keep theirs in the world; legs give a little."""
    clip = library_clip(name)
    moved = retarget_clip(clip, standard_body(1.6))
    rest = [j for j in range(21) if j < HIPS[0]]
    np.testing.assert_array_equal(moved.pose.rotations[:, rest], clip.pose.rotations[:, rest])
    _, before = joints_of(clip.body, clip.pose)
    _, after = joints_of(moved.body, moved.pose)
    feet = list(ANKLES + TOES)
    assert rotations.angle_between(before[:, feet], after[:, feet]).max() < 1e-6
    legs = [*HIPS, *(j + 1 for j in HIPS)]
    assert np.percentile(rotations.angle_between(before[:, legs], after[:, legs]), 95) < np.radians(12.0)


def test_there_and_back_is_the_same_motion(library_clip):
    """Only the reach of legs that are straight on the way may cost something."""
    clip = library_clip("walk")
    back = retarget_clip(retarget_clip(clip, standard_body(1.9)), clip.body)
    assert same_body(back.body, clip.body)
    was, is_now = joints_of(clip.body, clip.pose)[0], joints_of(back.body, back.pose)[0]
    assert np.linalg.norm(was - is_now, axis=-1).max() < 0.05
    assert np.median(np.linalg.norm(was - is_now, axis=-1)) < 0.002
    assert back.loop.x_m == pytest.approx(clip.loop.x_m, abs=1e-12)


def test_strides_scale_with_the_legs(library_clip):
    clip = library_clip("walk")
    moved = retarget_clip(clip, standard_body(1.5))
    scale = legs_m(moved.body) / legs_m(clip.body)
    went, goes = (c.pose.root_m[-1, 0] - c.pose.root_m[0, 0] for c in (clip, moved))
    assert goes == pytest.approx(scale * went, rel=0.01)
    assert moved.loop.x_m == pytest.approx(scale * clip.loop.x_m, rel=1e-12)
    assert moved.key != clip.key


def test_a_mirrored_motion_goes_onto_a_mirrored_body_as_mirrored():
    clip = sway()
    body = standard_body(1.6, sex="female")
    one = mirror_clip(retarget_clip(clip, body))
    other = retarget_clip(mirror_clip(clip), mirror_clip(retarget_clip(clip, body)).body)
    np.testing.assert_allclose(one.pose.root_m, other.pose.root_m, atol=1e-9)
    at, too = (joints_of(c.body, Pose(c.pose.root_m, c.pose.rotations))[0] for c in (one, other))
    np.testing.assert_allclose(at, too, atol=1e-9)


def test_a_straight_leg_stays_straight_and_a_lying_body_stays_down(library_clip):
    clip = library_clip("getup_faceup")
    moved = retarget_clip(clip, standard_body(1.9))
    at, _ = joints_of(moved.body, moved.pose)
    assert at[0, PELVIS, 2] < 0.25
    assert at[-1, PELVIS, 2] > 0.85
