"""One character about to be hit, frozen at a time of a clip: the poses that figures compare."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from behaviours.perceive.approach import Approach
from behaviours.perceive.perceived import PerceivedThreat
from behaviours.perceive.threats import Make, make_threat
from behaviours.placing import placed
from behaviours.protect.pose_report import PoseCase, pose_case
from behaviours.protect.sustained import Protection
from behaviours.settings import Settings
from behaviours.timing import TICK_S
from behaviours.wearing import Worn
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import PELVIS, WRISTS, Body, Pose
from engine.body.support import polygon_of
from engine.clips.clip import Clip, Loop
from engine.clips.playback import planted_at, sample
from engine.maths import quaternion
from engine.render.scene import Balance, Ball, Colour, Figure

AHEAD_S, LANDING_S = 0.25, 1.5  # how much of the clip a pose may need: its look-ahead, or the way to the next landing


class Meeting(NamedTuple):
    """A threat, and the pose to meet it in. The character stands over the origin and faces +X when it perceives it."""

    body: Body
    clip: Pose  # at perception
    make: Make
    way: Approach
    threat: PerceivedThreat
    found: Protection


def meet(
    clip: Clip,
    time_s: float,
    azimuth_deg: float = 0.0,
    elevation_deg: float = 10.0,
    speed_mps: float = 26.0,
    size: float = 0.5,
    target: str = "head",
    size_means: str = "rule",
    worn: Worn | None = None,
    boldness: float = 0.0,
) -> Meeting:
    """What a character at that time of a clip does about a scripted volleyball."""
    case = PoseCase(
        0.0, azimuth_deg, elevation_deg, speed_mps, size, target, size_means=size_means, worn=worn, boldness=boldness
    )
    got = pose_case(over_origin(clip, time_s), case, Settings())
    make = make_threat("volleyball", speed_mps, size, size_means=size_means)
    return Meeting(got.body, got.clip, make, got.approach, got.threat, got.protection)


def over_origin(clip: Clip, time_s: float) -> Clip:
    """The next moments of a clip, tick by tick, moved so that they begin over the origin facing +X."""
    seconds = AHEAD_S if planted_at(clip, time_s).any() else LANDING_S
    times = time_s + TICK_S * np.arange(1 + round(seconds / TICK_S))
    first = sample(clip, time_s)
    turn, about = -float(quaternion.heading(first.rotations[PELVIS])), first.root_m[:2].copy()
    poses = [placed(sample(clip, float(t)), -about, turn, about) for t in times]
    return replace(
        clip,
        fps=1.0 / TICK_S,
        pose=Pose(np.array([pose.root_m for pose in poses]), np.array([pose.rotations for pose in poses])),
        planted=np.array([planted_at(clip, float(t)) for t in times]),
        loop=Loop(),
    )


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
    positions, orientations = joints_of(body, pose)
    return np.array(
        [np.add(positions[w], quaternion.rotate(orientations[w], body.palm_m[side])) for side, w in enumerate(WRISTS)]
    )
