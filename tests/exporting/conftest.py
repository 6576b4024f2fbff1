"""One short run that every kind of file is made from: two people, one ball that comes, strikes and flies on."""

import pytest

from behaviours.scenario import check_scenario
from behaviours.simulation import Simulation
from demos.exporting.footage import film
from engine.clips.library import find_clip

FPS = 30.0
SCENARIO = {
    "duration_s": 1.4,
    "character": [{"clip": "sway", "start_s": 0.5}, {"clip": "sway", "position_m": [0.5, 2.0], "heading_deg": 70.0}],
    "threat": [{"perceived_s": 0.4, "azimuth_deg": -35.0, "speed_mps": 26.0}],
}


def run():
    return Simulation(check_scenario(SCENARIO), lambda spec: find_clip(spec.clip))


@pytest.fixture(scope="session")
def footage():
    return film(run(), FPS, "two <people>")
