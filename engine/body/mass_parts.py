"""The masses of a body part by part: de Leva's segments laid on a subject's bones, and cut where we have more joints.

Each of the 21 joints carries a part: clavicles are cut out of the upper trunk, the neck out of the head, toes out of
the foot. A cut leaves mass, centre and inertia of the whole segment what de Leva measured.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body.proportions import (
    BUILD,
    CLAVICLE_OF_UPPER_TRUNK,
    DE_LEVA,
    NECK_OF_HEAD,
    TOE_AHEAD,
    TOES_OF_FOOT,
)
from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    ELBOWS,
    HEAD,
    HIPS,
    JOINTS,
    KNEES,
    NECK,
    PELVIS,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
)


class Part(NamedTuple):
    """A body part while it is worked out: its joint, and the rest in the identity pose, seen from the pelvis."""

    joint: int
    mass_kg: float
    com_m: np.ndarray  # (3,)
    inertia_kgm2: np.ndarray  # (3, 3) about its COM


def parts_of(joints, head_top_m, fingertip_m, foot_m, sex, body_mass_kg) -> list[Part]:
    """All 21 parts, in the order of their joints.

    joints (J, 3): every joint in the identity pose, seen from the pelvis; head_top_m (3,) and fingertip_m (2, 3) in the
    frames of head and wrists; foot_m: a foot's length. ValueError if a segment has no length.
    """
    table, build = DE_LEVA[sex], BUILD[sex]
    parts = [*_trunk(table, build, joints, body_mass_kg), *_head(table, joints, head_top_m, body_mass_kg)]
    for side in range(2):
        shoulder, elbow, wrist = SHOULDERS[side], ELBOWS[side], WRISTS[side]
        hip, knee, ankle, toe = HIPS[side], KNEES[side], ANKLES[side], TOES[side]
        tip = joints[wrist] + fingertip_m[side]
        parts.append(_cylindrical(shoulder, table["upper_arm"], body_mass_kg, joints[shoulder], joints[elbow]))
        parts.append(_cylindrical(elbow, table["forearm"], body_mass_kg, joints[elbow], joints[wrist]))
        parts.append(_cylindrical(wrist, table["hand"], body_mass_kg, joints[wrist], tip))
        parts.append(_cylindrical(hip, table["thigh"], body_mass_kg, joints[hip], joints[knee]))
        parts.append(_cylindrical(knee, table["shank"], body_mass_kg, joints[knee], joints[ankle]))
        # the foot's long axis at half the ankle's height, from the back of the heel
        heel = joints[ankle] + np.array([-0.25 * foot_m, 0.0, 0.6 * (joints[toe, 2] - joints[ankle, 2])])
        foot = _foot(ankle, table["foot"], body_mass_kg, heel, heel + np.array([foot_m, 0.0, 0.0]))
        tips = joints[toe] + np.array([TOE_AHEAD * foot_m, 0.0, 0.0])
        toes = _rod(toe, TOES_OF_FOOT * foot.mass_kg, joints[toe], tips, 0.04 * foot_m)
        parts += [_cut(foot, toes), toes]
    return sorted(parts, key=lambda part: part.joint)


def _cylindrical(joint, row, body_mass_kg, start, end):
    """A segment that runs from start to end: de Leva's row turned from its own axes to the body's."""
    axis = end - start
    length = float(np.sqrt((axis * axis).sum()))
    if length < 1e-3:
        raise ValueError(f"the segment carried by {JOINTS[joint]} has no length")
    z = axis / length
    # front stays front: the sagittal axis is X as far as a bone that is not quite upright allows
    x = np.array([1.0, 0.0, 0.0]) - z[0] * z
    x /= np.sqrt((x * x).sum())
    frame = np.stack([x, np.cross(z, x), z])
    mass = row.mass * body_mass_kg
    principal = mass * (np.array(row.gyration) * length) ** 2
    return Part(joint, mass, start + row.com * axis, np.einsum("ki,k,kj->ij", frame, principal, frame))


def _foot(joint, row, body_mass_kg, heel, tip):
    """De Leva's long axis of the foot runs forwards, his sagittal one upwards, so X and Z change places."""
    axis = tip - heel
    length = float(np.sqrt((axis * axis).sum()))
    mass = row.mass * body_mass_kg
    sagittal, transverse, long = mass * (np.array(row.gyration) * length) ** 2
    return Part(joint, mass, heel + row.com * axis, np.diag([long, transverse, sagittal]))


def point_inertia(mass_kg, arm_m):
    """Inertia (3, 3) of a point mass about a place that lies arm_m away (the parallel-axis term)."""
    return mass_kg * ((arm_m * arm_m).sum() * np.eye(3) - np.multiply.outer(arm_m, arm_m))


def _cut(whole, *pieces):
    """What is left of a part without some pieces: mass, centre and inertia of the sum stay those of the whole."""
    mass = whole.mass_kg - sum(p.mass_kg for p in pieces)
    com = (whole.mass_kg * whole.com_m - sum(p.mass_kg * p.com_m for p in pieces)) / mass
    inertia = whole.inertia_kgm2 - point_inertia(mass, com - whole.com_m)
    for p in pieces:
        inertia = inertia - p.inertia_kgm2 - point_inertia(p.mass_kg, p.com_m - whole.com_m)
    return Part(whole.joint, mass, com, inertia)


def _rod(joint, mass_kg, start, end, radius_m):
    """A solid cylinder, for the pieces that no table lists."""
    axis = end - start
    length = float(np.sqrt((axis * axis).sum()))
    along = np.multiply.outer(axis, axis) / max(length * length, 1e-12)
    across = mass_kg * (3.0 * radius_m**2 + length**2) / 12.0
    inertia = across * (np.eye(3) - along) + 0.5 * mass_kg * radius_m**2 * along
    return Part(joint, mass_kg, 0.5 * (start + end), inertia)


def _trunk(table, build, joints, body_mass_kg):
    """Lower, middle and upper trunk between de Leva's landmarks, laid along the line from mid-hip to mid-shoulder."""
    hips, shoulders = joints[list(HIPS)].mean(axis=0), joints[list(SHOULDERS)].mean(axis=0)

    def landmark(share):
        return hips + share * (shoulders - hips)

    omphalion, xiphion = landmark(build.omphalion), landmark(build.xiphion)
    lower = _cylindrical(PELVIS, table["lower_trunk"], body_mass_kg, omphalion, hips)
    middle = _cylindrical(WAIST, table["middle_trunk"], body_mass_kg, xiphion, omphalion)
    upper = _cylindrical(BACK, table["upper_trunk"], body_mass_kg, landmark(build.suprasternale), xiphion)
    mass = CLAVICLE_OF_UPPER_TRUNK * upper.mass_kg
    girdle = [
        _rod(CLAVICLES[side], mass, joints[CLAVICLES[side]], joints[SHOULDERS[side]], 0.1 * build.trunk)
        for side in range(2)
    ]
    return [lower, middle, _cut(upper, *girdle), *girdle]


def _head(table, joints, head_top_m, body_mass_kg):
    """Head and neck: de Leva's head reaches from the crown down to the seventh cervical vertebra, our neck joint."""
    whole = _cylindrical(HEAD, table["head"], body_mass_kg, joints[HEAD] + head_top_m, joints[NECK])
    radius = 0.25 * float(np.sqrt(((joints[HEAD] + head_top_m - joints[NECK]) ** 2).sum()))
    neck = _rod(NECK, NECK_OF_HEAD * whole.mass_kg, joints[NECK], joints[HEAD], radius)
    return [_cut(whole, neck), neck]
