"""Filming the window while it is played with: pictures go to ffmpeg at a steady rate, on a thread of its own."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from engine.core.errors import BraceError
from engine.core.files import check_output
from engine.render.capture import find_ffmpeg, write_mp4

FPS = 30.0
WAITING_FRAMES = 45  # pictures that may wait for ffmpeg; beyond them the film skips, the window does not wait
MOST_REPEATS = 30  # of one picture, when the window stood still for long


class Film:
    """From `Film(path)` until `stop`. What went wrong is in `trouble`, and then there is no file."""

    def __init__(self, path: Path):
        """EnvironmentTrouble, at once, where there is no ffmpeg or the file cannot be."""
        find_ffmpeg()
        self.path = check_output(path)
        self.trouble: BraceError | None = None
        self.frames = self.skipped = 0
        self.passed_s = 0.0
        self._size: tuple[int, ...] | None = None
        self._waiting: queue.Queue[np.ndarray | None] = queue.Queue(WAITING_FRAMES)
        self._writer = threading.Thread(target=self._write, name="film")
        self._writer.start()

    @property
    def going(self) -> bool:
        return self._writer.is_alive()

    def offer(self, passed_s: float, picture: Callable[[], np.ndarray]) -> bool:
        """Real time has passed: takes the picture once for every frame that is due. False once it cannot go on: the
        window has another size now, or the disk is full.
        """
        self.passed_s += passed_s
        due = min(int(self.passed_s * FPS) + 1 - self.frames - self.skipped, MOST_REPEATS)
        if due <= 0:
            return self.going
        now = picture()
        self._size = self._size or now.shape
        if not self.going or now.shape != self._size:
            return False
        for _ in range(due):
            try:
                self._waiting.put_nowait(now)
                self.frames += 1
            except queue.Full:
                self.skipped += 1
        return True

    def stop(self) -> None:
        """No more pictures; the file appears when ffmpeg has finished, see `going`."""
        threading.Thread(target=self._waiting.put, args=(None,), daemon=True).start()

    def wait(self) -> None:
        """Until the file is there, or will not be."""
        self._writer.join()

    def _pictures(self) -> Iterator[np.ndarray]:
        while (picture := self._waiting.get()) is not None:
            yield picture

    def _write(self) -> None:
        try:
            write_mp4(self.path, self._pictures(), FPS)
        except BraceError as trouble:
            self.trouble = trouble
