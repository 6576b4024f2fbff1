"""How a scripted threat comes: so that it meets its target as that will be in the rules pose, before block (A1);
or where the clip will have it, of somebody who sees nothing coming and goes on.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from behaviours.perceive.approach import Approach, plan_approach
from behaviours.perceive.perceived import PerceivedThreat, aim_of, target_centre, target_weights
from behaviours.perceive.threats import KINDS, Make
from behaviours.protect.prepare import aim_point, prepare
from behaviours.protect.task import AtPerception, triple
from behaviours.settings import Settings
from engine.body.kinematics import joints_of
from engine.body.skeleton import PELVIS, Body, Pose
from engine.maths import quaternion, vector

AIM_PASSES = 2  # the aim depends on the lean, the lean on the direction of travel, that on the aim: settled in two


class Asked(NamedTuple):
    """A scripted threat as it is asked for."""

    target: str  # see perceived.AIMS
    azimuth_rad: float  # where it comes from, in the character's heading: 0 ahead, positive its left
    elevation_rad: float
    speed_mps: float  # at contact
    ttc_s: float  # from perception to contact
    make: Make
    felt: tuple[float, float]  # its speed and size, 0 to 1, as the character takes them


def aimed(body: Body, at: AtPerception, asked: Asked, settings: Settings) -> tuple[Approach, PerceivedThreat]:
    """The flight that meets the target, and the threat that it is to the character. ValueError: an unknown target."""
    joint, offset = aim_of(body, asked.target)
    aim = target_centre(joint, offset, *joints_of(body, at.now))
    way, threat = coming_to(body, at.now, aim, asked, settings)
    for _ in range(AIM_PASSES):
        aim = aim_point(prepare(body, at, threat, settings))
        way, threat = coming_to(body, at.now, aim, asked, settings)
    return way, threat


def aimed_unseen(
    body: Body, now: Pose, later: Callable[[float], Pose], asked: Asked, settings: Settings
) -> tuple[Approach, PerceivedThreat]:
    """The flight that meets the target of somebody who does not see it: `later` is told how many seconds it takes to
    come, and answers which pose they have then.
    """
    joint, offset = aim_of(body, asked.target)
    ttc_s = asked.ttc_s
    for _ in range(AIM_PASSES):  # a low path may be shortened
        way, threat = coming_to(
            body, now, target_centre(joint, offset, *joints_of(body, later(ttc_s))), asked, settings
        )
        ttc_s = way.ttc_s
    return way, threat


def coming_to(body: Body, now: Pose, aim, asked: Asked, settings: Settings) -> tuple[Approach, PerceivedThreat]:
    """The flight to a place, and the threat that it is. World metres."""
    heading = float(quaternion.heading(now.rotations[PELVIS]))
    way = plan_approach(
        aim, heading, asked.azimuth_rad, asked.elevation_rad, asked.speed_mps, asked.ttc_s,
        radius_m=asked.make.radius_m, drag=asked.make.drag_per_m, low_path=settings.threats.low_path,
    )  # fmt: skip
    travel = vector.unit(vector.subtract(way.contact_m, way.start_m), (-1.0, 0.0, 0.0))
    tangent = vector.unit(way.contact_mps, travel)
    return way, perceive(body, now, asked.target, aim, tangent, travel, *asked.felt, asked.make.radius_m)


def perceive(
    body: Body, pose: Pose, aim: str, line_m, tangent, travel, speed_norm: float, size_norm: float, radius_m: float
) -> PerceivedThreat:
    """A threat as the rules take it. `pose` says how head and pelvis share the defence (3.4)."""
    joint, offset = aim_of(body, aim)
    head, pelvis = 1.0, 0.0
    if aim == "pelvis":
        head, pelvis = 0.0, 1.0
    elif aim != "head":
        head, pelvis = target_weights(body, line_m, *joints_of(body, pose))
    excess_m = max(0.0, radius_m - KINDS["volleyball"].radius_m)
    return PerceivedThreat(
        triple(travel), triple(tangent), triple(line_m), joint, offset,
        float(speed_norm), float(size_norm), excess_m, float(head), float(pelvis),
    )  # fmt: skip
