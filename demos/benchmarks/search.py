"""One search for a motion to go on with after a blow (thesis 4.1.3), against every window compared in numpy."""

from __future__ import annotations

import numpy as np

from demos.benchmarks import Benchmark

WORSE_SHARE = 0.02  # how much farther off than the nearest window of all the one found may be


def prepare() -> Benchmark:
    from behaviours.components import SAMPLES
    from behaviours.recover.motion_index import index_clips
    from behaviours.recover.search import Window, best_window
    from behaviours.recover.windows import sample_weight
    from behaviours.settings import Settings

    settings = Settings()
    clips = library_clips()
    ahead_s, search = settings.timing.sustained_ahead_s, settings.search
    index = index_clips(clips, clips[0].body, ahead_s, search.least_left_s, search.velocity_s)
    rows = np.flatnonzero(index.standing)
    back = rows[:, None] - np.arange(SAMPLES)
    # a window of the library's, knocked some centimetres about
    chance = np.random.default_rng(4)
    off_m, off_mps = 0.05 * chance.normal(size=(2, *index.joints_m.shape[1:]))
    window = Window(index.joints_m[back[len(rows) // 3]] + off_m, index.joints_mps[back[len(rows) // 3]] + 10 * off_mps)

    def ours():
        found = best_window(index, window, "standing", search.velocity_s, search.candidates)
        return found.distance_m if found else np.inf

    sample = np.array([sample_weight(k, SAMPLES) for k in range(SAMPLES)])
    weight = (sample / sample.sum())[:, None] * index.share
    joints_m, joints_mps = index.joints_m[back], search.velocity_s * index.joints_mps[back]

    def in_numpy():
        """(N, S, J, 3) at once: the least root mean square left by the best turn and shift."""
        ours_m, ours_mps = window.joints_m, search.velocity_s * window.joints_mps
        p = ours_m - np.einsum("sj,sjk->k", weight, ours_m) * (1, 1, 0)
        q = joints_m - (np.einsum("sj,nsjk->nk", weight, joints_m) * (1, 1, 0))[:, None, None]
        along = crossed = own = 0.0
        for a, b in ((p, q), (ours_mps, joints_mps)):
            along += np.einsum("sj,nsj->n", weight, a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1])
            crossed += np.einsum("sj,nsj->n", weight, a[..., 1] * b[..., 0] - a[..., 0] * b[..., 1])
            flat = (a[..., :2] ** 2).sum(axis=-1) + (b[..., :2] ** 2).sum(axis=-1) + (a[..., 2] - b[..., 2]) ** 2
            own += np.einsum("sj,nsj->n", weight, flat)
        return float(np.sqrt((own - 2.0 * np.hypot(along, crossed)).min()))

    def check(ours, reference):
        assert reference - 1e-9 <= ours <= reference * (1.0 + WORSE_SHARE)

    return Benchmark(f"one search through {len(rows)} windows", ours, "numpy, all windows at once", in_numpy, check)


def library_clips() -> tuple:
    """The clips of the library that are here, on one body."""
    from engine.body.anthropometry import standard_body
    from engine.clips.library import find_clip, list_clips
    from engine.clips.retarget import retarget_clip

    body = standard_body()
    return tuple(retarget_clip(find_clip(listed.name), body) for listed in list_clips() if listed.ready)
