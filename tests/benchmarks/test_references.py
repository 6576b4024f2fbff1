"""Each benchmark of `brace bench`: both ways give the same result, and ours is timed here too (--benchmark-enable)."""

import pytest

from demos import benchmarks
from demos.benchmarks import NAMES, load


@pytest.mark.parametrize("name", NAMES)
def test_both_ways_agree(name, benchmark):
    pair = load(name)
    pair.check(benchmark(pair.ours), pair.reference())


def test_medians_are_of_single_calls(monkeypatch):
    """By a clock of its own, on which one way takes ten times as long as the other, and a part of either a fourth."""
    now_s = 0.0

    def takes(seconds):
        def way():
            nonlocal now_s
            now_s += seconds

        return way

    pair = benchmarks.Benchmark("naps", takes(0.002), "a long nap", takes(0.02), lambda ours, reference: None, parts=4)
    monkeypatch.setattr(benchmarks, "load", lambda name: pair)
    monkeypatch.setattr(benchmarks.time, "perf_counter", lambda: now_s)
    timing = benchmarks.measure("naps")
    assert timing.ours_s == pytest.approx(0.0005)
    assert timing.times_faster == pytest.approx(10)
