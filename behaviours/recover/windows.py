"""Windows of motion compared, as Zordan et al. (2005) do: joints' places and velocities, weighted by mass.

A window is a few samples of where every joint is and how it moves, the latest first. Two are laid over each other by
the one turn about the vertical and shift along the ground that brings them nearest; what is left is their difference.
"""

from __future__ import annotations

import math

import numpy as np

from engine.body.skeleton import HEAD, JOINT_COUNT, LEFT_CLAVICLE, LEFT_HIP, PARENT, PELVIS, RIGHT_HIP, SHOULDERS, Body
from engine.maths.kernel import njit

# trunk and limbs: a difference between their middles is never greater than that between their joints
GROUPS = np.array([0] * LEFT_CLAVICLE + [1] * 4 + [2] * 4 + [3] * 4 + [4] * 4)
GROUP_COUNT = 5
FEATURES = 6 * GROUP_COUNT


def joint_shares(body: Body) -> np.ndarray:
    """(J,) how much of the body's mass each joint speaks for: half of what hangs on it, half of what it ends.

    A part's own joint says where it begins, the next one where it points; a hand, a foot or a head has but one.
    """
    share = np.zeros(JOINT_COUNT)
    for joint, mass in zip(body.part_joint, body.part_mass_kg, strict=True):
        ends = np.flatnonzero(np.equal(PARENT, joint))
        share[joint] += mass if len(ends) == 0 else 0.5 * mass
        share[ends] += 0.5 * mass / max(len(ends), 1)
    return share / share.sum()


@njit(cache=True)
def sample_weight(k, samples):
    """Of a sample k strides back: highest for the latest, falling as a square (Zordan 2005). Not normalised."""
    left = (samples - k) / samples
    return left * left


@njit(cache=True)
def difference(window_m, window_mps, joints_m, joints_mps, row, share, velocity_s):
    """How a window differs from the one that ends at an index's row: (square metres, yaw, x, y).

    window_m, window_mps: (S, J, 3), world, the latest sample first; joints_m, joints_mps: (N, J, 3) of the index, one
    sample a row, so that the window there is rows `row`, `row - 1`, ... share (J,) sums to 1; a velocity counts as
    the distance it goes in velocity_s. Turning the index's window by the yaw and shifting it by (x, y) lays it best
    over the other: both in closed form (as Kovar, Gleicher and Pighin 2002, eq. 2, here with velocities).
    """
    samples = len(window_m)
    total = px = py = qx = qy = 0.0
    for k in range(samples):
        w = sample_weight(k, samples)
        for j in range(JOINT_COUNT):
            m = w * share[j]
            total += m
            px += m * window_m[k, j, 0]
            py += m * window_m[k, j, 1]
            qx += m * joints_m[row - k, j, 0]
            qy += m * joints_m[row - k, j, 1]
    px, py, qx, qy = px / total, py / total, qx / total, qy / total
    along = across = own = 0.0
    t2 = velocity_s * velocity_s
    for k in range(samples):
        w = sample_weight(k, samples) / total
        for j in range(JOINT_COUNT):
            m = w * share[j]
            ax, ay, az = window_m[k, j, 0] - px, window_m[k, j, 1] - py, window_m[k, j, 2]
            bx, by, bz = joints_m[row - k, j, 0] - qx, joints_m[row - k, j, 1] - qy, joints_m[row - k, j, 2]
            ux, uy, uz = window_mps[k, j, 0], window_mps[k, j, 1], window_mps[k, j, 2]
            vx, vy, vz = joints_mps[row - k, j, 0], joints_mps[row - k, j, 1], joints_mps[row - k, j, 2]
            along += m * (ax * bx + ay * by + t2 * (ux * vx + uy * vy))
            across += m * (ay * bx - ax * by + t2 * (uy * vx - ux * vy))
            own += m * (ax * ax + ay * ay + bx * bx + by * by + (az - bz) * (az - bz))
            own += m * t2 * (ux * ux + uy * uy + vx * vx + vy * vy + (uz - vz) * (uz - vz))
    yaw = math.atan2(across, along)
    c, s = math.cos(yaw), math.sin(yaw)
    square = max(0.0, own - 2.0 * math.sqrt(along * along + across * across))
    return square, yaw, px - (c * qx - s * qy), py - (s * qx + c * qy)


@njit(cache=True)
def nearest_of(rows, window_m, window_mps, joints_m, joints_mps, share, velocity_s):
    """The row whose window differs least, and how: (row, square metres, yaw, x, y). Of equals the lowest row.

    rows: ascending, at least one.
    """
    best, least = -1, (math.inf, 0.0, 0.0, 0.0)
    for n in range(len(rows)):
        d = difference(window_m, window_mps, joints_m, joints_mps, rows[n], share, velocity_s)
        if d[0] < least[0]:
            best, least = rows[n], d
    return best, least[0], least[1], least[2], least[3]


@njit(cache=True)
def facing(joints_m):
    """(cos, sin) of the yaw that a figure is taken to face, from its joints: across hips and shoulders, turned ahead.

    For somebody on the side, whose hips are one above the other, where the head points.
    """
    x = joints_m[LEFT_HIP, 0] - joints_m[RIGHT_HIP, 0] + joints_m[SHOULDERS[0], 0] - joints_m[SHOULDERS[1], 0]
    y = joints_m[LEFT_HIP, 1] - joints_m[RIGHT_HIP, 1] + joints_m[SHOULDERS[0], 1] - joints_m[SHOULDERS[1], 1]
    z = joints_m[LEFT_HIP, 2] - joints_m[RIGHT_HIP, 2] + joints_m[SHOULDERS[0], 2] - joints_m[SHOULDERS[1], 2]
    ahead = (y, -x)
    if x * x + y * y < 0.25 * z * z:
        ahead = (joints_m[HEAD, 0] - joints_m[PELVIS, 0], joints_m[HEAD, 1] - joints_m[PELVIS, 1])
    length = np.sqrt(ahead[0] * ahead[0] + ahead[1] * ahead[1])
    if length < 1e-9:
        return 1.0, 0.0
    return ahead[0] / length, ahead[1] / length


@njit(cache=True)
def features_into(joints_m, joints_mps, share, velocity_s, out):
    """(30,) the middles of trunk and limbs and their velocities, as seen by the figure, scaled so that the distance of
    two is a part of what `difference` measures: never more than all of it, if both face the same way."""
    c, s = facing(joints_m)
    middle_x = middle_y = 0.0
    for j in range(JOINT_COUNT):
        middle_x += share[j] * joints_m[j, 0]
        middle_y += share[j] * joints_m[j, 1]
    out[:] = 0.0
    weight = np.zeros(GROUP_COUNT)
    for j in range(JOINT_COUNT):
        g = 6 * GROUPS[j]
        x, y = joints_m[j, 0] - middle_x, joints_m[j, 1] - middle_y
        u, v = joints_mps[j, 0], joints_mps[j, 1]
        weight[GROUPS[j]] += share[j]
        out[g] += share[j] * (c * x + s * y)
        out[g + 1] += share[j] * (c * y - s * x)
        out[g + 2] += share[j] * joints_m[j, 2]
        out[g + 3] += share[j] * velocity_s * (c * u + s * v)
        out[g + 4] += share[j] * velocity_s * (c * v - s * u)
        out[g + 5] += share[j] * velocity_s * joints_mps[j, 2]
    for g in range(GROUP_COUNT):
        for k in range(6):
            out[6 * g + k] /= np.sqrt(weight[g])


@njit(cache=True)
def features_of_all(joints_m, joints_mps, share, velocity_s, out):
    for n in range(len(out)):
        features_into(joints_m[n], joints_mps[n], share, velocity_s, out[n])
