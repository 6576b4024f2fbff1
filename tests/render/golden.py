"""Golden pictures: a test builds a scene, this draws it, compares it region by region, and keeps what differs.

    @golden()
    def test_ball():
        return Scene(balls=[...]), camera

The references lie in tests/golden, one per visible thing. A missing one fails. `BRACE_GOLDEN=write` makes them anew:
look at every one of them before committing. What was drawn instead, and where it differs, is written to out/golden.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image

from engine.render.camera import Camera
from engine.render.scene import Scene

ROOT = Path(__file__).resolve().parents[2]
REFERENCES = ROOT / "tests" / "golden"
REJECTED = ROOT / "out" / "golden"
SIZE_PX = (320, 240)
TILE_PX = 16
TOLERANCE = 4.0  # mean difference of one channel over one tile, of 255


def golden(size_px: tuple[int, int] = SIZE_PX) -> Callable:
    """Makes a test out of a function that gives a scene and a camera."""

    def decorate(build: Callable[[], tuple[Scene, Camera]]) -> Callable:
        name = build.__name__.removeprefix("test_")

        def test(renderer):
            scene, camera = build()
            renderer.draw(scene, camera, size_px)
            assert_golden(name, renderer.read_rgb())

        test.__name__, test.__doc__ = build.__name__, build.__doc__
        test.build = build
        return test

    return decorate


def assert_golden(name: str, drawn: np.ndarray, references: Path = REFERENCES, rejected: Path = REJECTED) -> None:
    """Fails with the worst region and the files to look at, or passes."""
    reference = references / f"{name}.png"
    if os.environ.get("BRACE_GOLDEN") == "write":
        reference.parent.mkdir(parents=True, exist_ok=True)
        Image.fromarray(drawn).save(reference, optimize=True)
        return
    actual = rejected / f"{name}.png"
    if not reference.exists():
        _keep(actual, drawn)
        raise AssertionError(f"no reference {reference}; look at {actual}, then BRACE_GOLDEN=write")
    with Image.open(reference) as picture:
        wanted = np.asarray(picture.convert("RGB"))
    assert wanted.shape == drawn.shape, f"{name}: drawn {drawn.shape}, reference {wanted.shape}"
    tiles = tile_differences(wanted, drawn)
    if tiles.max() <= TOLERANCE:
        return
    _keep(actual, drawn)
    difference = np.abs(wanted.astype(int) - drawn)
    _keep(rejected / f"{name}.difference.png", np.minimum(4 * difference, 255).astype("u1"))
    y, x = TILE_PX * np.array(np.unravel_index(tiles.argmax(), tiles.shape))
    raise AssertionError(
        f"{name}: {np.count_nonzero(tiles > TOLERANCE)} regions differ, most at x {x}, y {y} (mean {tiles.max():.1f} "
        f"of 255, allowed {TOLERANCE}); compare {actual} with {reference}"
    )


def tile_differences(wanted: np.ndarray, drawn: np.ndarray) -> np.ndarray:
    """(H / 16, W / 16): the mean difference in each tile, of the channel that differs most; the last may be smaller."""
    difference = np.abs(wanted.astype(float) - drawn.astype(float))
    rows = np.arange(0, difference.shape[0], TILE_PX)
    columns = np.arange(0, difference.shape[1], TILE_PX)
    sums = np.add.reduceat(np.add.reduceat(difference, rows, axis=0), columns, axis=1)
    heights = np.diff(np.append(rows, difference.shape[0]))
    widths = np.diff(np.append(columns, difference.shape[1]))
    return (sums / (heights[:, None, None] * widths[None, :, None])).max(axis=2)


def _keep(path: Path, picture: np.ndarray) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(picture).save(path)
