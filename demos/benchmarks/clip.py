"""A clip of the library loaded again, from the arrays that its first import left, against importing its file."""

from __future__ import annotations

import numpy as np

from demos.benchmarks import Benchmark


def prepare() -> Benchmark:
    from engine.body.skeleton import Body
    from engine.clips.cache import cache_folder, load, save
    from engine.clips.synthetic import sway
    from engine.core.errors import EnvironmentTrouble

    # the embedded clip stands in for an imported one: it is there on every machine
    made = sway()
    save(made)
    if load(made.key) is None:
        raise EnvironmentTrouble("unwritable", "the cache cannot be written; set BRACE_CACHE", str(cache_folder()))

    def check(ours, reference):
        np.testing.assert_array_equal(ours.pose.rotations, reference.pose.rotations)
        for field in Body._fields:
            np.testing.assert_array_equal(getattr(ours.body, field), getattr(reference.body, field))

    return Benchmark("a clip, the second time", lambda: load(made.key), "making it anew", sway, check)
