"""The npz reader: the bodies it was given come out where they were, and broken archives are named."""

from __future__ import annotations

import numpy as np
import pytest

from engine.clips.fetching import clip_folder
from engine.clips.npz import PARENT_OF, read_npz
from engine.clips.tracks import world_of
from engine.core.errors import BadInput
from engine.maths import rotations

NAMES = ["pelvis", *PARENT_OF]
BONES = {name: np.array([0.01 * k, 0.02 * (-1) ** k, -0.1 - 0.01 * k]) for k, name in enumerate(NAMES)}


def archive(frames=6, repeat=1):
    """A motion of the fifteen bodies: bones of constant length, every body turning its own way."""
    rng = np.random.default_rng(5)
    local = rotations.from_rotation_vector(rng.normal(scale=0.4, size=(frames, len(NAMES), 3)))
    turned, places = local.copy(), np.zeros((frames, len(NAMES), 3))
    places[:, 0] = rng.normal(size=(frames, 3))
    for row, name in enumerate(NAMES[1:], start=1):
        parent = NAMES.index(PARENT_OF[name])
        turned[:, row] = rotations.multiply(turned[:, parent], local[:, row])
        places[:, row] = places[:, parent] + rotations.rotate(turned[:, parent], BONES[name])
    return {
        "fps": np.array(60),
        "body_names": np.array(NAMES),
        "body_positions": np.repeat(places, repeat, axis=0),
        "body_rotations": np.repeat(turned, repeat, axis=0),
        "dof_names": np.array(["unused"]),
    }


def save(path, **arrays):
    np.savez(path, **arrays)
    return path


def test_the_bodies_come_out_where_they_were(tmp_path):
    arrays = archive()
    tracks = read_npz(save(tmp_path / "a.npz", **arrays))
    positions, turned = world_of(tracks)
    np.testing.assert_allclose(positions, arrays["body_positions"], atol=1e-12)
    np.testing.assert_allclose(turned, arrays["body_rotations"], atol=1e-12)
    assert (tracks.fps, tracks.scale_to_m, tracks.notes) == (60.0, 1.0, ())


def test_frames_stored_twice_are_read_once_at_half_the_rate(tmp_path):
    once = read_npz(save(tmp_path / "once.npz", **archive(12)))
    twice = read_npz(save(tmp_path / "twice.npz", **archive(12, repeat=2)))
    np.testing.assert_array_equal(twice.rotations, once.rotations)
    assert twice.fps == 30.0
    assert "stored 2 times" in twice.notes[0]


def test_a_motionless_clip_keeps_its_rate(tmp_path):
    arrays = archive(1)
    for name in ("body_positions", "body_rotations"):
        arrays[name] = np.repeat(arrays[name], 20, axis=0)
    tracks = read_npz(save(tmp_path / "still.npz", **arrays))
    assert (len(tracks.root), tracks.fps) == (20, 60.0)


def test_the_library_walk_comes_out_where_it_was(library_clip):
    library_clip("walk")  # skips where it is not here
    path = clip_folder() / "walk.npz"
    tracks = read_npz(path)
    positions, _ = world_of(tracks)
    stored = np.load(path)["body_positions"]
    np.testing.assert_array_equal(stored[::2], stored[1::2])
    np.testing.assert_allclose(positions, stored[::2], atol=1e-6)


def without(name):
    return lambda arrays: arrays.pop(name)


def put(name, value):
    return lambda arrays: arrays.update({name: value(arrays[name])})


BREAKS = [
    (without("body_rotations"), "found no array 'body_rotations'"),
    (put("fps", lambda fps: np.array(0)), "expected one number from 1 to 1000"),
    (put("fps", lambda fps: np.array("fast")), "expected one number from 1 to 1000"),
    (put("body_names", lambda names: np.array(["tail", *names[1:]])), "differ by pelvis, tail"),
    (put("body_names", lambda names: names[::-1]), "expected parents first"),
    (put("body_positions", lambda p: p[:-1]), "found body_rotations of shape (6, 15, 4), expected (5, 15, 4)"),
    (put("body_positions", lambda p: p[:0]), "found body_positions of shape (0, 15, 3)"),
    (put("body_rotations", lambda q: q[..., :3]), "found body_rotations of shape (6, 15, 3)"),
    (put("body_rotations", lambda q: q * 1.1), "expected unit quaternions"),
    (
        put("body_positions", lambda p: np.where(np.arange(6)[:, None, None] == 3, np.nan, p)),
        "not finite in frame 3 at",
    ),
]


@pytest.mark.parametrize(("breaking", "message"), BREAKS)
def test_a_broken_archive_is_named(tmp_path, breaking, message):
    arrays = archive()
    breaking(arrays)
    path = save(tmp_path / "broken.npz", **arrays)
    with pytest.raises(BadInput) as bad:
        read_npz(path)
    assert message in bad.value.line()
    assert str(path) in bad.value.line()


def test_what_is_no_archive_is_refused(tmp_path):
    good = save(tmp_path / "good.npz", **archive()).read_bytes()
    pickled = tmp_path / "pickled.npz"
    np.savez(pickled, **{**archive(), "fps": np.array([{}], dtype=object)}, allow_pickle=True)
    for name, content in (("text.npz", b"HIERARCHY"), ("empty.npz", b""), ("cut.npz", good[: len(good) // 2])):
        (tmp_path / name).write_bytes(content)
        with pytest.raises(BadInput, match="no readable npz archive"):
            read_npz(tmp_path / name)
    with pytest.raises(BadInput, match="no readable npz archive"):
        read_npz(pickled)
    np.save(tmp_path / "array.npy", np.zeros(3))
    (tmp_path / "array.npy").rename(tmp_path / "array.npz")
    with pytest.raises(BadInput, match="found a single array, expected an archive of several"):
        read_npz(tmp_path / "array.npz")
