"""A subject's body from bone lengths, sex and body mass: masses, extents and limits.

Where a clip lacks them, hands, feet and crown take their shares of stature (`engine.body.proportions`); masses, centres
and inertias are de Leva's, scaled to the subject's own segments (`engine.body.mass_parts`).
"""

from __future__ import annotations

import numpy as np

from engine.body.limits import standard_limits
from engine.body.mass_parts import parts_of
from engine.body.proportions import (
    ANKLE_HEIGHT,
    BALL_AHEAD,
    BUILD,
    CROWN_OVER_HEAD_JOINT,
    DE_LEVA,
    HALF_HIPS,
    HALF_SHOULDERS,
    HALF_WIDTHS,
    HEEL_BEHIND,
    TOE_AHEAD,
    TOE_JOINT_HEIGHT,
)
from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    ELBOWS,
    HEAD,
    HIPS,
    JOINT_COUNT,
    KNEES,
    NECK,
    PARENT,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
    Body,
)


def make_body(
    offset_m: np.ndarray,
    *,
    sex: str = "male",
    mass_kg: float | None = None,
    head_top_m: np.ndarray | None = None,
    fingertip_m: np.ndarray | None = None,
) -> Body:
    """The body of a subject with these bones.

    offset_m: (21, 3) each joint in its parent's frame, identity pose, metres; the toes' rows may be nan (a clip without
    them). mass_kg: nan or absent means de Leva's mean body-mass index at the subject's height. head_top_m (3,) and
    fingertip_m (2, 3): where a clip knows its crown and fingertips, in the head's and the wrists' frames. ValueError
    names what is wrong.
    """
    if sex not in DE_LEVA:
        raise ValueError(f"unknown sex {sex!r}; the tables are {', '.join(DE_LEVA)}")
    offset_m = _with_toes(np.array(offset_m, float), BUILD[sex])
    if offset_m.shape != (JOINT_COUNT, 3) or not np.isfinite(offset_m).all():
        raise ValueError(f"bone offsets must be finite and of shape ({JOINT_COUNT}, 3), found {offset_m.shape}")
    height_m = stature_m(offset_m)
    if mass_kg is None:
        mass_kg = BUILD[sex].body_mass_index * height_m**2
    if not 1.0 <= mass_kg <= 1000.0:
        raise ValueError(f"body mass {mass_kg} kg, expected 1 to 1000")
    if head_top_m is None:
        head_top_m = np.array([0.0, 0.0, CROWN_OVER_HEAD_JOINT * height_m])
    if fingertip_m is None:
        fingertip_m = np.tile([0.0, 0.0, -BUILD[sex].hand * height_m], (2, 1))
    joints = joints_at_identity(offset_m)
    head_top_m, fingertip_m = np.array(head_top_m, float), np.array(fingertip_m, float)
    parts = parts_of(joints, head_top_m, fingertip_m, BUILD[sex].foot * height_m, sex, float(mass_kg))
    low, high = standard_limits()
    return Body(
        offset_m=offset_m,
        head_top_m=head_top_m,
        palm_m=fingertip_m * DE_LEVA[sex]["hand"].com,
        fingertip_m=fingertip_m,
        sole_m=_soles(offset_m, BUILD[sex].foot * height_m),
        part_joint=np.array([p.joint for p in parts]),
        part_mass_kg=np.array([p.mass_kg for p in parts]),
        part_com_m=np.array([p.com_m - joints[p.joint] for p in parts]),
        part_inertia_kgm2=np.array([p.inertia_kgm2 for p in parts]),
        limit_low_rad=low,
        limit_high_rad=high,
    )


def standard_body(height_m: float = 1.75, sex: str = "male", mass_kg: float | None = None) -> Body:
    """A person of de Leva's mean build, as tall as asked from sole to crown."""
    b = BUILD[sex]
    # his lengths come from several samples and overshoot his own stature by up to 2 %
    h = height_m / (ANKLE_HEIGHT + b.shank + b.thigh + b.trunk * b.cervicale + b.head)
    trunk = b.trunk * h
    low, neck_height = 0.03 * h, b.cervicale * trunk  # the pelvis joint lies a little over the line between the hips
    offset = np.zeros((JOINT_COUNT, 3))
    offset[WAIST] = (0.0, 0.0, b.omphalion * trunk - low)
    offset[BACK] = (0.0, 0.0, (0.62 - b.omphalion) * trunk)
    offset[NECK] = (0.0, 0.0, neck_height - 0.62 * trunk)
    offset[HEAD] = (0.0, 0.0, b.head * h - CROWN_OVER_HEAD_JOINT * height_m)
    for side, out in enumerate((1.0, -1.0)):
        clavicle_height = 0.95 * neck_height
        offset[CLAVICLES[side]] = (0.0, 0.015 * out * h, clavicle_height - 0.62 * trunk)
        offset[SHOULDERS[side]] = (0.0, (HALF_SHOULDERS - 0.015) * out * h, trunk - clavicle_height)
        offset[ELBOWS[side]] = (0.0, 0.0, -b.upper_arm * h)
        offset[WRISTS[side]] = (0.0, 0.0, -b.forearm * h)
        offset[HIPS[side]] = (0.0, HALF_HIPS * out * h, -low)
        offset[KNEES[side]] = (0.0, 0.0, -b.thigh * h)
        offset[ANKLES[side]] = (0.0, 0.0, -b.shank * h)
        offset[TOES[side]] = (BALL_AHEAD * b.foot * height_m, 0.0, (TOE_JOINT_HEIGHT - ANKLE_HEIGHT) * h)
    return make_body(offset, sex=sex, mass_kg=mass_kg)


def joints_at_identity(offset_m: np.ndarray) -> np.ndarray:
    """(J, 3) every joint in the identity pose, seen from the pelvis."""
    joints = np.zeros((JOINT_COUNT, 3))
    for j in range(1, JOINT_COUNT):
        joints[j] = joints[PARENT[j]] + offset_m[j]
    return joints


def stature_m(offset_m: np.ndarray) -> float:
    """Standing height, from the height of the head's joint over the ankles and the shares above and below."""
    joints = joints_at_identity(offset_m)
    return float((joints[HEAD, 2] - joints[list(ANKLES), 2].mean()) / (1.0 - ANKLE_HEIGHT - CROWN_OVER_HEAD_JOINT))


def _with_toes(offset_m, build):
    """Fills in the toe joints of a clip that has none."""
    if offset_m.shape == (JOINT_COUNT, 3):
        missing = ~np.isfinite(offset_m[list(TOES)]).all(axis=1)
        h = stature_m(offset_m)
        offset_m[np.array(TOES)[missing]] = (
            BALL_AHEAD * build.foot * h,
            0.0,
            (TOE_JOINT_HEIGHT - ANKLE_HEIGHT) * h,
        )
    return offset_m


def _soles(offset_m, foot_m):
    """(2, 6, 3) where heel, ball and toe meet the ground: one plane, level in the identity pose."""
    height_m = stature_m(offset_m)
    soles = np.empty((2, 6, 3))
    for side, inwards in enumerate((-1.0, 1.0)):
        toe = offset_m[TOES[side]]
        # clips place the toe joint anywhere between the sole and the ankle; a sole cannot be higher or lower than
        # anatomy has it
        ground = -np.clip(-toe[2] + TOE_JOINT_HEIGHT * height_m, 0.035 * height_m, 0.06 * height_m)
        heel, ball, tip = (np.array([s * inwards * foot_m for s in (w, -w)]) for w in HALF_WIDTHS)
        for k in range(2):
            soles[side, k] = (-HEEL_BEHIND * foot_m, heel[k], ground)
            soles[side, 2 + k] = (toe[0], toe[1] + ball[k], ground)
            soles[side, 4 + k] = (TOE_AHEAD * foot_m, tip[k], ground - toe[2])
    return soles
