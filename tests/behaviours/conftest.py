"""Runs that several files look at: simulated once."""

from __future__ import annotations

import pytest

from tests.behaviours.runs import AHEAD, run


@pytest.fixture(scope="session")
def blocked():
    """The embedded clip, somebody who startles, a ball at the head from the front left: the whole of fig. 4.1."""
    return run([AHEAD], startle=True, duration_s=3.0)


@pytest.fixture(scope="session")
def unseen():
    """The same ball at somebody who sees nothing coming."""
    return run([AHEAD], protects=False, duration_s=2.0)


@pytest.fixture(scope="session")
def missed():
    """A ball that will pass an arm's length beside the head: nothing is touched."""
    ball = {"free": True, "position_m": [7.0, 0.25, 1.9], "velocity_mps": [-12.0, 0.0, 2.3], "released_s": 0.2}
    return run([ball], startle=False, duration_s=3.0)
