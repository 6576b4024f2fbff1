"""From behind: hands behind the head, elbows around its sides, and a smooth way there as the threat goes round."""

import math

import numpy as np
import pytest

from behaviours.rules.wrap import around_head, wrap_share
from behaviours.settings import Settings, Wrap
from engine.body.kinematics import joints_of
from engine.body.skeleton import BACK, ELBOWS, HEAD, WRISTS
from engine.maths import quaternion
from tests.behaviours.people import BODY, coming, met


def test_the_share_runs_from_block_to_wrap_between_its_two_dots():
    dots = (0.5, 0.15, 0.0, -0.15, -0.9)
    shares = [wrap_share((1.0, 0.0, 0.0), (d, math.sqrt(1 - d * d), 0.0), Wrap()) for d in dots]
    assert shares == pytest.approx([0.0, 0.0, 0.5, 1.0, 1.0])


@pytest.mark.parametrize("azimuth", [135, -150, 175])
def test_hands_are_behind_the_head_and_elbows_before_it(azimuth):
    found = met(coming(azimuth))
    assert found.choices.wrap == 1.0
    positions, orientations = joints_of(BODY, found.sustained)
    for side in range(2):
        palm = positions[WRISTS[side]] + quaternion.rotate(orientations[WRISTS[side]], BODY.palm_m[side])
        hand = quaternion.unrotate(orientations[HEAD], palm - positions[HEAD])
        elbow = quaternion.unrotate(orientations[BACK], positions[ELBOWS[side]] - positions[HEAD])
        assert hand[0] < -0.05  # behind
        assert elbow[0] > quaternion.unrotate(orientations[BACK], palm - positions[HEAD])[0] + 0.1  # around the side
        assert (elbow[1] > 0.0) == (side == 0)


def test_frontal_threats_are_blocked():
    assert met(coming(20)).choices.wrap == 0.0


def test_a_palm_never_goes_through_the_head():
    centre = (0.0, 0.0, 1.6)
    for share in np.linspace(0, 1, 21):
        path = (0.25 - 0.5 * share, 0.02, 1.6)  # straight through
        assert np.linalg.norm(np.subtract(around_head(path, centre, 0.12), centre)) >= 0.12 - 1e-9


@pytest.mark.parametrize(
    ("size", "first", "last", "most_m"),
    [(0.0, 70, 100, 0.09), (0.3, 70, 100, 0.09), (0.5, 70, 110, 0.09), (0.7, 60, 95, 0.20)],
)
def test_hands_do_not_jump_as_the_threat_goes_round(size, first, last, most_m):
    """Half a degree of azimuth moves hands and elbows by some centimetres, through block, mixture and wrap.

    The whole way from before the face to behind the head lies within some 17 degrees, earlier for a large threat.
    """
    before, farthest = None, 0.0
    for azimuth in np.arange(first, last, 0.5):
        arms = joints_of(BODY, met(coming(azimuth, size=size)).rules)[0][list(WRISTS + ELBOWS)]
        if before is not None:
            farthest = max(farthest, np.linalg.norm(arms - before, axis=1).max())
        before = arms
    assert farthest < most_m


def test_the_dots_are_settings():
    always = Settings()._replace(wrap=Wrap(behind_low=1.1, behind_high=1.2))
    assert met(coming(20), settings=always).choices.wrap == 1.0
