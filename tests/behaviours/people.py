"""Somebody to throw things at: standing poses, and threats from anywhere."""

from __future__ import annotations

import math

import numpy as np

from behaviours.perceive.perceived import PerceivedThreat, aim_of
from behaviours.protect.prepare import aim_point, prepare
from behaviours.protect.sustained import Protection, protect
from behaviours.protect.task import AtPerception
from behaviours.settings import Settings
from engine.body.anthropometry import standard_body
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, JOINT_COUNT, Body, Pose

BODY = standard_body()
DEFAULTS = Settings()
BOTH = np.array([True, True])


def standing(body: Body = BODY, heading_rad: float = 0.0) -> Pose:
    """Upright on the floor, arms hanging."""
    rotations = np.tile([1.0, 0.0, 0.0, 0.0], (JOINT_COUNT, 1))
    rotations[0] = (math.cos(0.5 * heading_rad), 0.0, 0.0, math.sin(0.5 * heading_rad))
    positions, _ = joints_of(body, Pose(np.zeros(3), rotations))
    return Pose(np.array([0.0, 0.0, -positions[ANKLES[0], 2] - body.sole_m[0, 0, 2]]), rotations)


def coming(
    azimuth_deg: float,
    elevation_deg: float = 5.0,
    *,
    body: Body = BODY,
    heading_rad: float = 0.0,
    speed: float = 0.5,
    size: float = 0.5,
    target: str = "head",
    weights=(1.0, 0.0),
) -> PerceivedThreat:
    """A threat on a straight path from a direction in the character's heading; its line still to be aimed."""
    azimuth, elevation = math.radians(azimuth_deg) + heading_rad, math.radians(elevation_deg)
    level = math.cos(elevation)
    travel = (-level * math.cos(azimuth), -level * math.sin(azimuth), -math.sin(elevation))
    joint, offset = aim_of(body, target)
    return PerceivedThreat(travel, travel, (0.0, 0.0, 1.5), joint, offset, speed, size, 0.0, *weights)


def met(threat: PerceivedThreat, *, body: Body = BODY, now: Pose | None = None, ahead: Pose | None = None,
        planted=BOTH, settings: Settings = DEFAULTS, **more) -> Protection:  # fmt: skip
    """The protection against a threat, its line aimed at where the target will be."""
    now = standing(body) if now is None else now
    ahead = now if ahead is None else ahead
    at = AtPerception(now, ahead, planted, **more)
    aim = aim_point(prepare(body, at, threat, settings))
    return protect(body, at, threat._replace(line_point_m=aim), settings)
