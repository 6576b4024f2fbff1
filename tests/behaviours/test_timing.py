"""The clocks of the blends, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.settings import Settings
from behaviours.timing import ease, overshoot, time_to_contact_s


@pytest.mark.parametrize(
    ("speed", "facing", "wanted_s"), [(1, 1, 0.25), (0, 1, 1.0), (1, 0, 0.30), (0, -1, 1.4), (0.5, 1, 0.625)]
)
def test_time_to_contact_is_eq_4_1(speed, facing, wanted_s):
    assert time_to_contact_s(speed, facing, Settings().timing) == pytest.approx(wanted_s)


def test_the_text_says_the_opposite_of_the_equation():
    text = Settings().timing._replace(ttc_model="text")
    assert time_to_contact_s(1.0, 1.0, text) == pytest.approx(1.0)
    assert time_to_contact_s(0.0, -1.0, text) == pytest.approx(0.25 * 1.2)


def test_ease_and_overshoot_meet_without_a_kink():
    h = 1e-6
    assert ease(1.0) == 1.0
    assert (1.0 - ease(1.0 - h)) / h < 1e-4
    assert overshoot(0.0, 0.06, 0.5, 0.12) == 0.0
    assert overshoot(h, 0.06, 0.5, 0.12) / h < 1e-4
    swings = np.array([overshoot(t, 0.06, 0.5, 0.12) for t in np.linspace(0, 2, 400)])
    assert 0.02 < swings.max() <= 0.06
    assert swings.min() < 0.0
    assert abs(swings[-1]) < 1e-5
