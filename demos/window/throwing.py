"""Throwing a ball by hand: at what, how hard, and how it must leave to get there."""

from __future__ import annotations

import math

import numpy as np

from behaviours.components import Character, Posture
from behaviours.playing import body_of
from demos.stage import pelvis_m, shown_pose
from engine.body.capsules import body_capsules, capsules_at
from engine.body.kinematics import joints_of
from engine.core.clock import TICK_RATE_HZ
from engine.core.journal import Command
from engine.maths.ballistics import GRAVITY_MPS2
from engine.maths.shapes import ray_capsule

SLOWEST_MPS, FASTEST_MPS, FULL_HOLD_S = 12.0, 30.0, 0.8  # how hard a throw is, by how long it was held
HELD_AHEAD_M = 0.5  # a ball leaves the hand this far in front of the eye
FARTHEST_M = 50.0


def throw_speed_mps(held_s: float) -> float:
    """From a lob at once to a spike at full hold."""
    return SLOWEST_MPS + (FASTEST_MPS - SLOWEST_MPS) * min(held_s / FULL_HOLD_S, 1.0)


def thrown(world, eye: np.ndarray, ray: np.ndarray, speed_mps: float) -> Command:
    """The command that throws a ball from the eye at what the ray meets first: to where that will be when it arrives,
    if its character goes on as now.
    """
    row, target = under_cursor(world, eye, ray)
    start = eye + HELD_AHEAD_M * ray
    target = target + flight_s(start, target, speed_mps) * going_mps(world, row)
    return {
        "do": "throw",
        "at": int(np.flatnonzero(world.rows(Character) == row)[0]),
        "position_m": start.tolist(),
        "velocity_mps": velocity_to(start, target, speed_mps).tolist(),
        "kind": "volleyball",
        "size": 0.5,
    }


def character_under(world, eye: np.ndarray, ray: np.ndarray) -> tuple[int, float] | None:
    """Whom a ray from the eye meets first, and how far away; None where it meets nobody."""
    nearest_m, nearest_row = math.inf, -1
    for row in world.rows(Character, Posture):
        body = body_of(world, row)
        capsules = body_capsules(body)
        ends = capsules_at(capsules, *joints_of(body, shown_pose(world, row)))
        for (start, end), radius in zip(ends, capsules.radius_m, strict=True):
            away_m = ray_capsule(eye, ray, start, end, radius, FARTHEST_M)
            if away_m < nearest_m:
                nearest_m, nearest_row = away_m, int(row)
    return (nearest_row, nearest_m) if nearest_row >= 0 else None


def under_cursor(world, eye: np.ndarray, ray: np.ndarray) -> tuple[int, np.ndarray]:
    """Whom a ray from the eye meets first, and where (3,); else who is nearest to it, and the point beside them."""
    met = character_under(world, eye, ray)
    if met:
        return met[0], eye + met[1] * ray
    rows = [int(row) for row in world.rows(Character, Posture)]
    depths = {row: max(1.0, float(np.sum((pelvis_m(world, row) - eye) * ray))) for row in rows}
    beside = {row: float(np.sum((eye + depths[row] * ray - pelvis_m(world, row)) ** 2)) for row in rows}
    row = min(rows, key=beside.__getitem__)
    return row, eye + depths[row] * ray


def velocity_to(start: np.ndarray, target: np.ndarray, speed_mps: float) -> np.ndarray:
    """The velocity that takes a ball without drag from start to target in the time that the straight way would take."""
    time_s = flight_s(start, target, speed_mps)
    return (target - start) / time_s - 0.5 * np.array(GRAVITY_MPS2) * time_s


def flight_s(start: np.ndarray, target: np.ndarray, speed_mps: float) -> float:
    """How long the straight way takes."""
    return max(math.dist(start, target) / speed_mps, 1e-3)


def going_mps(world, row: int) -> np.ndarray:
    """(3,) how fast a character goes along the floor now."""
    posture = world[Posture]
    moved_m = posture.root_m[row] - posture.before_root_m[row]
    return TICK_RATE_HZ * moved_m * (1.0, 1.0, 0.0)
