"""Playing a clip: which pose it has at a time, put where the character's path lies in the world."""

from __future__ import annotations

import math

import numpy as np

from behaviours.components import Character, Phase, Playback, Posture, Reaction
from behaviours.placing import placed
from behaviours.timing import TICK_S
from behaviours.wearing import worn_pose
from engine.body.capsules import Capsules
from engine.body.kinematics import joints_of
from engine.body.skeleton import PELVIS, Body, Pose
from engine.clips.clip import Clip
from engine.clips.playback import planted_at, sample
from engine.maths import quaternion


def body_of(world, row: int) -> Body:
    """The body of the character in a row."""
    return world.assets.bodies[int(world[Character].body[row])]


def joint_frames(world, row: int) -> tuple[np.ndarray, np.ndarray]:
    """Where the joints of the character in a row are (J, 3), and how they are turned (J, 4) w x y z, in the world."""
    p = world[Posture]
    return joints_of(body_of(world, row), Pose(p.root_m[row], p.rotations[row]))


def capsules_of(world, row: int) -> Capsules:
    """The shape of the character in a row."""
    return world.assets.capsules[int(world[Character].body[row])]


def clip_of(world, row: int) -> Clip:
    """The clip that the character in a row plays."""
    return world.assets.clips[int(world[Playback].clip[row])]


def clip_time_s(world, row: int, tick: float) -> float:
    """Where in its clip a character is at a tick, if it plays on."""
    p = world[Playback]
    behind_s = max(0.0, float(p.own_pace[row]) - tick) * TICK_S
    still_s = 0.5 * pace_rise(world.assets.settings.recovery.lead_s) * behind_s * behind_s if behind_s > 0.0 else 0.0
    return float(p.offset_s[row]) + tick * TICK_S + still_s


def pace_rise(lead_s: float) -> float:
    """How fast the pace of a clip rises that is taken up again, 1/s: from none to its own in twice the lead."""
    return 0.5 / max(lead_s, 1e-6)


def pace_after(played_s: float, lead_s: float) -> float:
    """The pace, 0 to 1, that a clip has come to when so much of the lead has been played, rising evenly from none."""
    return min(1.0, math.sqrt(played_s / lead_s)) if lead_s > 0.0 else 1.0


def clip_pose(world, row: int, time_s: float) -> Pose:
    """The clip's pose at a clip time, in the world, over the character's stance."""
    p = world[Playback]
    pose = placed(sample(clip_of(world, row), max(0.0, time_s)), p.place_m[row], float(p.heading_rad[row]))
    worn = world.assets.stances[int(world[Character].body[row])]
    return pose if worn is None else worn_pose(body_of(world, row), pose, worn)


def planted_in_clip(world, row: int, time_s: float) -> np.ndarray:
    """(2,) which feet stand in the clip at a clip time."""
    return planted_at(clip_of(world, row), max(0.0, time_s))


def play_from(world, row: int, tick: int, time_s: float, pace: float) -> None:
    """Plays on so that the clip is at this time at that tick, and at this pace, which rises from there to its own."""
    p, rise = world[Playback], pace_rise(world.assets.settings.recovery.lead_s)
    behind_s = (1.0 - pace) / rise
    p.own_pace[row] = tick + behind_s / TICK_S
    p.offset_s[row] = time_s - tick * TICK_S - 0.5 * rise * behind_s * behind_s


def return_clip_s(world, row: int) -> float:
    """The clip time that a reaction goes back to."""
    return float(world[Reaction].clip_s[row]) + world.assets.settings.timing.sustained_ahead_s


def perception_clip_s(world, row: int, tick: int) -> float:
    """The clip time that a reaction starts from: the present one, or the one that an interrupted reaction set out
    from.
    """
    if world[Reaction].phase[row] == Phase.PLAY:
        return clip_time_s(world, row, tick)
    return float(world[Reaction].clip_s[row])


def heading_of(world, row: int) -> float:
    """The yaw of the pose that is shown: the frame in which a scripted threat's direction is given."""
    return float(quaternion.heading(world[Posture].rotations[row, PELVIS]))
