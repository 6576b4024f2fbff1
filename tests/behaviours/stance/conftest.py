"""A body, and what the tests of stances measure on it."""

import numpy as np
import pytest

from engine.body.anthropometry import standard_body


@pytest.fixture(scope="session")
def body():
    return standard_body()


@pytest.fixture(scope="session")
def turned_deg():
    """How far each joint turns from one pose's rotations (J, 4) to another's, degrees."""

    def between(a, b):
        return np.degrees(2.0 * np.arccos(np.clip(np.abs((a * b).sum(axis=-1)), 0.0, 1.0)))

    return between
