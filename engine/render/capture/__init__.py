"""Pictures that leave the house: films, folders, filmstrips. A final name never holds half a file.

Each writer takes frames as (H, W, 3) uint8 arrays, top row first, from any iterable; it writes beside the target,
checks what it wrote, and only then gives it its name.
"""

from engine.core.files import check_output
from engine.render.capture.filmstrip import compose_filmstrip, write_filmstrip
from engine.render.capture.pictures import write_gif, write_png, write_png_folder
from engine.render.capture.video import count_frames, find_ffmpeg, write_mp4
from engine.render.capture.writers import capture_kind, write_film

__all__ = [
    "capture_kind",
    "check_output",
    "compose_filmstrip",
    "count_frames",
    "find_ffmpeg",
    "write_film",
    "write_filmstrip",
    "write_gif",
    "write_mp4",
    "write_png",
    "write_png_folder",
]
