"""What every test stands on: strict floating point, deterministic search, kernels that match their sources."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

os.environ.setdefault("NUMBA_THREADING_LAYER", "workqueue")

import numpy as np
import pytest
from hypothesis import settings

from demos.kernels import forget_stale
from engine.clips.clip import Clip
from engine.clips.library import find_clip
from engine.core.errors import EnvironmentTrouble

settings.register_profile("house", derandomize=True, deadline=None, database=None, print_blob=True)
settings.load_profile("house")

ROOT = Path(__file__).resolve().parent.parent


def pytest_configure(config: pytest.Config) -> None:
    """Before any worker starts: no kernel may run older code than its source says."""
    if not hasattr(config, "workerinput"):
        forget_stale()


@pytest.fixture(autouse=True)
def _strict_floating_point():
    """Overflow, invalid operations, division by zero and underflow in numpy are faults, in every test."""
    with np.errstate(all="raise"):
        yield


@pytest.fixture(scope="session")
def shared_mocap() -> Path:
    """The folder of real motion capture that lies beside a full checkout."""
    folder = ROOT.parent / "shared" / "mocap"
    if not folder.is_dir():
        pytest.skip("the motion capture beside the checkout (../shared/mocap) is not here")
    return folder


@pytest.fixture(scope="session")
def library_clip() -> Callable[..., Clip]:
    """A clip of the library by its name; skips where it was never fetched (`./run test` fetches once)."""

    def clip_of(name: str, **wanted: Any) -> Clip:
        try:
            return find_clip(name, **wanted)
        except EnvironmentTrouble as trouble:
            pytest.skip(trouble.message)

    return clip_of
