"""Which writer a path asks for."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from engine.core.errors import BadInput
from engine.core.files import check_output
from engine.render.capture.pictures import check_folder_output, write_gif, write_png_folder
from engine.render.capture.video import find_ffmpeg, write_mp4

KINDS = {".mp4": "mp4", ".gif": "gif", ".png": "png", "": "folder"}


def capture_kind(path) -> str:
    """`mp4`, `gif`, `png` (a filmstrip) or `folder`, by the path's ending; checks at once that it can be written."""
    kind = "folder" if Path(path).is_dir() else KINDS.get(Path(path).suffix.lower())
    if kind is None:
        raise BadInput(
            "output", f"unknown ending {Path(path).suffix}, expected .mp4, .gif, .png or a folder", str(path)
        )
    if kind == "folder":
        check_folder_output(path)
    else:
        check_output(path)
    if kind == "mp4":
        find_ffmpeg()
    return kind


def write_film(path, frames: Iterable[np.ndarray], fps: float, progress: Callable[[int], None] | None = None) -> int:
    """An MP4, a GIF or a folder of PNGs, by the path's ending; returns the number of frames."""
    kind = capture_kind(path)
    if kind == "png":
        raise BadInput("output", "a film does not fit into one .png: use a filmstrip", str(path))
    if kind == "mp4":
        return write_mp4(path, frames, fps, progress)
    if kind == "gif":
        return write_gif(path, frames, fps, progress)
    return write_png_folder(path, frames, fps, progress)
