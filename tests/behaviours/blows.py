"""Blows from a light tap to a knock-down, each thrown once and looked at by many tests."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from behaviours.components import Flight, Phase
from engine.body.capsules import Capsules, body_capsules, capsules_at
from engine.body.kinematics import joints_of
from engine.body.skeleton import Pose
from engine.maths import shapes
from tests.behaviours.runs import simulation_of, track_of

BALL = {"kind": "custom", "perceived_s": 0.3, "elevation_deg": 5.0, "speed_range_mps": [4.0, 30.0]}
TAP = {**BALL, "target": "left_wrist", "mass_kg": 0.27, "radius_m": 0.105, "speed_mps": 8.0}
SPIKE = {"target": "head", "perceived_s": 0.3, "elevation_deg": 5.0, "speed_mps": 28.0}


def heavy(mass_kg: float, target: str = "torso", speed_mps: float = 7.0) -> dict[str, Any]:
    """A ball as dense as a filled one of 25 kg and 20 cm."""
    return {
        **BALL,
        "target": target,
        "mass_kg": mass_kg,
        "radius_m": 0.2 * (mass_kg / 25.0) ** (1 / 3),
        "speed_mps": speed_mps,
    }


class Blow(NamedTuple):
    """A run and where its only ball was at every tick."""

    simulation: Any
    ball_m: np.ndarray  # (T, 3), nan before there is one
    radius_m: float

    @property
    def track(self):
        return track_of(self.simulation)

    @property
    def phase(self) -> np.ndarray:
        return np.array(self.track.phase)

    def ticks_of(self, *phases: Phase) -> np.ndarray:
        return np.flatnonzero(np.isin(self.phase, phases))

    def capsules_at(self, tick: int) -> tuple[Capsules, np.ndarray]:
        """The body's capsules and their ends in the world (C, 2, 3)."""
        shape = body_capsules(self.track.body)
        pose = Pose(self.track.root_m[tick], self.track.rotations[tick])
        return shape, capsules_at(shape, *joints_of(self.track.body, pose))

    def ball_depth_m(self, tick: int) -> float:
        """How deep the ball is in any part of the body."""
        shape, ends = self.capsules_at(tick)
        gaps = [shapes.distance_to_segment(a, b, self.ball_m[tick]) for a, b in ends]
        return float((self.radius_m + shape.radius_m - gaps).max())

    def lowest_m(self, tick: int) -> float:
        """The height of the lowest point of the body."""
        shape, ends = self.capsules_at(tick)
        return float((ends[..., 2] - shape.radius_m[:, None]).min())


def thrown(threat: dict[str, Any], azimuth_deg: float = 0.0, *, duration_s: float = 2.2, **character: Any) -> Blow:
    """The run of one blow at somebody standing, simulated once."""
    return _thrown(tuple((key, _frozen(value)) for key, value in threat.items()), azimuth_deg, duration_s,
                   tuple(character.items()))  # fmt: skip


def _frozen(value):
    return tuple(value) if isinstance(value, list) else value


@cache
def _thrown(threat, azimuth_deg, duration_s, character) -> Blow:
    given = {key: list(value) if isinstance(value, tuple) else value for key, value in threat}
    simulation = simulation_of([{**given, "azimuth_deg": azimuth_deg}], duration_s=duration_s, **dict(character))
    ball_m, radius_m = [], 0.0
    for _ in range(simulation.ticks):
        simulation.step()
        rows = simulation.world.rows(Flight)
        ball_m.append(simulation.world[Flight].position_m[rows[0]].copy() if len(rows) else np.full(3, np.nan))
        radius_m = float(simulation.world[Flight].radius_m[rows[0]]) if len(rows) else radius_m
    return Blow(simulation, np.array(ball_m), radius_m)
