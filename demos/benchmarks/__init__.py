"""The benchmarks of `brace bench`, one file each: ours beside a named reference, in one run on one machine.

To add one, copy a neighbour and name it in `NAMES`. A module has `prepare() -> Benchmark`, which does its imports and
makes its data, so that only what is meant gets timed. `tests/benchmarks` checks that each pair agrees.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable
from statistics import median
from typing import Any, NamedTuple

NAMES = ("kinematics", "columns", "protection", "search", "stance", "clip", "tick", "start_up")

SAMPLE_S = 0.004  # a shorter sample would measure the clock
LEAST_SAMPLES, MOST_SAMPLES, LONGEST_S = 5, 60, 1.5


class Benchmark(NamedTuple):
    """Two ways to the same result. `check` gets both results and raises AssertionError if they differ."""

    what: str
    ours: Callable[[], Any]
    reference_name: str
    reference: Callable[[], Any]
    check: Callable[[Any, Any], None]
    parts: int = 1  # how many of what is reported one call does, of either way


class Timing(NamedTuple):
    """Medians of one benchmark."""

    name: str
    what: str
    ours_s: float
    reference_name: str
    reference_s: float

    @property
    def times_faster(self) -> float:
        return self.reference_s / self.ours_s


def load(name: str) -> Benchmark:
    """The benchmark of that name, ready to run."""
    return importlib.import_module(f"demos.benchmarks.{name}").prepare()


def measure(name: str) -> Timing:
    """Medians of both ways, their samples taken in turns so that a busy moment of the machine hits both."""
    benchmark = load(name)
    benchmark.check(benchmark.ours(), benchmark.reference())  # also compiles and fills caches
    ways = (benchmark.ours, benchmark.reference)
    loops = [_loops_for(way) for way in ways]
    samples: tuple[list[float], list[float]] = ([], [])
    begun = time.perf_counter()
    for taken in range(MOST_SAMPLES):
        if taken >= LEAST_SAMPLES and time.perf_counter() - begun > LONGEST_S:
            break
        for side, way in enumerate(ways):
            samples[side].append(_sample_s(way, loops[side]))
    ours_s, reference_s = (median(taken) / benchmark.parts for taken in samples)
    return Timing(name, benchmark.what, ours_s, benchmark.reference_name, reference_s)


def _loops_for(way: Callable[[], Any]) -> int:
    once_s = _sample_s(way, 1)
    return max(1, round(SAMPLE_S / max(once_s, 1e-9)))


def _sample_s(way: Callable[[], Any], loops: int) -> float:
    """Seconds that one call takes, averaged over some calls in a row."""
    begun = time.perf_counter()
    for _ in range(loops):
        way()
    return (time.perf_counter() - begun) / loops
