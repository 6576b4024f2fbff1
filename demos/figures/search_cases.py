"""A seeded look through many threats at many times of the clips, for poses that show what a figure is about."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from behaviours.perceive.threats import KINDS
from demos.figures.meeting import Meeting, meet
from demos.figures.press import Press
from engine.body.kinematics import joints_of
from engine.body.support import margin_m, polygon_of

SEED, TRIES = 2006, 240
CLIPS = ("walk", "dance", "hop")
LONGEST_S, WIDEST_DEG = 20.0, 75.0


class Tried(NamedTuple):
    """One of them, and how far inside the support polygon its centre of mass was, metres, before and after."""

    meeting: Meeting
    clip: str
    time_s: float
    azimuth_deg: float
    before_m: float
    after_m: float


def first_of_each(press: Press, wanted: dict[str, Callable[[Tried], bool]]) -> dict[str, Tried]:
    """The first that fits each description; what nothing fits is left out."""
    found: dict[str, Tried] = {}
    for tried in tries(press):
        for name, fits in wanted.items():
            if name not in found and fits(tried):
                found[name] = tried
        if len(found) == len(wanted):
            break
    return found


def tries(press: Press) -> Iterator[Tried]:
    """Characters with both feet on the ground; the same ones every time that the same clips are there."""
    random = np.random.default_rng(SEED)
    for number in range(TRIES):
        clip = press.clip(CLIPS[number % len(CLIPS)])
        time_s = float(random.uniform(0.0, max(0.0, min(clip.duration_s, LONGEST_S) - 0.3)))
        azimuth = float(random.uniform(-WIDEST_DEG, WIDEST_DEG))
        speed, size = float(random.uniform(*KINDS["volleyball"].speed_range_mps)), float(random.uniform(0.0, 1.0))
        m = meet(clip, time_s, azimuth, 8.0, speed, size)
        if m.found.feet.held.all():
            before = polygon_of(m.body, *joints_of(m.body, m.found.rules), m.found.feet.held)
            after_m = margin_m(m.found.support_m, m.found.com_m[:2])
            yield Tried(m, clip.name, time_s, azimuth, margin_m(before, m.found.com_rules_m[:2]), after_m)
