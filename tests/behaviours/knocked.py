"""Runs in which somebody is struck and goes on with a motion found by the search, for the tests of that."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from behaviours.scenario import check_scenario
from behaviours.scenario_spec import Scenario
from behaviours.simulation import Simulation
from engine.clips.library import find_clip

VOLLEYBALL = {"target": "head", "perceived_s": 0.5, "azimuth_deg": 30.0, "elevation_deg": 8.0, "speed_mps": 26.0}
HEAVY = {
    "kind": "custom", "target": "torso", "perceived_s": 0.5, "azimuth_deg": 10.0, "elevation_deg": 8.0,
    "speed_mps": 16.0, "speed_range_mps": [8.0, 20.0], "mass_kg": 12.0, "radius_m": 0.2,
}  # fmt: skip


def struck(threat: dict[str, Any], *, library=None, duration_s=3.0, settings=None, **character) -> Scenario:
    """Somebody who is struck once."""
    return check_scenario(
        {
            "duration_s": duration_s,
            "character": [{"recover": "new", "startle": False, **character}],
            "threat": [threat],
            "library": library,
            "settings": settings or {},
        }
    )


def played(scenario: Scenario, *, checked: bool = False) -> Simulation:
    """The run, over."""

    def find(spec):
        return find_clip(spec.clip, sex=spec.sex, body_mass_kg=spec.mass_kg)

    simulation = Simulation(scenario, find, observe=True, checked=checked)
    for _ in range(simulation.ticks):
        simulation.step()
    return simulation


def events(simulation: Simulation, kind: str) -> list[dict[str, Any]]:
    return [dict(event.data) for event in simulation.world.events if event.kind == kind]


def get_up_file(folder: Path, *, face_down: bool) -> Path:
    """A get-up of our own, in DeepMimic's format: lies for half a second, tips up about the feet, stands. No person
    gets up like that, but it starts lying on the back or the front and ends standing."""
    upright, lasts_s, frames = [1.0, 0.0, 0.0, 0.0], 1 / 60, 150
    rows = []
    for tipped in np.interp(np.arange(frames), [30, 120], [1.0, 0.0]):
        # about the file's Z, its right: positive tips backwards
        angle = (-1.0 if face_down else 1.0) * tipped * np.pi / 2
        height, back = 0.1 + 0.77 * np.cos(angle), 0.77 * np.sin(angle)
        turned = [float(np.cos(angle / 2)), 0.0, 0.0, float(np.sin(angle / 2))]
        root = [float(-back), float(height), 0.0]
        leg, arm = [*upright, 0.0, *upright], [*upright, 0.0]
        rows.append([lasts_s, *root, *turned, *upright, *upright, *leg, *arm, *leg, *arm])
    path = folder / f"tips_up_{'front' if face_down else 'back'}.json"
    path.write_text(json.dumps({"Loop": "none", "Frames": rows}))
    return path
