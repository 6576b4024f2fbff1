"""Scenarios for tests: built in a few words, run once, looked at by many."""

from __future__ import annotations

from typing import Any

import numpy as np

from behaviours.components import Phase
from behaviours.scenario import check_scenario
from behaviours.simulation import Simulation
from engine.body.kinematics import joints_of
from engine.body.skeleton import MIRRORED
from engine.clips.library import find_clip

AHEAD = {"target": "head", "perceived_s": 0.2, "azimuth_deg": 30.0, "elevation_deg": 10.0, "speed_mps": 26.0}


def simulation_of(
    threats=(), clip="sway", find=None, duration_s=2.5, checked=False, observe=True, settings=None, **character: Any
):
    """A simulation of one character, not yet stepped. `clip` is a library name, or a Clip. What else is in the library,
    get-ups perhaps, does not count: a test is to come out the same whatever has been fetched.
    """
    name = clip if isinstance(clip, str) else clip.name
    scenario = check_scenario({
        "duration_s": duration_s, "settings": settings or {}, "library": [],
        "character": [{"clip": name, "start_s": 0.5, **character}], "threat": list(threats),
    })  # fmt: skip
    find = find or (lambda spec: find_clip(spec.clip) if isinstance(clip, str) else clip)
    return Simulation(scenario, find, observe=observe, checked=checked)


def run(*args, **kwargs) -> Simulation:
    """The same, to its end."""
    simulation = simulation_of(*args, **kwargs)
    for _ in range(simulation.ticks):
        simulation.step()
    return simulation


def track_of(simulation):
    """What the only character did."""
    return simulation.observer.tracks[0]


def events(simulation, kind: str) -> list[dict[str, Any]]:
    """Data of all events of a kind, with their tick."""
    return [{"tick": event.tick, **event.data} for event in simulation.world.events if event.kind == kind]


def phases(simulation) -> list[str]:
    """The names of the phases, in order."""
    return [row["name"] for row in simulation.report()["phases"]]


def joints_until_contact(track) -> np.ndarray:
    """(T, J, 3) world, up to the tick before the blow."""
    ticks = next((k for k, phase in enumerate(track.phase) if phase == Phase.RESPOND), len(track.phase))
    return joints_of(track.body, track.pose)[0][:ticks]


def mirrored_back(joints_m: np.ndarray) -> np.ndarray:
    """Joints (T, J, 3) seen in the mirror along the X axis."""
    return joints_m[:, list(MIRRORED)] * [1.0, -1.0, 1.0]
