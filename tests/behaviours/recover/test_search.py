"""The search for a motion to go on with: what it finds, against brute force, and what it does to a run."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest

from behaviours.components import SAMPLES, Phase, Recover
from behaviours.recover import motion_index
from behaviours.recover.motion_index import index_clips
from behaviours.recover.search import Window, best_window
from behaviours.recover.windows import difference
from behaviours.scenario import check_scenario
from behaviours.settings import Settings
from engine.body.kinematics import joints_of
from engine.body.skeleton import PARENT
from engine.clips.playback import planted_at
from engine.clips.retarget import retarget_clip
from engine.core.errors import BadInput, EnvironmentTrouble
from tests.behaviours.knocked import VOLLEYBALL, events, played, struck
from tests.conftest import ROOT

SEARCH = Settings().search
AHEAD_S = Settings().timing.sustained_ahead_s
HARD = {**VOLLEYBALL, "kind": "custom", "mass_kg": 2.0}  # seven volleyballs; nobody falls


@pytest.fixture(scope="module")
def clips(library_clip):
    """Three clips on the body of the first."""
    walk = library_clip("walk")
    return (walk, *(retarget_clip(library_clip(name), walk.body) for name in ("dance", "kneel", "sway")))


@pytest.fixture(scope="module")
def index(clips):
    return index_clips(clips, clips[0].body, AHEAD_S, SEARCH.least_left_s, SEARCH.velocity_s)


def window_at(index, row: int, yaw: float = 0.0, place=(0.0, 0.0), noise: float = 0.0, seed: int = 0) -> Window:
    """The index's own window there, somewhere else in the world, and disturbed (metres; m/s ten times that)."""
    rows, chance = row - np.arange(SAMPLES), np.random.default_rng(seed)
    c, s = math.cos(yaw), math.sin(yaw)
    turn = np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
    # the whole window is disturbed alike, as a body in another pose that moves otherwise
    off, off_mps = noise * chance.normal(size=index.joints_m.shape[1:]), 10 * noise * chance.normal(size=(21, 3))
    joints_m = index.joints_m[rows] @ turn + (*place, 0.0) + off
    return Window(np.ascontiguousarray(joints_m), np.ascontiguousarray(index.joints_mps[rows] @ turn + off_mps))


def find(index, window, kind="standing", **more):
    return best_window(index, window, kind, SEARCH.velocity_s, SEARCH.candidates, **more)


def brute_force_m(index, window, kind="standing", counts=None) -> float:
    """The least distance to any window at all."""
    rows = np.flatnonzero(getattr(index, kind) & (counts if counts is not None else True))
    away = [difference(*window, index.joints_m, index.joints_mps, r, index.share, SEARCH.velocity_s)[0] for r in rows]
    return math.sqrt(min(away))


def test_every_window_of_the_library_finds_itself(index):
    for row in np.flatnonzero(index.standing)[::37]:
        found = find(index, window_at(index, row, yaw=2.0, place=(4.0, -1.0)))
        assert found.distance_m < 1e-6
        # a clip that goes round or stands still may have the same window twice
        np.testing.assert_allclose(index.joints_m[found.row, :, 2], index.joints_m[row, :, 2], atol=1e-5)
        if found.row == row:
            assert found.yaw_rad == pytest.approx(2.0, abs=1e-6)
            assert found.place_m == pytest.approx((4.0, -1.0), abs=1e-6)


def test_the_prefilter_hardly_ever_misses_the_best(index):
    """Windows as a blow leaves them: every joint some 6 cm and 0.6 m/s off."""
    rows = np.flatnonzero(index.standing)[3::41]
    found_m, best_m = [], []
    for seed, row in enumerate(rows):
        window = window_at(index, row, yaw=seed, noise=0.035, seed=seed)
        found_m.append(find(index, window).distance_m)
        best_m.append(brute_force_m(index, window))
    found_m, best_m = np.array(found_m), np.array(best_m)
    assert len(rows) > 30
    assert (found_m >= best_m - 1e-12).all()
    assert np.mean(found_m <= best_m + 1e-9) >= 0.9
    # else it is a neighbour of the best, a sixtieth of a second off
    assert (found_m <= 1.02 * best_m).all()


def test_a_clip_can_be_left_out_or_alone_count(index):
    row = int(np.flatnonzero(index.standing & np.equal(index.clip, 1))[100])
    window = window_at(index, row)
    assert find(index, window).clip == 1
    other, alone = find(index, window, but_clip=1), find(index, window, only_clip=2)
    assert other.clip != 1
    assert other.distance_m == pytest.approx(brute_force_m(index, window, counts=~np.equal(index.clip, 1)), rel=1e-9)
    assert alone.clip == 2
    assert alone.distance_m == pytest.approx(brute_force_m(index, window, counts=np.equal(index.clip, 2)), rel=1e-9)


def test_windows_are_entered_on_a_foot_that_stands_with_motion_left(index, clips):
    assert index.standing.sum() > 500
    for row in np.flatnonzero(index.standing)[::23]:
        clip, time_s = clips[index.clip[row]], index.time_s[row]
        assert planted_at(clip, time_s + AHEAD_S).any()
        assert clip.loops or time_s + AHEAD_S + SEARCH.least_left_s <= clip.duration_s
    first = np.flatnonzero(np.diff(index.clip, prepend=-1))
    for back in range(4):  # a window does not begin before its clip
        assert not index.standing[first + back].any()


def test_moments_are_where_the_clip_has_them(index, clips):
    from engine.clips.playback import sample

    for row in (40, 700, len(index.clip) - 1):
        clip = clips[index.clip[row]]
        at, before = (joints_of(clip.body, sample(clip, index.time_s[row] - back))[0] for back in (0.0, 1 / 120))
        np.testing.assert_allclose(index.joints_m[row], at, atol=1e-12)
        np.testing.assert_allclose(index.joints_mps[row], (at - before) * 120, atol=1e-9)


def test_the_index_comes_back_from_the_cache_as_it_was(clips, index, tmp_path, monkeypatch):
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path))

    def make():
        return index_clips(clips, clips[0].body, AHEAD_S, SEARCH.least_left_s, SEARCH.velocity_s)

    built = make()
    assert built.key == index.key
    monkeypatch.setattr(motion_index, "_build", lambda *_: pytest.fail("built again"))
    again = make()
    for name in ("clip", "time_s", "joints_m", "joints_mps", "standing", "rising"):
        np.testing.assert_array_equal(getattr(again, name), getattr(built, name))
    monkeypatch.undo()
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path))
    (file,) = (tmp_path / "indexed").iterdir()
    file.write_bytes(file.read_bytes()[:1000])  # a broken file is as good as none
    np.testing.assert_array_equal(make().joints_m, built.joints_m)


def test_other_clips_or_another_order_are_another_index(clips, index):
    for other in (clips[:3], clips[::-1]):
        key = index_clips(other, clips[0].body, AHEAD_S, SEARCH.least_left_s, SEARCH.velocity_s).key
        assert key != index.key


@pytest.fixture(scope="module")
def gone_on(library_clip):
    """A walker who goes on with something new after a volleyball."""
    library_clip("walk")
    return played(struck(VOLLEYBALL, clip="walk", library=["walk", "dance", "kneel", "sway"]), checked=True)


def test_a_new_motion_is_entered_with_its_feet_held(gone_on):
    report = gone_on.report()
    (search,) = events(gone_on, "searched")
    assert search["chosen"] == "new"
    assert search["clip"] != "walk"
    assert search["entered_s"] == pytest.approx(search["window_ends_s"] + AHEAD_S)
    assert 0.0 < search["distance_m"] < 0.4
    assert 0 < search["compared"] <= SEARCH.candidates < search["windows"]
    assert report["metrics"]["recovered_to"] == search["clip"]
    assert report["phases"][-1]["name"] == "play"
    assert report["metrics"]["foot_slide_max_m"] < 0.002


@pytest.mark.parametrize("blow", [VOLLEYBALL, HARD], ids=["mild", "hard"])
@pytest.mark.parametrize("name", ["walk", "run", "dance", "stand"])
def test_from_any_motion_another_is_entered_without_a_step_out_of_place(name, blow, library_clip):
    library_clip(name)
    run = played(struck(blow, clip=name, start_s=0.4, library=["walk", "run", "dance", "kneel", "sway"]))
    metrics, (track,) = run.report()["metrics"], run.observer.tracks.values()
    chosen = [search for search in events(run, "searched") if search["chosen"] == "new"]
    assert chosen
    assert metrics["recovered_to"] == chosen[-1]["clip"] != name
    assert metrics["foot_slide_max_m"] < 0.002
    assert metrics["seam_position_jump_max_m"] < 0.0005
    # the way the body goes on is the way that it was going: the pelvis neither stops dead nor darts off
    pelvis_m = np.array(track.root_m)
    again = 1 + max(k for k, phase in enumerate(track.phase) if phase == Phase.RESPOND)
    assert np.linalg.norm(np.diff(pelvis_m[again:], 2, axis=0), axis=1).max() * 120**2 < 100.0


def test_the_character_keeps_its_own_bones(gone_on):
    world, (track,) = gone_on.world, gone_on.observer.tracks.values()
    played_clips = {world.assets.clips[number].name for number in track.clip}
    assert len(played_clips) == 2
    at, _ = joints_of(track.body, track.pose)
    bones = np.linalg.norm(at[:, 1:] - at[:, PARENT[1:]], axis=2)
    np.testing.assert_allclose(bones, np.broadcast_to(bones[0], bones.shape), atol=1e-9)
    assert all(clip.body is world.assets.bodies[0] for clip in world.assets.clips)


def test_the_same_run_twice_has_the_same_digest(gone_on):
    again = played(struck(VOLLEYBALL, clip="walk", library=["walk", "dance", "kneel", "sway"]))
    assert again.world.digest() == gone_on.world.digest()


def test_auto_goes_by_how_much_the_blow_has_moved_the_body(library_clip):
    library_clip("walk")
    mild = played(struck(VOLLEYBALL, clip="walk", recover="auto", library=["dance", "sway"]))
    (search,) = events(mild, "searched")
    assert search["chosen"] == "same"
    assert search["reaction_m"] < SEARCH.auto_over_m
    assert mild.report()["metrics"]["recovered_to"] == "walk"
    eager = {"search": {"auto_over_m": 0.5 * search["reaction_m"]}}
    moved = played(struck(VOLLEYBALL, clip="walk", recover="auto", library=["dance", "sway"], settings=eager))
    assert events(moved, "searched")[0]["chosen"] == "new"
    library_clip("stand")
    hard = played(struck(HARD, clip="stand", recover="auto", library=["dance", "sway"], duration_s=1.6))
    assert max(search["reaction_m"] for search in events(hard, "searched")) > SEARCH.auto_over_m
    assert events(hard, "searched")[-1]["chosen"] == "new"


def test_without_another_clip_the_same_is_taken_up():
    run = played(struck(VOLLEYBALL, clip="sway", library=[], duration_s=2.5))
    assert events(run, "searched")[0]["chosen"] == "same"
    assert run.report()["metrics"]["recovered_to"] == "sway"
    allowed = {"search": {"own_clip": True}}
    run = played(struck(VOLLEYBALL, clip="sway", library=[], duration_s=2.5, settings=allowed))
    assert events(run, "searched")[0]["clip"] == "sway"
    assert events(run, "searched")[0]["chosen"] == "new"


def test_the_library_is_what_the_scenario_says_and_what_its_characters_play(library_clip):
    library_clip("walk")
    scenario = check_scenario(
        {"character": [{"clip": "sway", "recover": "new"}, {"clip": "walk"}], "library": ["kneel", "sway"]}
    )
    world = played(scenario.model_copy(update={"duration_s": 0.02})).world
    names = [world.assets.clips[row].name for row in world.assets.libraries[0].clip_rows]
    assert names == ["sway", "kneel", "walk"]
    assert world.assets.libraries[1] is None


def test_what_a_scenario_may_say_about_it():
    with pytest.raises(BadInput, match="recover"):
        check_scenario({"character": [{"recover": "newer"}]})
    assert [recover.name.lower() for recover in Recover] == ["same", "new", "auto"]
    with pytest.raises((BadInput, EnvironmentTrouble), match="nothing_like_it"):
        played(struck(VOLLEYBALL, clip="sway", library=["nothing_like_it"]))


def test_returning_to_the_same_clip_neither_builds_nor_imports_an_index():
    code = """
import sys
sys.path.insert(0, ".")
from tests.behaviours.knocked import VOLLEYBALL, played, struck
run = played(struck(VOLLEYBALL, clip="sway", recover="same", duration_s=0.05))
assert run.world.assets.libraries == (None,)
assert not {"scipy.spatial", "behaviours.recover.motion_index", "engine.clips.retarget"} & set(sys.modules)
"""
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)
