"""The torso (section 5.2, second appendix): the spine's shape classes and the collar bones.

The spine's bending in the sagittal plane (X) and in the coronal one (Z) belongs each to a class: a row of weights
over its four joints. A degree of freedom is amplitude * weight, radians (eq. 1 to 4). The twist (Y) is shared equally
by the four. Each collar bone turns about Y (forward, back) and Z (up, down); the two are *aligned*, both shoulders
the same way, or *opposed*, one rigid unit.
"""

from __future__ import annotations

import numpy as np

from behaviours.stance import frame
from engine.body.skeleton import BACK, CLAVICLES, HEAD, NECK, WAIST
from engine.maths import quaternion
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

SHAPE_CLASSES = ("Straight", "LargeS", "LargeC", "SmallS", "SmallC")
STRAIGHT, LARGE_S, LARGE_C, SMALL_S, SMALL_C = SHAPE_CLASSES
COLLAR_STATES = ("aligned", "opposed")
ALIGNED, OPPOSED = COLLAR_STATES

# the paper's abdomen, chest, neck, head
SPINE = (WAIST, BACK, NECK, HEAD)

# [class, plane X or Z, joint of SPINE]
WEIGHTS = np.array(
    [
        [[0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]],
        [[0.15, -0.1, -0.12, -0.1], [0.08, -0.1, -0.12, -0.06]],
        [[0.15, 0.15, 0.15, 0.1], [0.15, 0.15, 0.12, 0.06]],
        [[0.15, -0.2, 0.06, -0.1], [0.15, -0.2, 0.12, 0.06]],
        [[-0.15, 0.3, 0.15, 0.1], [-0.15, 0.3, 0.12, 0.06]],
    ]
)

# the solver's unknowns, in the order of its line searches
UNKNOWNS = ("coronal", "sagittal", "transverse", "collar_y", "collar_z", "abdomen_x")
CORONAL, SAGITTAL, TRANSVERSE, COLLAR_Y, COLLAR_Z, ABDOMEN_X = range(len(UNKNOWNS))


@inner_kernel
def spine_angles(classes, unknowns, joint):
    """The paper's angles (X, Y, Z) of one joint of SPINE. classes: rows of WEIGHTS for the sagittal and coronal
    plane.
    """
    x = unknowns[SAGITTAL] * WEIGHTS[classes[0], 0, joint]
    z = unknowns[CORONAL] * WEIGHTS[classes[1], 1, joint]
    if joint == 0:
        x += unknowns[ABDOMEN_X]
    return (x, unknowns[TRANSVERSE] / len(SPINE), z)


@inner_kernel
def collar_angles(opposed, unknowns, side):
    """Y and Z of one collar bone. Aligned: + is both shoulders back, both up; opposed: + turns left, lifts the left
    one.
    """
    y, z = unknowns[COLLAR_Y], unknowns[COLLAR_Z]
    if side == 1:
        y = y if opposed[0] else -y
        z = z if opposed[1] else -z
    return (y, z)


@njit(cache=True)
def shape_torso(body, classes, opposed, unknowns, rotations):
    """Writes the local rotations (J, 4) of spine and collar bones.

    Amplitudes inside `amplitude_bounds` break no limit; the abdomen's offset, which adds to one of them, is held at
    it here.
    """
    for k in range(len(SPINE)):
        x, y, z = spine_angles(classes, unknowns, k)
        if k == 0:
            x = min(max(x, body.limit_low_rad[WAIST, 1]), body.limit_high_rad[WAIST, 1])
        quaternion.put(rotations, SPINE[k], frame.rotation(x, y, z))
    for side in range(2):
        y, z = collar_angles(opposed, unknowns, side)
        quaternion.put(rotations, CLAVICLES[side], frame.rotation(0.0, y, z))


@njit(cache=True)
def amplitude_bounds(body, classes, opposed):
    """(6, 2) how far each unknown may go before a joint meets its limit: shapes stop there whole, they do not
    deform.
    """
    bounds = np.empty((len(UNKNOWNS), 2))
    low, high = body.limit_low_rad, body.limit_high_rad
    for u in range(len(UNKNOWNS)):
        bounds[u, 0], bounds[u, 1] = -4.0, 4.0
    for k in range(len(SPINE)):
        j = SPINE[k]
        _narrow(bounds, CORONAL, WEIGHTS[classes[1], 1, k], low[j, 0], high[j, 0])
        _narrow(bounds, SAGITTAL, WEIGHTS[classes[0], 0, k], low[j, 1], high[j, 1])
        _narrow(bounds, TRANSVERSE, 1.0 / len(SPINE), low[j, 2], high[j, 2])
    for side in range(2):
        j = CLAVICLES[side]
        y_sign, z_sign = 1.0, 1.0
        if side == 1:
            y_sign = 1.0 if opposed[0] else -1.0
            z_sign = 1.0 if opposed[1] else -1.0
        _narrow(bounds, COLLAR_Y, y_sign, low[j, 2], high[j, 2])
        _narrow(bounds, COLLAR_Z, z_sign, low[j, 0], high[j, 0])
    bounds[ABDOMEN_X, 0], bounds[ABDOMEN_X, 1] = low[WAIST, 1], high[WAIST, 1]
    return bounds


@inner_kernel
def _narrow(bounds, unknown, weight, low, high):
    if weight == 0.0:
        return
    a, b = low / weight, high / weight
    bounds[unknown, 0] = max(bounds[unknown, 0], min(a, b))
    bounds[unknown, 1] = min(bounds[unknown, 1], max(a, b))
