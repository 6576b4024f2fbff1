"""Measures of a run, from what an Observer has kept: the figures that `brace react` reports and `brace bench
--motion` sums up. Those of the blow itself are in `behaviours.measure.head_measures`.
"""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import numpy as np

from behaviours.components import Phase
from behaviours.measure.observing import HandWay, Line, Seam, Track
from behaviours.timing import TICK_S
from engine.body import support
from engine.body.kinematics import com_of, joints_of
from engine.body.limits import excess_rad
from engine.body.overlap import overlaps_m, pair_name
from engine.body.skeleton import JOINTS, NECK, WRISTS

OWN = (
    Phase.STARTLE,
    Phase.PROTECT,
    Phase.HOLD,
    Phase.RECOVER_BLEND,
    Phase.RECOVER_RETURN,
)  # ours, outside the physics alone
PHYSICS = (Phase.RESPOND, Phase.DOWN)


class Worst(NamedTuple):
    """The greatest of something over a run: how much, at which tick, and of what."""

    value: float
    tick: int
    what: str


def ours(track: Track) -> np.ndarray:
    """(T,) bool: the ticks of protection and recovery."""
    return np.isin(track.phase, OWN)


def foot_slide_max_m(track: Track) -> float:
    """The farthest that any foot goes, along or off the ground, while it is flagged planted without a break."""
    return drift_max_m(track, np.array(track.planted) & ours(track)[:, None])


def settling_feet(track: Track) -> np.ndarray:
    """(T, 2) bool: feet that stand by the plan but are not flagged planted yet, since what a seam, or a blow, has left
    over still moves them.
    """
    return np.array(track.stands) & ~np.array(track.planted) & ours(track)[:, None]


def drift_max_m(track: Track, flags: np.ndarray) -> float:
    """The farthest that any point of a sole goes from where it was when its flag (T, 2) was raised."""
    positions, orientations = joints_of(track.body, track.pose)
    worst = 0.0
    for side in range(2):
        for first, last in runs(flags[:, side]):
            soles = np.array(
                [support.sole_points(track.body, positions[k], orientations[k])[side] for k in range(first, last + 1)]
            )
            worst = max(worst, float(np.linalg.norm(soles - soles[0], axis=-1).max()))
    return worst


def reacting(track: Track) -> np.ndarray:
    """(T,) bool: from the first tick of a reaction to the end of the run, so that what a seam has left over counts."""
    return np.maximum.accumulate(np.not_equal(track.phase, Phase.PLAY))


def runs(flags: np.ndarray) -> list[tuple[int, int]]:
    """First and last index of every stretch of True."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], np.asarray(flags, int), [0]])))
    return [(int(a), int(b) - 1) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def distance_from_line(points_m: np.ndarray, start_m: np.ndarray, end_m: np.ndarray) -> np.ndarray:
    """(N,) how far points (N, 3) are from a straight line, from its start on: a damped overshoot goes on beyond its
    end.
    """
    axis = end_m - start_m
    square = float((axis * axis).sum())
    t = (
        np.maximum(((points_m - start_m) * axis).sum(axis=1) / square, 0.0)
        if square > 1e-12
        else np.zeros(len(points_m))
    )
    return np.linalg.norm(points_m - (start_m + t[:, None] * axis), axis=1)


def off_line_m(line: Line, joint: int) -> float:
    """How far a blend's source has a joint off the straight line between where its two ends have it."""
    return float(distance_from_line(line.between_m[None, joint], line.start_m[joint], line.end_m[joint])[0])


def hand_line_deviation_max_m(lines: list[Line], ways: tuple[HandWay, ...] = (HandWay.STRAIGHT,)) -> float:
    """How far a blend's source takes a wrist off the straight line between its two ends (thesis 4.3), of those that go
    one of these ways: where nothing is in the way and the arm is long enough, unless others are asked for.
    """
    off_m = (
        off_line_m(line, wrist)
        for line in lines
        for wrist, way in zip(WRISTS, line.ways, strict=True)
        if way in ways
    )  # fmt: skip
    return max(off_m, default=0.0)


def hand_frames(lines: list[Line]) -> dict[str, int]:
    """How many moments of a hand there are, two a tick of a blend, by the name of its way."""
    counted = Counter(HandWay(way).name.lower() for line in lines for way in line.ways)
    return {way.name.lower(): counted[way.name.lower()] for way in HandWay}


def com_line_deviation_max_m(lines: list[Line]) -> float:
    """How far a blend's source takes the COM off the straight line between its two ends."""
    return max((float(distance_from_line(line.com_m[None], *line.com_ends_m)[0]) for line in lines), default=0.0)


def neck_line_deviation_max_m(lines: list[Line]) -> float:
    """How far a blend's source takes the neck off the straight line between its two ends."""
    return max((off_line_m(line, NECK) for line in lines), default=0.0)


def com_margin_min_m(track: Track) -> float | None:
    """The least margin of the COM inside the planted feet's polygon in protection and recovery; None without any."""
    positions, orientations = joints_of(track.body, track.pose)
    com, least = com_of(track.body, track.pose), None
    for k in np.flatnonzero(ours(track)):
        if track.planted[k].any():
            polygon = support.polygon_of(track.body, positions[k], orientations[k], track.planted[k])
            margin = float(support.margin_m(polygon, com[k, :2]))
            least = margin if least is None else min(least, margin)
    return least


def limit_excess_rad(track: Track) -> np.ndarray:
    """(T, J) how far each joint is beyond its limits, and beyond what the clip's own poses in this run overstep them
    by.
    """
    over, own = (excess_rad(track.body, pose.rotations) for pose in (track.pose, track.own))
    return np.maximum(over - np.maximum(own.max(axis=0), 0.0), 0.0)


def arm_depth_m(track: Track) -> np.ndarray:
    """(T, P) how deep each of `overlap.PAIRS` lies in each other, beyond what the clip's own poses in this run have."""
    over, own = (overlaps_m(track.body, pose) for pose in (track.pose, track.own))
    return np.maximum(over - np.maximum(own.max(axis=0), 0.0), 0.0)


def joint_limit_excess(track: Track) -> dict[str, Worst]:
    """The worst joint of every phase of a reaction, physics and the clip taken up again included, radians."""
    return _worst_by_phase(track, limit_excess_rad(track), JOINTS)


def overlap(track: Track) -> dict[str, Worst]:
    """Likewise the hand or forearm that is deepest in head, trunk or the other arm, metres."""
    depths = arm_depth_m(track)
    return _worst_by_phase(track, depths, [pair_name(k) for k in range(depths.shape[1])])


def _worst_by_phase(track: Track, values: np.ndarray, names) -> dict[str, Worst]:
    """The greatest of values (T, N) in every phase of a reaction; N of these names."""
    worst: dict[str, Worst] = {}
    chosen, phases = reacting(track), np.array(track.phase)
    for phase in dict.fromkeys(phases[chosen].tolist()):
        ticks = np.flatnonzero(chosen & np.equal(phases, phase))
        at, which = np.unravel_index(int(values[ticks].argmax()), (len(ticks), values.shape[1]))
        worst[Phase(phase).name.lower()] = Worst(
            float(values[ticks[at], which]), track.tick[ticks[at]], str(names[which])
        )
    return worst


def greatest(by_phase: dict[str, Worst]) -> Worst:
    """The worst of all phases; nothing where there was no reaction."""
    return max(by_phase.values(), key=lambda worst: worst.value, default=Worst(0.0, 0, ""))


def seam_jumps(track: Track) -> tuple[float, float]:
    """The greatest jump of any joint at any seam: metres, and m/s between the one-sided velocities."""
    jumps = [jump_of(seam) for seam in track.seams]
    return max((place.value for place, _ in jumps), default=0.0), max((speed.value for _, speed in jumps), default=0.0)


def jump_of(seam: Seam) -> tuple[Worst, Worst]:
    """The greatest jump of place, metres, and of velocity, m/s, at one seam."""
    both = (
        np.linalg.norm(seam.taken_up_m - seam.shown_m, axis=1),
        np.linalg.norm(seam.after_mps - seam.before_mps, axis=1),
    )
    place, speed = (Worst(float(jump.max()), seam.tick, JOINTS[int(jump.argmax())]) for jump in both)
    return place, speed


def fastest_in_physics(track: Track) -> Worst:
    """The greatest speed of any joint from one tick to the next under the physics alone, m/s: what a blow can do to a
    body is little beside the speed of the ball.
    """
    if len(track.phase) < 2:
        return Worst(0.0, 0, "")
    joints_m = joints_of(track.body, track.pose)[0]
    mps = np.linalg.norm(np.diff(joints_m, axis=0), axis=2) / TICK_S
    physics = np.isin(track.phase, PHYSICS)
    mps *= (physics[1:] & physics[:-1])[:, None]
    at, joint = np.unravel_index(int(mps.argmax()), mps.shape)
    return Worst(float(mps[at, joint]), track.tick[at + 1], JOINTS[joint])


def snap(track: Track) -> Worst:
    """The greatest change of any joint's velocity from one tick to the next, m/s, outside the physics: what a pop is,
    also where no seam is. Where the clip plays, on the way back to it too, only what is shown beyond it counts.
    """
    if len(track.phase) < 3:
        return Worst(0.0, 0, "")
    joints_m = joints_of(track.body, track.pose)[0]
    change_m = np.diff(joints_m, 2, axis=0)
    clips = [
        track.led_by.get(tick) if pose is None else (1.0, pose)
        for tick, pose in zip(track.tick, track.played, strict=True)
    ]
    for k in range(len(clips) - 2):
        three = [clip for clip in clips[k : k + 3] if clip is not None]
        if len(three) == 3:
            clip_m = [joints_of(track.body, pose)[0] for _, pose in three]
            change_m[k] -= three[1][0] * np.diff(clip_m, 2, axis=0)[0]
    physics = np.isin(track.phase, PHYSICS)
    chosen = reacting(track)[2:] & ~(physics[2:] | physics[1:-1] | physics[:-2])
    change_mps = np.linalg.norm(change_m, axis=2) / TICK_S * chosen[:, None]
    at, joint = np.unravel_index(int(change_mps.argmax()), change_mps.shape)
    return Worst(float(change_mps[at, joint]), track.tick[at + 1], JOINTS[joint])
