"""How much a frame may cost: levels of drawing, and a governor that picks one from measured frame times."""

from __future__ import annotations

from statistics import median
from typing import NamedTuple


class Quality(NamedTuple):
    """What is spent on a picture. All levels show the same things."""

    name: str
    samples: int  # a pixel
    scale: float  # of the drawn picture's sides to those of the finished one
    coarser: float  # cells of meshes grow by this
    mirrored: bool  # whether the varnish mirrors the hall


BEST = Quality("best", 4, 1.0, 1.0, True)
LEVELS = (
    BEST,
    Quality("good", 4, 0.85, 1.4, True),
    Quality("fair", 4, 0.7, 1.4, False),
    Quality("fast", 4, 0.55, 2.0, False),
    Quality("fastest", 4, 0.42, 2.8, False),
)
SMALL_PX = 640 * 360
NAMES = tuple(level.name for level in LEVELS)


def quality_named(name: str) -> Quality:
    """The level of that name. ValueError names what there is."""
    if name not in NAMES:
        raise ValueError(f"unknown quality {name!r}; there are {', '.join(NAMES)}")
    return LEVELS[NAMES.index(name)]


def target_fps(size_px: tuple[int, int]) -> float:
    """What is aimed at: small pictures are asked to move as smoothly as screens do."""
    return 60.0 if size_px[0] * size_px[1] <= SMALL_PX else 30.0


class Governor:
    """Goes to cheaper levels while frames take too long, and back when there is room to spare.

    A level that was too slow is not tried again for a while, longer each time, so that the picture does not flicker
    between two. Times come from outside: what a frame took to draw, without waiting for the screen.
    """

    WINDOW = 15  # frames that decide
    SPARE = 0.45  # share of the budget below which a dearer level is tried
    PATIENCE = 240  # frames until a level that failed is tried again; doubles with each failure

    def __init__(self, start: int = 0):
        self.index = start
        self._times_s: list[float] = []
        self._frame = 0
        self._retry_frame = [0] * len(LEVELS)
        self._failures = [0] * len(LEVELS)

    @property
    def quality(self) -> Quality:
        return LEVELS[self.index]

    def took(self, frame_s: float, size_px: tuple[int, int]) -> Quality:
        """Tells how long the last frame took, of what size; returns the level for the next."""
        budget_s = 1.0 / target_fps(size_px)
        self._frame += 1
        self._times_s.append(frame_s)
        if len(self._times_s) < self.WINDOW:
            return self.quality
        typical_s = median(self._times_s)
        self._times_s.clear()
        if typical_s > budget_s and self.index + 1 < len(LEVELS):
            self._give_up_level()
        elif typical_s < self.SPARE * budget_s and self.index > 0 and self._frame >= self._retry_frame[self.index - 1]:
            self.index -= 1
        return self.quality

    def _give_up_level(self) -> None:
        self._failures[self.index] += 1
        self._retry_frame[self.index] = self._frame + self.PATIENCE * 2 ** (self._failures[self.index] - 1)
        self.index += 1
