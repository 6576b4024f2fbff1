"""The search for a motion to go on with (thesis 4.1.3, after Zordan et al. 2005).

The motion under the physics since the blow is compared with every window of the clip library
(`behaviours.recover.windows`, `behaviours.recover.motion_index`); the nearest is entered, as long after its end as the
same clip would be after perception.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from behaviours.components import SAMPLES, STRIDE_TICKS, Playback, Reaction, Recover, Struck, Sustained
from behaviours.playing import body_of
from behaviours.recover.windows import FEATURES, features_into, nearest_of
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.body.skeleton import Pose

if TYPE_CHECKING:
    from behaviours.recover.motion_index import MotionIndex


class Library(NamedTuple):
    """What one character may go on with: the index, and the row of world.assets.clips of each of its clips."""

    motions: MotionIndex
    clip_rows: tuple[int, ...]


class Window(NamedTuple):
    """Some samples of motion, the latest first: (S, J, 3) each, world."""

    joints_m: np.ndarray
    joints_mps: np.ndarray


class Found(NamedTuple):
    """The nearest window: where it ends, how far off it is, and how it is laid over the one searched with."""

    row: int
    clip: int  # of the index
    time_s: float
    distance_m: float
    yaw_rad: float
    place_m: tuple[float, float]
    compared: int  # windows that were compared exactly


def best_window(
    index: MotionIndex,
    window: Window,
    kind: str,
    velocity_s: float,
    candidates: int,
    *,
    but_clip: int | None = None,
    only_clip: int | None = None,
) -> Found | None:
    """The window of an index (its "standing" or "rising" ones) that is nearest to this one; None if there is none.

    The k-d tree brings the rows whose last sample is about as it should be; these are compared exactly, in the order of
    clips and time, so that of equals the first is found. but_clip, only_clip: the number of a clip that does not
    count, or alone does.
    """

    def counts(rows: np.ndarray) -> np.ndarray:
        clip = index.clip[rows]
        if only_clip is not None:
            return np.equal(clip, only_clip)
        return np.not_equal(clip, -1 if but_clip is None else but_clip)

    rows = likely_rows(index, window, kind, velocity_s, candidates, counts)
    if len(rows) == 0:
        return None
    row, square, yaw, x, y = nearest_of(
        rows, window.joints_m, window.joints_mps, index.joints_m, index.joints_mps, index.share, velocity_s
    )
    clip, time_s, place_m = int(index.clip[row]), float(index.time_s[row]), (float(x), float(y))
    return Found(int(row), clip, time_s, math.sqrt(square), float(yaw), place_m, len(rows))


def likely_rows(
    index: MotionIndex,
    window: Window,
    kind: str,
    velocity_s: float,
    candidates: int,
    counts: Callable[[np.ndarray], np.ndarray],
) -> np.ndarray:
    """Ascending rows of a kind, the `candidates` nearest by the features of the last sample, of those that count."""
    prefilter = index.trees[kind]
    if prefilter.tree is None:
        return np.empty(0, np.int64)
    feature = np.empty(FEATURES)
    features_into(window.joints_m[0], window.joints_mps[0], index.share, velocity_s, feature)
    asked = candidates
    while True:
        asked = min(asked, len(prefilter.rows))
        _, near = prefilter.tree.query(feature, k=np.arange(1, asked + 1))
        rows = prefilter.rows[near]
        rows = rows[counts(rows)][:candidates]
        if len(rows) >= candidates or asked == len(prefilter.rows):
            return np.sort(rows)
        asked *= 4


def remember(world, row: int, joints_m) -> None:
    """Adds where the joints are now (J, 3) to what is remembered of the motion under the physics."""
    s = world[Struck]
    s.joints_m[row, 1:] = s.joints_m[row, :-1].copy()
    s.joints_m[row, 0] = joints_m
    s.count[row] = min(s.count[row] + 1, s.joints_m.shape[1])


def begin_remembering(world, row: int, joints_m) -> None:
    """At the blow: what was before it does not count."""
    world[Struck].count[row] = world[Struck].rests[row] = 0
    world[Struck].said[row] = False
    remember(world, row, joints_m)


def window_since_blow(world, row: int) -> Window:
    """What is remembered, as a window; fewer samples where the response was short, at least one."""
    s = world[Struck]
    joints_m = s.joints_m[row]
    samples = max(1, min(SAMPLES, (int(s.count[row]) - 2) // STRIDE_TICKS + 1))
    at = np.arange(samples) * STRIDE_TICKS
    return Window(joints_m[at].copy(), (joints_m[at] - joints_m[at + 1]) / TICK_S)


def reaction_size_m(world, row: int, window: Window, share, velocity_s: float) -> float:
    """How much a blow has moved a body: from the sustained pose, velocities counted, root mean square over its mass."""
    s = world[Sustained]
    meant, _ = joints_of(body_of(world, row), Pose(s.root_m[row], s.rotations[row]))
    off = ((window.joints_m[0] - meant) ** 2).sum(axis=1) + velocity_s**2 * (window.joints_mps[0] ** 2).sum(axis=1)
    return math.sqrt(float((share * off).sum()))


def choose_return(world, row: int) -> None:
    """Decides what a struck character goes back to, and says so; before the return is planned (thesis 4.1.3).

    `new` enters the nearest window of another clip, `auto` only if the blow was strong enough to make that look called
    for. Playback and Reaction then have the clip, and its time as if the threat had been perceived there.
    """
    recover, library = Recover(int(world[Struck].recover[row])), world.assets.libraries[row]
    if recover == Recover.SAME or library is None:
        return
    settings, index = world.assets.settings.search, library.motions
    window = window_since_blow(world, row)
    size_m = reaction_size_m(world, row, window, index.share, settings.velocity_s)
    if recover == Recover.AUTO and size_m <= settings.auto_over_m:
        world.emit("searched", world.entity(row), chosen="same", reaction_m=size_m)
        return
    own = None if settings.own_clip else library.clip_rows.index(int(world[Struck].played[row]))
    found = best_window(index, window, "standing", settings.velocity_s, settings.candidates, but_clip=own)
    if found is None:
        world.emit("searched", world.entity(row), chosen="same", reaction_m=size_m)
        return
    enter_window(world, row, library, found)
    say_found(world, row, found, "new", reaction_m=size_m)


def enter_window(world, row: int, library: Library, found: Found) -> None:
    """The clip plays on from the window's end, laid where the window fits; anchoring it to a foot comes later."""
    p = world[Playback]
    p.clip[row] = library.clip_rows[found.clip]
    p.place_m[row], p.heading_rad[row] = found.place_m, found.yaw_rad
    world[Reaction].clip_s[row] = found.time_s


def say_found(world, row: int, found: Found, chosen: str, **more: float) -> None:
    """The event of a search that found something."""
    library = world.assets.libraries[row]
    world.emit(
        "searched",
        world.entity(row),
        chosen=chosen,
        windows=len(library.motions.clip),
        compared=found.compared,
        clip=world.assets.clips[library.clip_rows[found.clip]].name,
        window_ends_s=found.time_s,
        entered_s=found.time_s + world.assets.settings.timing.sustained_ahead_s,
        distance_m=found.distance_m,
        **more,
    )
