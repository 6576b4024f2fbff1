"""One character about to be hit, frozen at a time of a clip: the poses that figures compare."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.approach import Approach, coming_from, plan_approach
from behaviours.perceived import PerceivedThreat, aim_of, target_centre
from behaviours.placing import placed
from behaviours.prepare import aim_point, prepare
from behaviours.protection import perceive
from behaviours.settings import Settings
from behaviours.sustained import Protection, protect
from behaviours.threats import Make, make_threat
from behaviours.timing import TICK_S, time_to_contact_s, whole_ticks
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import PELVIS, Body, Pose
from engine.body.support import polygon_of
from engine.clips.clip import Clip
from engine.clips.playback import planted_at, sample
from engine.maths import quaternion, vector
from engine.render.scene import Balance, Ball, Colour, Figure

AIM_PASSES = 3  # the aim depends on the lean, the lean on the travel, that on the aim


class Meeting(NamedTuple):
    """A threat, and the pose to meet it in. The character stands over the origin and faces +X when it perceives it."""

    body: Body
    clip: Pose  # at perception
    planted: np.ndarray  # (2,)
    make: Make
    way: Approach
    threat: PerceivedThreat
    found: Protection


def meet(
    clip: Clip, time_s: float, azimuth_deg: float = 0.0, elevation_deg: float = 10.0, speed_mps: float = 26.0,
    size: float = 0.5, target: str = "head", size_means: str = "rule", settings: Settings | None = None,
) -> Meeting:  # fmt: skip
    """What a character at that time of a clip does about a scripted volleyball."""
    settings = settings or Settings()
    body, make = clip.body, make_threat("volleyball", speed_mps, size, size_means=size_means)
    ttc_s = whole_ticks(time_to_contact_s(make.speed_norm, math.cos(math.radians(azimuth_deg)), settings.timing)) * TICK_S
    now = sample(clip, time_s)
    turn = -float(quaternion.heading(now.rotations[PELVIS]))
    about = now.root_m[:2].copy()
    now, ahead = (placed(pose, (-about[0], -about[1]), turn, about) for pose in (now, sample(clip, time_s + settings.timing.sustained_ahead_s)))
    planted = planted_at(clip, time_s)
    joint, offset = aim_of(body, target)
    aim = target_centre(joint, offset, *joints_of(body, now))
    for _ in range(AIM_PASSES):
        way = plan_approach(
            aim, 0.0, math.radians(azimuth_deg), math.radians(elevation_deg), speed_mps, ttc_s, radius_m=make.radius_m
        )
        travel = vector.unit(vector.subtract(way.contact_m, way.start_m), (-1.0, 0.0, 0.0))
        tangent = vector.unit(way.contact_mps, travel)
        threat = perceive(body, now, target, aim, tangent, travel, make.speed_norm, make.size_norm, make.radius_m)
        aim = aim_point(prepare(body, now, ahead, planted, threat, settings))
    return Meeting(body, now, planted, make, way, threat, protect(body, now, ahead, planted, threat, settings))


def posed(body: Body, pose: Pose, colour: Colour, alpha: float = 1.0) -> Figure:
    """A figure in a pose."""
    return Figure(body, *joints_of(body, pose), colour, alpha)


def balance_of(body: Body, pose: Pose, planted, colour: Colour, wanted_m=None) -> Balance:
    """Support polygon and centre of mass of a pose."""
    return Balance(polygon_of(body, *joints_of(body, pose), planted), com_of(body, pose), wanted_m, colour)


def arriving(meeting: Meeting, before_m: float = 0.0) -> Ball:
    """The ball on its line of approach, as it touches the foremost palm, or so much earlier."""
    tangent, point = np.array(meeting.threat.tangent), np.array(meeting.threat.line_point_m)
    palms = palms_of(meeting.body, meeting.found.sustained)
    foremost = max(float((point - palm) @ tangent) for palm in palms)
    return Ball(point - tangent * (foremost + meeting.make.radius_m + 0.01 + before_m), meeting.make.radius_m)


def palms_of(body: Body, pose: Pose) -> np.ndarray:
    """(2, 3) palm centres, left and right."""
    from engine.body.skeleton import WRISTS

    positions, orientations = joints_of(body, pose)
    return np.array([np.add(positions[w], quaternion.rotate(orientations[w], body.palm_m[side])) for side, w in enumerate(WRISTS)])


__all__ = ["Meeting", "arriving", "balance_of", "coming_from", "meet", "palms_of", "posed"]
