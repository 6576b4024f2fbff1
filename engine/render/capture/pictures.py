"""Single pictures, animated GIFs and folders of numbered PNGs."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from engine.core.errors import BadInput, EnvironmentTrouble
from engine.core.files import check_output, disk_trouble, whole_file
from engine.render.capture.video import checked_frames

MANIFEST = "frames.json"
_MADE_BY = "brace capture"
GIF_COLOURS = 255


def write_png(path, picture: np.ndarray) -> None:
    """One picture (H, W, 3) uint8."""
    (picture,) = checked_frames([picture], str(path))
    with whole_file(path) as part:
        Image.fromarray(picture).save(part, format="PNG")


def write_gif(path, frames: Iterable[np.ndarray], fps: float, progress: Callable[[int], None] | None = None) -> int:
    """An endless GIF; returns the number of frames. Its delays are uneven hundredths, so that the whole keeps time."""
    palettes = _palettised(checked_frames(frames, str(path)), progress)
    with whole_file(path) as part:
        first = next(palettes)
        # Pillow asks for the delays before it has seen how many frames come
        rest = list(palettes)
        delays_ms = gif_delays_ms(1 + len(rest), fps)
        first.save(part, format="GIF", save_all=True, append_images=rest, duration=delays_ms, loop=0, disposal=1)
        if _gif_length_ms(part) != sum(delays_ms):
            raise EnvironmentTrouble("bad-gif", "the file does not hold what was put in; nothing was kept", str(path))
    return 1 + len(rest)


def gif_delays_ms(count: int, fps: float) -> list[int]:
    """Whole hundredths of a second that never drift from the true time; at least two: browsers slow shorter ones."""
    ends = np.round(np.arange(1, count + 1) * 100.0 / fps).astype(int)
    return [int(10 * max(delay, 2)) for delay in np.diff(ends, prepend=0)]


def write_png_folder(
    folder,
    frames: Iterable[np.ndarray],
    fps: float,
    progress: Callable[[int], None] | None = None,
    checked: Callable[[Iterable[np.ndarray], str], Iterator[np.ndarray]] = checked_frames,
) -> int:
    """Numbered PNGs and `frames.json`; the folder appears when all are there. Returns how many.

    checked: lets the frames through that are fit to be kept; pictures (H, W, 3) uint8 without it.
    An earlier capture in that place is replaced; BadInput where the folder holds anything else.
    """
    target = check_folder_output(folder)
    part = target.with_name(f".{target.name}.{os.getpid()}.part")
    with disk_trouble(target):
        try:
            part.mkdir()
            names = _write_numbered(part, checked(frames, str(folder)), progress)
            _write_manifest(part, names, fps)
            _swap_in(part, target)
        finally:
            shutil.rmtree(part, ignore_errors=True)
    return len(names)


def checked_measures(frames: Iterable[np.ndarray], where: str) -> Iterator[np.ndarray]:
    """Frames of one number a pixel, (H, W) uint8 or uint16; BadInput for anything else."""
    for number, frame in enumerate(frames):
        if frame.dtype not in (np.uint8, np.uint16) or frame.ndim != 2 or frame.size == 0:
            raise BadInput("frame", f"frame {number} is {frame.shape} {frame.dtype}, expected (height, width)", where)
        yield frame


def check_folder_output(folder) -> Path:
    """The folder's path, if a capture may take its place."""
    target = Path(os.path.abspath(folder))
    if target.is_symlink() or (target.exists() and not target.is_dir()):
        raise BadInput("output", "this is not a folder, so it is not overwritten", str(folder))
    if not target.exists():
        check_output(target)
        return target
    check_output(target.with_name(f"{target.name}.probe"))
    ours = _earlier_capture(target)
    foreign = sorted(entry.name for entry in target.iterdir() if entry.name not in ours)
    if foreign:
        raise BadInput(
            "output", f"the folder holds files that are not ours ({foreign[0]}); name an empty or new one", str(folder)
        )
    return target


def _earlier_capture(target: Path) -> set[str]:
    """The files that an earlier capture left there, by its own list."""
    try:
        manifest = json.loads((target / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return set()
    if not isinstance(manifest, dict) or manifest.get("made_by") != _MADE_BY:
        return set()
    return {MANIFEST, *manifest["files"]}


def _write_numbered(part: Path, frames, progress) -> list[str]:
    names = []
    for number, frame in enumerate(frames):
        names.append(f"frame_{number:05d}.png")
        Image.fromarray(frame).save(part / names[-1], format="PNG", compress_level=4)
        if progress:
            progress(number + 1)
    return names


def _write_manifest(part: Path, names: list[str], fps: float) -> None:
    with Image.open(part / names[0]) as first:
        size = first.size
    manifest = {"made_by": _MADE_BY, "fps": fps, "size": size, "files": names}
    (part / MANIFEST).write_text(json.dumps(manifest, indent=1) + "\n", encoding="utf-8")


def _swap_in(part: Path, target: Path) -> None:
    """Puts the new folder in the place of the old one, which is only then deleted."""
    if not target.exists():
        os.rename(part, target)
        return
    old = target.with_name(f".{target.name}.{os.getpid()}.old")
    os.rename(target, old)
    try:
        os.rename(part, target)
    except OSError:
        os.rename(old, target)
        raise
    shutil.rmtree(old)


def _palettised(frames, progress) -> Iterator[Image.Image]:
    for number, frame in enumerate(frames):
        if progress:
            progress(number + 1)
        yield Image.fromarray(frame).quantize(
            GIF_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.FLOYDSTEINBERG
        )


def _gif_length_ms(path) -> int:
    """The length of the film that can be read back: Pillow merges frames that are the same, so counting does not do."""
    total = 0
    with Image.open(path) as film:
        for number in range(getattr(film, "n_frames", 1)):
            film.seek(number)
            film.load()
            total += film.info.get("duration", 0)
    return total
