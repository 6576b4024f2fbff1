"""Finding clips: by name, by file, from the cache; and what is said when they are not there."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from engine.clips import cache, importing
from engine.clips.cache import cache_folder
from engine.clips.clip import Clip
from engine.clips.library import LIBRARY, find_clip, list_clips
from engine.clips.making import Wanted, content_key
from engine.clips.synthetic import sway
from engine.core.errors import BadInput, EnvironmentTrouble
from tests.clips.people import swing_arms, write_person

# what nothing in their files moves
LACKING = {
    "walk": ["waist", "head", "left_clavicle", "right_clavicle", "left_toe", "right_toe"],
    "hop": [],
    "stand": ["left_toe", "right_toe"],
}


@pytest.fixture
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def assert_same_clip(a: Clip, b: Clip):
    for x, y in ((a.pose, b.pose), (a.body, b.body)):
        for one, other in zip(x, y, strict=True):
            np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(a.planted, b.planted)
    assert (a.name, a.fps, a.loop, a.report, a.key) == (b.name, b.fps, b.loop, b.report, b.key)


def test_the_cache_is_where_the_user_says(monkeypatch, tmp_path):
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "a"))
    assert cache_folder() == tmp_path / "a"
    monkeypatch.delenv("BRACE_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "x"))
    assert cache_folder() == tmp_path / "x" / "brace"
    monkeypatch.delenv("XDG_CACHE_HOME")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert cache_folder() == tmp_path / "home" / ".cache" / "brace"


def test_the_library_has_the_promised_names_and_sway_needs_nothing(own_cache):
    listed = list_clips()
    promised = [clip.name for clip in listed if clip.name in ("walk", "run", "dance", "hop", "stand", "sway")]
    assert len(promised) == 6
    assert len({clip.name for clip in listed}) == len(listed)
    assert [clip.name for clip in listed if clip.ready] == ["sway"]
    assert_same_clip(find_clip("sway"), sway())
    assert not own_cache.exists()


def test_listing_compiles_and_imports_no_kernels():
    code = "import sys, engine.clips.library as l; l.list_clips(); print('numba' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_a_clip_that_was_not_fetched_is_trouble_with_a_way_out(own_cache):
    with pytest.raises(EnvironmentTrouble) as trouble:
        find_clip("walk")
    assert trouble.value.exit_code == 3
    assert "`brace clips fetch`" in trouble.value.line()


def test_an_unknown_name_lists_what_there_is_nearest_first(own_cache):
    with pytest.raises(BadInput) as bad:
        find_clip("wlak")
    assert bad.value.exit_code == 2
    assert "found no clip or file 'wlak', expected walk, " in bad.value.line()
    assert all(clip.name in bad.value.line() for clip in LIBRARY)


def test_files_are_found_from_the_folder_that_names_them(own_cache, tmp_path):
    (tmp_path / "clips").mkdir()
    write_person(tmp_path / "clips" / "mine.bvh", swing_arms(20))
    clip = find_clip("clips/mine.bvh", relative_to=tmp_path)
    assert clip.name == "mine"
    assert_same_clip(clip, find_clip(tmp_path / "clips" / "mine.bvh"))
    for missing in ("nowhere.bvh", "clips/nowhere.amc"):
        with pytest.raises(BadInput, match="found no such file, expected a clip"):
            find_clip(missing, relative_to=tmp_path)
    (tmp_path / "mine.fbx").touch()
    with pytest.raises(BadInput, match=r"found a .fbx file, expected .bvh, .amc, .npz"):
        find_clip(tmp_path / "mine.fbx")


def test_a_second_load_comes_from_the_cache_and_is_the_same(own_cache, tmp_path, monkeypatch):
    path = write_person(tmp_path / "mine.bvh", swing_arms(20))
    first = find_clip(path)
    monkeypatch.setattr(importing, "build_clip", lambda *args: pytest.fail("imported again"))
    assert_same_clip(find_clip(path), first)
    path.rename(tmp_path / "renamed.bvh")
    again = find_clip(tmp_path / "renamed.bvh")
    assert (again.name, again.report.name, again.key) == ("renamed", "renamed", first.key)


def test_any_change_of_bytes_or_wishes_is_another_clip(own_cache, tmp_path):
    path = write_person(tmp_path / "mine.bvh", swing_arms(20))
    plain = find_clip(path)
    woman = find_clip(path, sex="female", body_mass_kg=55.0)
    assert woman.body.part_mass_kg.sum() == pytest.approx(55.0, rel=1e-3)
    assert woman.key != plain.key
    write_person(path, swing_arms(21))
    assert find_clip(path).frames == 21
    assert content_key(path, Wanted(first_frame=1)) != content_key(path, Wanted())


def test_a_broken_or_unwritable_cache_costs_time_but_no_clip(own_cache, tmp_path):
    path = write_person(tmp_path / "mine.bvh", swing_arms(20))
    first = find_clip(path)
    [kept] = list((own_cache / "imported").iterdir())
    for content in (b"", b"nonsense", kept.read_bytes()[:500]):
        kept.write_bytes(content)
        assert_same_clip(find_clip(path), first)
    assert cache.load("0" * 64) is None
    kept.unlink()
    kept.parent.rmdir()
    kept.parent.write_text("a file where a folder should be")
    assert_same_clip(find_clip(path), first)


def test_no_half_file_is_left_behind(own_cache):
    own_cache.mkdir()

    def fail(file):
        file.write(b"half")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        cache.write_whole(own_cache / "whole.npz", fail)
    assert list(own_cache.iterdir()) == []


def test_real_clips_of_the_library_stand_on_their_feet(library_clip):
    for name, seconds, loops in (
        ("walk", 2.5, True),
        ("run", 1.3, True),
        ("dance", 15.0, False),
        ("hop", 22.9, False),
        ("stand", 2.1, True),
    ):
        clip = library_clip(name)
        assert clip.report.missing_joints == LACKING.get(name, LACKING["walk"])
        assert clip.report.duration_s == pytest.approx(seconds, abs=0.06)
        assert (clip.name, clip.loops) == (name, loops)
        assert clip.planted.any(axis=0).all()


def test_the_npz_walk_steps_where_it_was_seen_to(library_clip):
    """Single support seen in the file's 60 Hz frames: left 9-34 and 70-91, right 38-65 and 99-123; it is read at 30."""
    walk = library_clip("walk")
    for feet, ranges in (((True, False), [(9, 34), (70, 91)]), ((False, True), [(38, 65), (99, 123)])):
        for first, last in ranges:
            inside = walk.planted[(first + 5 + 1) // 2 : (last - 5) // 2 + 1]
            assert (inside == feet).all()
