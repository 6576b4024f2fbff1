"""Each benchmark of `brace bench`: both ways give the same result, and ours is timed here too (--benchmark-enable)."""

import pytest

from demos.benchmarks import NAMES, load, measure


@pytest.mark.parametrize("name", NAMES)
def test_both_ways_agree(name, benchmark):
    pair = load(name)
    pair.check(benchmark(pair.ours), pair.reference())


def test_medians_are_of_single_calls(monkeypatch):
    """A known cost: one way sleeps ten times as long as the other."""
    import time

    from demos import benchmarks

    def naps(seconds):
        return lambda: time.sleep(seconds)

    pair = benchmarks.Benchmark("naps", naps(0.002), "a long nap", naps(0.02), lambda ours, reference: None)
    monkeypatch.setattr(benchmarks, "load", lambda name: pair)
    timing = measure("naps")
    assert timing.ours_s == pytest.approx(0.002, rel=0.5)
    assert timing.times_faster == pytest.approx(10, rel=0.5)
