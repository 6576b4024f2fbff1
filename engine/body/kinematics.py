"""Forward kinematics and centre of mass of the canonical skeleton."""

from __future__ import annotations

import numpy as np

from engine.body.skeleton import JOINT_COUNT, PARENT, Pose
from engine.maths import quaternion, vector
from engine.maths.kernel import njit


@njit(cache=True)
def joints_into(offset_m, root_m, rotations, positions, orientations):
    """Writes where every joint is and how it is turned in the world: (J, 3) and (J, 4). Parents come first in the
    table.
    """
    for j in range(JOINT_COUNT):
        parent, local = PARENT[j], quaternion.at(rotations, j)
        if parent < 0:
            p, q = (root_m[0], root_m[1], root_m[2]), local
        else:
            turned = quaternion.at(orientations, parent)
            p = vector.add(vector.at(positions, parent), quaternion.rotate(turned, vector.at(offset_m, j)))
            q = quaternion.multiply(turned, local)
        vector.put(positions, j, p)
        quaternion.put(orientations, j, q)


@njit(cache=True)
def centre_of_mass(body, positions, orientations):
    """Hermens 2006, eq. 3.1: the mean of the body parts' centres weighted by mass. World metres."""
    x = y = z = total = 0.0
    for part in range(len(body.part_mass_kg)):
        joint = body.part_joint[part]
        mass = body.part_mass_kg[part]
        centre = quaternion.rotate(quaternion.at(orientations, joint), vector.at(body.part_com_m, part))
        com = vector.add(vector.at(positions, joint), centre)
        x += mass * com[0]
        y += mass * com[1]
        z += mass * com[2]
        total += mass
    return (x / total, y / total, z / total)


@njit(cache=True)
def _joints_of_frames(offset_m, root_m, rotations, positions, orientations):
    for f in range(len(root_m)):
        joints_into(offset_m, root_m[f], rotations[f], positions[f], orientations[f])


@njit(cache=True)
def _com_of_frames(body, positions, orientations, out):
    for f in range(len(out)):
        out[f, 0], out[f, 1], out[f, 2] = centre_of_mass(body, positions[f], orientations[f])


def joints_of(body, pose: Pose) -> tuple[np.ndarray, np.ndarray]:
    """World positions (..., J, 3) and orientations (..., J, 4) of one pose or of any number of them."""
    root_m, rotations = np.asarray(pose.root_m, float), np.asarray(pose.rotations, float)
    lead = root_m.shape[:-1]
    positions = np.empty((*lead, JOINT_COUNT, 3))
    orientations = np.empty((*lead, JOINT_COUNT, 4))
    _joints_of_frames(
        body.offset_m,
        np.ascontiguousarray(root_m.reshape(-1, 3)),
        np.ascontiguousarray(rotations.reshape(-1, JOINT_COUNT, 4)),
        positions.reshape(-1, JOINT_COUNT, 3),
        orientations.reshape(-1, JOINT_COUNT, 4),
    )
    return positions, orientations


def com_of(body, pose: Pose) -> np.ndarray:
    """World centre of mass (..., 3), metres, of one pose or of any number of them."""
    positions, orientations = joints_of(body, pose)
    out = np.empty((*positions.shape[:-2], 3))
    _com_of_frames(
        body, positions.reshape(-1, JOINT_COUNT, 3), orientations.reshape(-1, JOINT_COUNT, 4), out.reshape(-1, 3)
    )
    return out
