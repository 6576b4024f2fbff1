"""Continuity at every seam: what is left of the old motion dies away on top of the new one.

Where one source of poses takes over from another (a clip from a blend, the simulation from a clip), the sources leave
a jump in position or in velocity. It is kept as an offset with a velocity that decays as a critically damped spring
(Bollo 2016, "Inertialization"; Holden 2023), so that what is shown is continuous in both, whatever the sources do.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from engine.body.skeleton import JOINT_COUNT
from engine.maths import quaternion, springs


@njit(cache=True)
def remaining(offset, velocity, elapsed_s, half_life_s):
    """What is left of an offset let go with a velocity, after a time: three numbers. Same units as the offset."""
    return springs.critical3(offset, velocity, (0.0, 0.0, 0.0), half_life_s, elapsed_s)[0]


@njit(cache=True)
def turn_from(source, shown):
    """The rotation vector, in the parent's frame, that takes the source's orientation to the shown one."""
    return quaternion.to_rotation_vector(quaternion.multiply(shown, quaternion.conjugate(source)))


@njit(cache=True)
def turned_by(source, offset):
    """The source's orientation with a rotation-vector offset on top."""
    return quaternion.normalise(quaternion.multiply(quaternion.from_rotation_vector(offset), source))


@njit(cache=True)
def _keep(out, now, before, dt_s):
    """Writes an offset and its velocity from its values at two ticks."""
    for k in range(3):
        out[0, k] = now[k]
        out[1, k] = (now[k] - before[k]) / dt_s


@njit(cache=True)
def measure_seam(source_root, source_rot, old_source_root, old_source_rot, root, rot, old_root, old_rot, dt_s, out_root, out_joints):
    """What the shown motion had beyond the new source, at the last shown tick.

    `source` is the new source at the last shown tick and `old_source` a tick earlier; `root`, `rot` are the shown
    poses at the same two ticks. Writes offsets and velocities: (2, 3) and (2, J, 3).
    """
    _keep(
        out_root,
        (root[0] - source_root[0], root[1] - source_root[1], root[2] - source_root[2]),
        (old_root[0] - old_source_root[0], old_root[1] - old_source_root[1], old_root[2] - old_source_root[2]),
        dt_s,
    )
    for j in range(JOINT_COUNT):
        _keep(out_joints[:, j], turn_from(source_rot[j], rot[j]), turn_from(old_source_rot[j], old_rot[j]), dt_s)


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
    for name in ("root", "joints", "ankles", "ankle_turns"):
        getattr(residual, name)[row] = np.zeros_like(getattr(residual, name)[row])
