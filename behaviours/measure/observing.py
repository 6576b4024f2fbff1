"""Watching a run: what one character did, tick by tick, kept beside the world for reports and films. Never part of
the state.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from behaviours.blends.arm_ways import SWUNG
from behaviours.components import NOBODY, Blend, Feet, Phase, Playback, Posture, Ragdoll, Reaction
from behaviours.playing import body_of, clip_pose, clip_time_s
from behaviours.settle import feet as foot_plan
from behaviours.settle.seams import MOMENT
from behaviours.settle.settling import settled_pose
from behaviours.settle.sources import blend_ends, blended, second_end, simulated_pose
from behaviours.timing import TICK_S, ease, whole_ticks
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import ELBOWS, SHOULDERS, WRISTS, Body, Pose
from engine.body.two_bones import SOFT_REACH_M

BLENDED = (Phase.STARTLE, Phase.PROTECT, Phase.HOLD, Phase.RECOVER_RETURN)

SPARE_M = 0.001  # of an arm that is as good as stretched or folded


@dataclass
class Track:
    """One character's run; lists have one entry a tick."""

    body: Body
    tick: list[int] = field(default_factory=list)
    phase: list[int] = field(default_factory=list)
    root_m: list[np.ndarray] = field(default_factory=list)
    rotations: list[np.ndarray] = field(default_factory=list)
    planted: list[np.ndarray] = field(default_factory=list)  # flagged: may not slide
    stands: list[tuple[bool, bool]] = field(default_factory=list)  # by the plan: held, or its step yet to begin
    played: list[Pose | None] = field(default_factory=list)  # the clip's own pose, at ticks at which it plays
    led_by: dict[int, tuple[float, Pose]] = field(default_factory=dict)  # by tick: on the way back, its share and pose
    made_from: list[Pose] = field(default_factory=list)  # and its poses that a reaction was made from
    seams: list[Seam] = field(default_factory=list)
    lines: list[Line] = field(default_factory=list)
    head_mps: list[np.ndarray] = field(default_factory=list)  # (sub-steps, 3) each tick under physics, empty elsewhere
    clip: list[int] = field(default_factory=list)
    before: np.ndarray | None = None  # joints a moment before the last tick, under the phase in force then

    @property
    def pose(self) -> Pose:
        """All ticks as one pose with a leading axis."""
        return Pose(np.array(self.root_m), np.array(self.rotations))

    @property
    def own(self) -> Pose:
        """The clips' own poses in this run, with a leading axis: what is theirs is not ours."""
        poses = [*self.made_from, *(pose for pose in self.played if pose is not None)]
        return Pose(np.array([pose.root_m for pose in poses]), np.array([pose.rotations for pose in poses]))


class HandWay(IntEnum):
    """How a hand goes from one end of a blend to the other, at one moment."""

    STRAIGHT = 0
    BOWED = 1  # chosen so for the whole blend: the straight line leads through the body or where no shoulder follows
    LED = 2  # kept off its line just now, by the limits of its joints
    BEYOND_REACH = 3  # its line is farther, or nearer, than the arm goes


@dataclass(frozen=True)
class Seam:
    """One-sided positions and velocities at a tick where one source took over from another: (J, 3) each.

    A blow is a seam in place alone: both velocities are those after it.
    """

    tick: int
    into: Phase
    shown_m: np.ndarray
    taken_up_m: np.ndarray
    before_mps: np.ndarray
    after_mps: np.ndarray


@dataclass(frozen=True)
class Line:
    """What a blend's source (before any residual) makes of the straight lines of 4.3, at one tick. Metres, world."""

    tick: int
    between_m: np.ndarray  # (J, 3) joints of the source
    start_m: np.ndarray  # (J, 3) and of the blend's two ends
    end_m: np.ndarray
    ways: tuple[HandWay, HandWay]  # left, right
    com_m: np.ndarray  # (3,)
    com_ends_m: tuple[np.ndarray, np.ndarray]


class Observer:
    """Looks at a world after every tick."""

    def __init__(self, world, rows):
        self.tracks = {row: Track(body_of(world, row)) for row in rows}

    def look(self, world) -> None:
        """After a tick: world.tick is the next one, the state is that of the one before."""
        tick = world.tick - 1
        for row, track in self.tracks.items():
            if track.phase and world[Reaction].since[row] == tick and track.phase[-1] != world[Reaction].phase[row]:
                _note_seam(world, row, tick, track)
            _note(world, row, tick, track)


def _note(world, row: int, tick: int, track: Track) -> None:
    p, r = world[Posture], world[Reaction]
    track.tick.append(tick)
    track.phase.append(int(r.phase[row]))
    track.root_m.append(p.root_m[row].copy())
    track.rotations.append(p.rotations[row].copy())
    track.planted.append(world[Feet].planted[row].copy())
    track.stands.append((foot_plan.stands(world[Feet], row, 0, tick), foot_plan.stands(world[Feet], row, 1, tick)))
    track.clip.append(int(world[Playback].clip[row]))
    plays = r.phase[row] == Phase.PLAY
    track.played.append(clip_pose(world, row, clip_time_s(world, row, tick)) if plays else None)
    if r.phase[row] == Phase.RECOVER_RETURN and world[Blend].lead_s[row] > 0.0:
        progress = (tick - world[Blend].since[row]) / world[Blend].ticks[row]
        track.led_by[tick] = (ease(progress), second_end(world, row, tick))
    if r.since[row] == tick and not plays:
        track.made_from.extend(_poses_made_from(world, row))
    physics = world[Ragdoll].active[row]
    track.head_mps.append(world[Ragdoll].head_mps[row].copy() if physics else np.empty((0, 3)))
    if r.phase[row] in BLENDED and world[Blend].support[row] != NOBODY:
        track.lines.append(_line(world, row, tick, track.body))
    track.before = _joints(track.body, settled_pose(world, row, tick - MOMENT))


def _poses_made_from(world, row: int) -> list[Pose]:
    """The clip from perception to re-entry."""
    ticks = whole_ticks(world.assets.settings.timing.sustained_ahead_s)
    return [clip_pose(world, row, float(world[Reaction].clip_s[row]) + k * TICK_S) for k in range(ticks + 1)]


def _line(world, row: int, tick: int, body: Body) -> Line:
    b = world[Blend]
    source, led_m = blended(world, row, tick)
    ends = blend_ends(world, row, tick)
    joints_m = joints_of(body, source)[0]
    start_m, end_m = (end.positions for end in ends)
    left, right = (way_of(body, side, b.modes[row, side], led_m[side], joints_m) for side in range(2))
    coms_m = (np.array(ends[0].com_m), np.array(ends[1].com_m))
    return Line(tick, joints_m, start_m, end_m, (left, right), com_of(body, source), coms_m)


def way_of(body: Body, side: int, mode: int, led_m: float, joints_m: np.ndarray) -> HandWay:
    """How a hand goes; `mode` is its row of `Blend.modes`, `led_m` how far limits keep it off its way."""
    if mode == SWUNG:
        return HandWay.BOWED
    if led_m != 0.0:
        return HandWay.LED
    return HandWay.STRAIGHT if in_reach(body, side, joints_m) else HandWay.BEYOND_REACH


def in_reach(body: Body, side: int, joints_m: np.ndarray) -> bool:
    """Whether an arm is neither stretched nor folded as far as it goes: then its hand is where it was wanted."""
    upper, lower = (float(np.linalg.norm(body.offset_m[joint])) for joint in (ELBOWS[side], WRISTS[side]))
    folded = math.pi + float(body.limit_low_rad[ELBOWS[side], 1])
    least_m = math.sqrt(upper**2 + lower**2 - 2.0 * upper * lower * math.cos(folded))
    far_m = float(np.linalg.norm(joints_m[WRISTS[side]] - joints_m[SHOULDERS[side]]))
    return least_m + SPARE_M < far_m < upper + lower - SOFT_REACH_M - SPARE_M


def _note_seam(world, row: int, tick: int, track: Track) -> None:
    """Both sides of a phase that began with this tick: the seam lies at the tick before, the last that the old source
    showed.
    """
    into, moment_s = Phase(int(world[Reaction].phase[row])), MOMENT * TICK_S
    if into == Phase.RESPOND:
        track.seams.append(_blow_seam(world, row, tick, track))
        return
    seam_tick = tick - 1
    shown = _joints(track.body, (track.root_m[-1], track.rotations[-1]))
    taken_up = _joints(track.body, settled_pose(world, row, seam_tick))
    later = _joints(track.body, settled_pose(world, row, seam_tick + MOMENT))
    track.seams.append(
        Seam(tick, into, shown, taken_up, (shown - track.before) / moment_s, (later - taken_up) / moment_s)
    )


def _blow_seam(world, row: int, tick: int, track: Track) -> Seam:
    """A blow begins at the end of a tick, on what is shown then: the physics is to begin there too."""
    p, doll_m = world[Posture], _joints(track.body, simulated_pose(world, row, tick))
    mps = (_joints(track.body, simulated_pose(world, row, tick + MOMENT)) - doll_m) / (MOMENT * TICK_S)
    return Seam(tick, Phase.RESPOND, _joints(track.body, (p.root_m[row], p.rotations[row])), doll_m, mps, mps)


def _joints(body: Body, pose) -> np.ndarray:
    """(J, 3) world."""
    return joints_of(body, Pose(*pose))[0]
