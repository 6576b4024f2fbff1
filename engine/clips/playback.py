"""A clip at any time: between its frames, around its loop, and on along its path."""

from __future__ import annotations

import math

import numpy as np

from engine.body.skeleton import JOINT_COUNT, Pose
from engine.clips.clip import Clip
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


def sample(clip: Clip, time_s: float) -> Pose:
    """The pose at a time from the clip's start; root_m (3,), rotations (21, 4).

    After its end a looping clip goes on, its path too (a walk walks on); any other holds its last pose. Before its
    start: the first."""
    root_m, local = np.empty(3), np.empty((JOINT_COUNT, 4))
    sample_into(clip.pose.root_m, clip.pose.rotations, clip.fps, clip.loop, float(time_s), root_m, local)
    return Pose(root_m, local)


def planted_at(clip: Clip, time_s: float) -> np.ndarray:
    """Which feet stand at a time: (2,) bool, left and right."""
    frame, _, incoming, weight = where_in_loop(clip.frames, clip.fps, clip.loop, float(time_s))
    nearest = round(incoming if weight > 0.5 else frame)
    return clip.planted[min(max(nearest, 0), clip.frames - 1)].copy()


@njit(cache=True)
def where_in_loop(frames, fps, loop, time_s):
    """(frame to show, rounds already made, frame that fades in, how much of it): see `engine.clips.clip.Loop`."""
    frame = max(time_s * fps, 0.0)
    first, last, blend = loop[0], loop[1], loop[2]
    if last <= 0.0:
        return min(frame, frames - 1.0), 0.0, 0.0, 0.0
    rounds = 0.0
    if frame >= last:
        rounds = math.floor((frame - last) / (last - first)) + 1.0
        frame -= rounds * (last - first)
    if frame <= last - blend:
        return frame, rounds, frame, 0.0
    t = min((frame - (last - blend)) / blend, 1.0)
    # smootherstep: no jump in velocity or acceleration at either end
    return frame, rounds, frame - (last - first), t * t * t * (t * (6.0 * t - 15.0) + 10.0)


@njit(cache=True)
def path_after(loop, rounds):
    """What a number of rounds has carried the path on by: (x, y, yaw), the sum of a geometric series of turned
    steps."""
    x, y, yaw = loop[3], loop[4], loop[5]
    if abs(yaw) < 1e-9:
        return rounds * x, rounds * y, 0.0
    half, total = math.sin(0.5 * yaw), 0.5 * (rounds - 1.0) * yaw
    stretch = math.sin(0.5 * rounds * yaw) / half
    c, s = math.cos(total) * stretch, math.sin(total) * stretch
    return c * x - s * y, s * x + c * y, rounds * yaw


@njit(cache=True)
def sample_into(root_m, rotations, fps, loop, time_s, out_root_m, out_rotations):
    """Writes the pose at a time into (3,) and (J, 4). root_m (F, 3), rotations (F, J, 4) as in a `Clip`."""
    frame, rounds, incoming, weight = where_in_loop(len(root_m), fps, loop, time_s)
    _between_frames(root_m, rotations, frame, out_root_m, out_rotations)
    if weight > 0.0:
        _fade_in(root_m, rotations, loop, incoming, weight, out_root_m, out_rotations)
    _normalise(out_rotations)
    if rounds > 0.0:
        x, y, yaw = path_after(loop, rounds)
        _carry_on(x, y, yaw, out_root_m, out_rotations)


@inner_kernel
def _between_frames(root_m, rotations, frame, out_root_m, out_rotations):
    """Catmull-Rom through the four frames around, so that velocities are continuous too: root and quaternion components
    alike.

    Neighbouring quaternions lie in one hemisphere and a few degrees apart, where the normalised cubic and a slerp
    differ by less than their frames' noise; the slerp's velocity would jump at every frame of a 30 Hz clip."""
    count = len(root_m)
    k = min(int(frame), max(count - 2, 0))
    t = frame - k
    # past either end the motion is taken to go on straight: 2 p0 - p1
    before, after, next_ = max(k - 1, 0), min(k + 2, count - 1), min(k + 1, count - 1)
    w0, w1 = 0.5 * t * (t * (2.0 - t) - 1.0), 0.5 * (t * t * (3.0 * t - 5.0) + 2.0)
    w2, w3 = 0.5 * t * (t * (4.0 - 3.0 * t) + 1.0), 0.5 * t * t * (t - 1.0)
    if k == 0:
        w1, w2, w0 = w1 + 2.0 * w0, w2 - w0, 0.0
    if k + 2 >= count:
        w2, w1, w3 = w2 + 2.0 * w3, w1 - w3, 0.0
    for i in range(3):
        out_root_m[i] = w0 * root_m[before, i] + w1 * root_m[k, i] + w2 * root_m[next_, i] + w3 * root_m[after, i]
    for j in range(out_rotations.shape[0]):
        for i in range(4):
            out_rotations[j, i] = (
                w0 * rotations[before, j, i]
                + w1 * rotations[k, j, i]
                + w2 * rotations[next_, j, i]
                + w3 * rotations[after, j, i]
            )


@inner_kernel
def _fade_in(root_m, rotations, loop, incoming, weight, out_root_m, out_rotations):
    """Mixes the motion that leads up to the loop's first frame, carried on by one round, into what is there."""
    other_root_m, other = np.empty(3), np.empty_like(out_rotations)
    _between_frames(root_m, rotations, incoming, other_root_m, other)
    _carry_on(loop[3], loop[4], loop[5], other_root_m, other)
    for i in range(3):
        out_root_m[i] += weight * (other_root_m[i] - out_root_m[i])
    for j in range(out_rotations.shape[0]):
        inner = 0.0
        for i in range(4):
            inner += out_rotations[j, i] * other[j, i]
        side = 1.0 if inner >= 0.0 else -1.0
        for i in range(4):
            out_rotations[j, i] += weight * (side * other[j, i] - out_rotations[j, i])


@inner_kernel
def _normalise(rotations):
    for j in range(rotations.shape[0]):
        q = rotations[j]
        scale = 1.0 / math.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
        for i in range(4):
            q[i] *= scale


@inner_kernel
def _carry_on(x, y, yaw, root_m, rotations):
    """Turns a pose about the vertical through the origin and moves it, in place."""
    c, s = math.cos(yaw), math.sin(yaw)
    rx, ry = root_m[0], root_m[1]
    root_m[0], root_m[1] = c * rx - s * ry + x, s * rx + c * ry + y
    ch, sh = math.cos(0.5 * yaw), math.sin(0.5 * yaw)
    w, qx, qy, qz = rotations[0, 0], rotations[0, 1], rotations[0, 2], rotations[0, 3]
    rotations[0, 0], rotations[0, 1] = ch * w - sh * qz, ch * qx - sh * qy
    rotations[0, 2], rotations[0, 3] = ch * qy + sh * qx, ch * qz + sh * w
