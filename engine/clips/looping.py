"""Whether a clip can go round, and where it best does.

Two kinds do, as an animator would have it: a steady gait (every stride like the one before) goes round over as many
whole strides as it has, and a clip that ends standing as it began goes round whole. Anything else plays to its end and
holds.

The frames at which it goes round are those where pose and velocity are most alike: joints relative to the pelvis and
its heading, in metres, and their velocities over a tenth of a second. What still differs is faded over
(`engine.clips.clip.Loop`)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, PELVIS, Body, Pose
from engine.clips.clip import Loop
from engine.maths import rotations

GAIT_SPEED_MPS = 0.6
STRIDE_S = (0.4, 1.8)
# root mean square over the joints: from one stride to the next, and at the seam itself
STRIDE_DIFFERENCE_M, SEAM_DIFFERENCE_M = 0.09, 0.055
VELOCITY_WEIGHT_S = 0.1
GAIT_BLEND_S, STAND_BLEND_S = 0.2, 0.4
STILL_MPS = 0.15
# a loop may leave out this much of a gait at either end (parts of a stride), and this much of a clip that stands
GAIT_MARGIN, STAND_MARGIN, STAND_MARGIN_S = 0.45, 0.2, 0.75
# a heading that a gait changes by less in one round is a wobble, not a turn
STRAIGHT_RAD = np.radians(15.0)
MOST_CANDIDATES = 200


class Features(NamedTuple):
    """What is compared between frames."""

    shape: np.ndarray  # (F, 3 J + 4) metres
    drift: np.ndarray  # (F, 3) metres: the pelvis's velocity in its own heading over VELOCITY_WEIGHT_S
    heading: np.ndarray  # (F,) radians, unwrapped


def find_loop(pose: Pose, body: Body, planted: np.ndarray, fps: float) -> Loop:
    """The loop of a clip, or one that holds."""
    frames = len(pose.root_m)
    gait = _is_gait(pose, body, fps)
    margin = int(GAIT_MARGIN * frames if gait else min(STAND_MARGIN * frames, STAND_MARGIN_S * fps))
    blend = min(round((GAIT_BLEND_S if gait else STAND_BLEND_S) * fps), int(0.6 * margin))
    if blend < 2:
        return Loop()
    # the motion that fades in leads up to `first`, so there must be a blend of it
    first, last = np.arange(blend, margin), np.arange(frames - margin, frames - 2)
    if not gait:
        still = _stands_still(pose, planted, fps)
        first, last = first[still[first]], last[still[last]]
    if len(first) == 0 or len(last) == 0:
        return Loop()
    features = _features(pose, body, fps)
    found, difference = _best_pair(features, first, last, planted)
    return _loop(pose, body, features, planted, *found, blend) if difference < SEAM_DIFFERENCE_M else Loop()


def _features(pose: Pose, body: Body, fps: float) -> Features:
    positions, _ = joints_of(body, pose)
    heading = np.unwrap(rotations.heading(pose.rotations[:, 0]))
    back = rotations.about_z(-heading)
    relative = rotations.rotate(back[:, None], positions - positions[:, :1])
    shape = np.concatenate([relative.reshape(len(heading), -1), positions[:, 0, 2:]], axis=1)
    velocity = np.gradient(shape, axis=0) * fps * VELOCITY_WEIGHT_S
    drift = rotations.rotate(back, np.gradient(positions[:, 0], axis=0)) * fps * VELOCITY_WEIGHT_S
    return Features(np.concatenate([shape, velocity], axis=1) / np.sqrt(positions.shape[1]), drift, heading)


def _difference(features: Features, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """How unlike frames a and b are, metres; a and b broadcast."""
    shape = features.shape[a] - features.shape[b]
    drift = features.drift[a] - features.drift[b]
    return np.sqrt(np.sum(shape * shape, axis=-1) + np.sum(drift * drift, axis=-1))


def _is_gait(pose: Pose, body: Body, fps: float) -> bool:
    """A steady gait: it travels, and some stride later every frame looks the same."""
    travelled = np.linalg.norm(np.diff(pose.root_m[:, :2], axis=0), axis=-1).sum()
    frames = len(pose.root_m)
    if travelled * fps / max(frames - 1, 1) < GAIT_SPEED_MPS:
        return False
    features = _features(pose, body, fps)
    strides = range(max(2, round(STRIDE_S[0] * fps)), min(round(STRIDE_S[1] * fps), int(0.75 * frames)))
    alike = [_difference(features, np.arange(frames - n), np.arange(n, frames)).mean() for n in strides]
    return len(alike) > 0 and min(alike) < STRIDE_DIFFERENCE_M


def _stands_still(pose: Pose, planted: np.ndarray, fps: float) -> np.ndarray:
    """(F,) both feet planted and the pelvis nearly at rest."""
    speed = np.linalg.norm(np.gradient(pose.root_m, axis=0), axis=-1) * fps
    return planted.all(axis=1) & (speed < STILL_MPS)


def _best_pair(
    features: Features, first: np.ndarray, last: np.ndarray, planted: np.ndarray
) -> tuple[tuple[int, int], float]:
    """The pair of frames most alike, a longer loop preferred a little: a coarse search, then a fine one around its
    best."""
    stride = max(1, (len(first) + len(last)) // (2 * MOST_CANDIDATES))
    pair = _search(features, first[::stride], last[::stride], planted)
    near = (first[np.abs(first - pair[0]) <= stride], last[np.abs(last - pair[1]) <= stride])
    pair = _search(features, *near, planted)
    return pair, float(_difference(features, np.array(pair[0]), np.array(pair[1])))


def _search(features: Features, first: np.ndarray, last: np.ndarray, planted: np.ndarray) -> tuple[int, int]:
    best, found = np.inf, (int(first[0]), int(last[-1]))
    for a in first:
        length = (last - a) / len(features.heading)
        cost = _difference(features, np.array([a]), last) + 0.02 * (1.0 - length)
        cost = cost + np.where((planted[a] == planted[last]).all(axis=-1), 0.0, 1.0)
        k = int(np.argmin(cost))
        if cost[k] < best:
            best, found = float(cost[k]), (int(a), int(last[k]))
    return found


def _loop(pose: Pose, body: Body, features: Features, planted: np.ndarray, first: int, last: int, blend: int) -> Loop:
    """The loop with what one round adds to the path: where `last` is, seen from `first`; by the standing feet, so that
    they do not slide."""
    yaw = float(features.heading[last] - features.heading[first])
    if abs(yaw) < STRAIGHT_RAD:
        yaw = 0.0
    positions, _ = joints_of(body, Pose(pose.root_m[[first, last]], pose.rotations[[first, last]]))
    marks = [ankle for side, ankle in enumerate(ANKLES) if planted[first, side] and planted[last, side]] or [PELVIS]
    place = positions[:, marks].mean(axis=1)
    moved = place[1] - rotations.rotate(rotations.about_z(yaw), place[0])
    return Loop(float(first), float(last), float(blend), float(moved[0]), float(moved[1]), yaw)
