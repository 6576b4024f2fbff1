"""`brace bench --motion`: how good the motion is, over seeded threats at real clips. Every figure has a bar to meet.

A case is a whole run: a clip, a moment of it, a threat from anywhere (`motion_cases`). It is measured by
`behaviours.measure.measures` (`motion_run`); threats to the head are thrown once more at somebody who sees nothing
coming, and some cases once more in a mirror. What came out is summed up in `motion_table`, and where it arises in
`motion_phases`.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from typing import NamedTuple

from demos.benchmarks.motion_cases import Case, find_clips, make_cases, make_knock_downs
from demos.benchmarks.motion_run import Row, run_case
from demos.benchmarks.pose_bars import PoseBars, pose_bars
from engine.clips.clip import Clip

KNOCK_DOWN_ONE_IN = 20

Progress = Callable[[Iterable[Row], int], Iterable[Row]]


class Found(NamedTuple):
    """All that was run."""

    clips: dict[str, Clip]
    rows: list[Row]  # volleyballs, one a case
    falls: list[Row]  # people knocked down
    poses: PoseBars  # sustained poses alone: restarts, the cases of fig. 3.10


def bench(count: int, seed: int = 1, progress: Progress = lambda rows, _total: rows, processes: int = 0) -> Found:
    """All cases, run and measured, by as many processes as there are cores unless told. The same for any number."""
    clips = find_clips()
    falls = make_knock_downs(clips, max(1, count // KNOCK_DOWN_ONE_IN), seed)
    cases = [*make_cases(clips, count, seed), *falls]
    processes = min(processes or len(os.sched_getaffinity(0)), len(cases))
    if processes == 1:
        rows = list(progress((run_case(case, clips) for case in cases), len(cases)))
        return Found(clips, rows[:count], rows[count:], pose_bars(count, seed, clips))
    # fresh processes: one that is forked takes over locks it cannot open
    fresh = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(processes, mp_context=fresh, initializer=_begin) as pool:
        try:
            with _deaf_to_interrupts():
                poses = pool.submit(_poses, count, seed)
            rows = list(progress(pool.map(_case, cases), len(cases)))
            return Found(clips, rows[:count], rows[count:], poses.result())
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in multiprocessing.active_children():
                process.terminate()
            raise


@contextlib.contextmanager
def _deaf_to_interrupts() -> Iterator[None]:
    """Processes that are started meanwhile do not hear Ctrl-C: this one does, and ends them in order."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


_clips: dict[str, Clip] = {}


def _begin() -> None:
    """In a process of its own: its clips."""
    _clips.update(find_clips())


def _case(case: Case) -> Row:
    return run_case(case, _clips)


def _poses(count: int, seed: int) -> PoseBars:
    return pose_bars(count, seed, _clips)
