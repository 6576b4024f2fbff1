"""Continuity at every seam: what is left of the old motion dies away on top of the new one.

Where one source of poses takes over from another (a clip from a blend, the simulation from a clip), the sources leave
a jump in position or in velocity. It is kept as an offset with a velocity that decays as a critically damped spring
(Bollo 2016, "Inertialization"; Holden 2023), so that what is shown is continuous in both, whatever the sources do.
"""

from __future__ import annotations

import numpy as np

from engine.body.skeleton import HIPS, JOINT_COUNT, KNEES
from engine.maths import quaternion, springs, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

SNATCHED_RADPS = 40.0  # no leg turns faster: the fastest of kicks come near it


@inner_kernel
def remaining(offset, velocity, elapsed_s, half_life_s):
    """What is left of an offset let go with a velocity, after a time: three numbers. Same units as the offset."""
    return springs.critical3(offset, velocity, (0.0, 0.0, 0.0), half_life_s, elapsed_s)[0]


@njit(cache=True)
def turn_from(source, shown):
    """The rotation vector, in the parent's frame, that takes the source's orientation to the shown one."""
    return quaternion.to_rotation_vector(quaternion.multiply(shown, quaternion.conjugate(source)))


@inner_kernel
def turned_by(source, offset):
    """The source's orientation with a rotation-vector offset on top."""
    return quaternion.normalise(quaternion.multiply(quaternion.from_rotation_vector(offset), source))


@njit(cache=True)
def _keep(out, now, ahead, dt_s):
    """Writes an offset and its velocity from its values now and a moment later."""
    for k in range(3):
        out[0, k] = now[k]
        out[1, k] = (ahead[k] - now[k]) / dt_s


@njit(cache=True)
def measure_seam(
    source_root, source_rot, later_root, later_rot, root, rot, ahead_root, ahead_rot, dt_s, out_root, out_joints
):
    """What the shown motion had beyond the new source, at the last shown tick.

    `source` is the new source at the last shown tick and `later` a moment on; `root`, `rot` what is shown at that tick,
    `ahead` that motion carried on for the same moment. Writes offsets and velocities: (2, 3) and (2, J, 3).
    """
    _keep(
        out_root,
        (root[0] - source_root[0], root[1] - source_root[1], root[2] - source_root[2]),
        (ahead_root[0] - later_root[0], ahead_root[1] - later_root[1], ahead_root[2] - later_root[2]),
        dt_s,
    )
    for j in range(JOINT_COUNT):
        _keep(out_joints[:, j], turn_from(source_rot[j], rot[j]), turn_from(later_rot[j], ahead_rot[j]), dt_s)


@njit(cache=True)
def calm_legs(joints):
    """Takes out of what a seam leaves over, (2, J, 3), speeds of hip and knee that are no motion, in place.

    Of a leg that is dead straight the knee leaves at a speed without bounds, and a tick of that would fold the leg the
    wrong way and turn it over. Its foot and its length have residuals of their own, so hardly any of it is kept, both
    joints in proportion; up to SNATCHED_RADPS nothing is taken away.
    """
    for side in range(2):
        fastest = max(vector.length(vector.at(joints[1], HIPS[side])), vector.length(vector.at(joints[1], KNEES[side])))
        if fastest > SNATCHED_RADPS:
            share = (SNATCHED_RADPS / fastest) ** 2
            for k in range(3):
                joints[1, HIPS[side], k] *= share
                joints[1, KNEES[side], k] *= share


@njit(cache=True)
def carry_on(root, rot, before_root, before_rot, ahead_root, ahead_rot):
    """A motion carried on, evenly, for as long as it took from `before` to now. Writes (3,) and (J, 4)."""
    for k in range(3):
        ahead_root[k] = 2.0 * root[k] - before_root[k]
    for j in range(JOINT_COUNT):
        q = quaternion.normalise(
            quaternion.multiply(quaternion.multiply(rot[j], quaternion.conjugate(before_rot[j])), rot[j])
        )
        for k in range(4):
            ahead_rot[j, k] = q[k]


@njit(cache=True)
def add_remaining(root, rotations, offset_root, offset_joints, elapsed_s, half_life_s):
    """Adds what is left of the last seam to a pose, in place."""
    r = remaining(offset_root[0], offset_root[1], elapsed_s, half_life_s)
    for k in range(3):
        root[k] += r[k]
    for j in range(JOINT_COUNT):
        q = turned_by(rotations[j], remaining(offset_joints[0, j], offset_joints[1, j], elapsed_s, half_life_s))
        for k in range(4):
            rotations[j, k] = q[k]


def nothing_left(residual, row: int) -> None:
    """Forgets the residual of one row: the source is shown as it is."""
    for name in ("root", "joints", "beyond", "ankles", "ankle_turns", "stretch", "deeper_m"):
        getattr(residual, name)[row] = np.zeros_like(getattr(residual, name)[row])
