"""MP4 through ffmpeg and our own pipe: every frame counted in, and decoded again before the file gets its name."""

from __future__ import annotations

import contextlib
import functools
import itertools
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np

from engine.core.errors import BadInput, EnvironmentTrouble
from engine.core.files import whole_file

# H.264 plays everywhere; some distributions ship ffmpeg without x264
ENCODERS = {
    "libx264": ("-preset", "medium", "-crf", "18"),
    "libopenh264": ("-b:v", "8M"),
    "mpeg4": ("-q:v", "3"),
}
_REC709 = ("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv")


def write_mp4(path, frames: Iterable[np.ndarray], fps: float, progress: Callable[[int], None] | None = None) -> int:
    """Writes all frames and returns how many. Odd widths and heights get one more column or row, as the format asks.

    BadInput for no frames at all, or frames of another size than the first; EnvironmentTrouble without ffmpeg, or where
    the file cannot be written or does not hold what was put in.
    """
    ffmpeg = find_ffmpeg()
    with whole_file(path) as part:
        count = _encode(ffmpeg, part, frames, fps, str(path), progress)
        found = count_frames(part)
        if found != count:
            raise EnvironmentTrouble(
                "bad-video", f"{count} frames were written but {found} can be read back; nothing was kept", str(path)
            )
    return count


def find_ffmpeg() -> str:
    """The ffmpeg on PATH, else the one that came with imageio-ffmpeg."""
    found = shutil.which("ffmpeg")
    if found:
        return found
    try:
        import imageio_ffmpeg

        return imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError) as trouble:
        hint = "no ffmpeg here: apt-get install ffmpeg, or capture to a folder or a .gif"
        raise EnvironmentTrouble("no-ffmpeg", hint) from trouble


def count_frames(path) -> int:
    """How many pictures come out when the film is decoded; 0 where it cannot be."""
    command = [find_ffmpeg(), "-v", "error", "-nostdin", "-i", str(path), "-map", "0:v:0", "-f", "framecrc", "-"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0 or done.stderr.strip():
        return 0
    return sum(1 for line in done.stdout.splitlines() if line and not line.startswith("#"))


def even_sized(frame: np.ndarray) -> np.ndarray:
    """The frame with its last column or row repeated where the count is odd."""
    height, width = frame.shape[:2]
    if height % 2 == 0 and width % 2 == 0:
        return frame
    return np.pad(frame, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")


def checked_frames(frames: Iterable[np.ndarray], where: str) -> Iterator[np.ndarray]:
    """The frames, each of the first one's size; BadInput for anything else, or for none."""
    shape = None
    for number, frame in enumerate(frames):
        shape = shape or frame.shape
        if frame.dtype != np.uint8 or frame.ndim != 3 or frame.shape[2] != 3 or frame.size == 0:
            found = f"{frame.shape} {frame.dtype}"
            raise BadInput("frame", f"frame {number} is {found}, expected (height, width, 3) uint8", where)
        if frame.shape != shape:
            raise BadInput(
                "frame",
                f"frame {number} is {frame.shape[1]} x {frame.shape[0]}, the first {shape[1]} x {shape[0]}",
                where,
            )
        yield frame
    if shape is None:
        raise BadInput("no-frames", "there is nothing to capture: not a single frame", where)


def _encode(ffmpeg: str, part: Path, frames, fps: float, where: str, progress) -> int:
    """Runs ffmpeg over all frames; returns how many it took."""
    checked = checked_frames(frames, where)
    first = next(checked)
    with tempfile.TemporaryFile() as complaints:
        process = _start(ffmpeg, part, even_sized(first).shape, fps, complaints)
        try:
            count = _feed(process, itertools.chain((first,), checked), progress)
        except BaseException:
            process.kill()
            _hang_up(process)
            process.wait()
            raise
        code = process.wait()
        complaints.seek(0)
        said = complaints.read().decode("utf-8", "replace")
    if count is None or code != 0 or _no_room(said):  # it may end with 0 all the same
        raise _trouble(code, said, where)
    return count


def _feed(process: subprocess.Popen, frames: Iterable[np.ndarray], progress) -> int | None:
    """Writes every frame into the pipe and closes it; None where ffmpeg stopped listening."""
    pipe, count = process.stdin, 0
    assert pipe is not None
    try:
        for frame in frames:
            pipe.write(np.ascontiguousarray(even_sized(frame)).data)
            count += 1
            if progress:
                progress(count)
        pipe.close()
    except BrokenPipeError:
        _hang_up(process)
        return None
    return count


def _hang_up(process: subprocess.Popen) -> None:
    """Closes the pipe to a process that may be gone."""
    with contextlib.suppress(BrokenPipeError):
        if process.stdin:
            process.stdin.close()


def _start(ffmpeg: str, part: Path, shape, fps: float, complaints) -> subprocess.Popen:
    encoder = best_encoder(ffmpeg)
    command = [
        ffmpeg, "-v", "error", "-nostdin", "-y",
        "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{shape[1]}x{shape[0]}", "-r", f"{fps:g}", "-i", "pipe:0",
        "-an", "-vf", "scale=out_color_matrix=bt709:out_range=tv", "-pix_fmt", "yuv420p", *_REC709,
        "-c:v", encoder, *ENCODERS[encoder], "-movflags", "+faststart", "-f", "mp4", str(part),
    ]  # fmt: skip
    # a session of its own: Ctrl-C reaches us first, and we end it in order
    return subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=complaints, start_new_session=True
    )


@functools.lru_cache(maxsize=4)
def best_encoder(ffmpeg: str) -> str:
    """The first of ENCODERS that this ffmpeg has."""
    listed = subprocess.run([ffmpeg, "-hide_banner", "-encoders"], capture_output=True, text=True, check=False).stdout
    names = {line.split()[1] for line in listed.splitlines() if len(line.split()) > 1}
    for encoder in ENCODERS:
        if encoder in names:
            return encoder
    raise EnvironmentTrouble("no-ffmpeg", f"{ffmpeg} has none of the encoders {', '.join(ENCODERS)}")


def _trouble(code: int, said: str, where: str) -> EnvironmentTrouble:
    """ffmpeg's last words, in one line."""
    lines = [line for line in said.splitlines() if line.strip()]
    if _no_room(said) or code == -signal.SIGXFSZ:
        return EnvironmentTrouble("disk-full", "the disk is full; nothing was kept", where)
    last = lines[-1] if lines else f"it ended with code {code}"
    return EnvironmentTrouble("ffmpeg", f"ffmpeg failed: {last}", where)


def _no_room(said: str) -> bool:
    return "No space left" in said or "File too large" in said
