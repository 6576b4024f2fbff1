"""The judge of golden pictures, judged: what must fail fails, and small noise passes."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from tests.render.golden import assert_golden, tile_differences


@pytest.fixture
def picture():
    return np.random.default_rng(3).integers(60, 200, (240, 320, 3)).astype("u1")


@pytest.fixture
def folders(tmp_path, picture, monkeypatch):
    monkeypatch.delenv("BRACE_GOLDEN", raising=False)
    Image.fromarray(picture).save(tmp_path / "thing.png")
    return tmp_path, tmp_path / "rejected"


def test_the_same_picture_and_a_little_noise_pass(picture, folders):
    noise = np.random.default_rng(4).integers(-3, 4, picture.shape)
    assert_golden("thing", picture, *folders)
    assert_golden("thing", (picture + noise).astype("u1"), *folders)
    assert not folders[1].exists()


def test_a_disc_of_eleven_pixels_fails_and_is_kept(picture, folders):
    y, x = np.mgrid[:240, :320]
    wrong = picture.copy()
    wrong[(x - 96) ** 2 + (y - 112) ** 2 < 5.5**2] = (250, 20, 20)  # on the corner of four tiles, where it hides best
    with pytest.raises(AssertionError, match="4 regions differ"):
        assert_golden("thing", wrong, *folders)
    with Image.open(folders[1] / "thing.png") as kept:
        assert (np.asarray(kept) == wrong).all()
    assert (folders[1] / "thing.difference.png").exists()


def test_a_missing_reference_fails_and_shows_what_was_drawn(picture, folders):
    with pytest.raises(AssertionError, match="no reference"):
        assert_golden("other", picture, *folders)
    assert (folders[1] / "other.png").exists()


def test_another_size_fails(picture, folders):
    with pytest.raises(AssertionError, match="drawn"):
        assert_golden("thing", picture[:-1], *folders)


def test_writing_makes_the_reference(picture, folders, monkeypatch):
    monkeypatch.setenv("BRACE_GOLDEN", "write")
    assert_golden("new", picture, *folders)
    monkeypatch.delenv("BRACE_GOLDEN")
    assert_golden("new", picture, *folders)


def test_tiles_at_the_edge_are_not_lost():
    small = np.zeros((20, 33, 3), "u1")
    other = small.copy()
    other[19, 32] = 255
    tiles = tile_differences(small, other)
    assert tiles.shape == (2, 3)
    assert tiles[1, 2] == pytest.approx(255 / 4)  # the last tile is one pixel wide and four high
    assert tiles.sum() == tiles[1, 2]
