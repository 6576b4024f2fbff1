"""A subject's masses, extents and limits from bone lengths, sex and body mass.

Source of masses, centres of mass and radii of gyration: de Leva 1996, Adjustments to Zatsiorsky-Seluyanov's segment
inertia parameters, J. Biomechanics 29(9), Table 4, scaled to the subject's own segments. His segments are cut a little
further, so that each of the 21 joints carries a part: clavicles out of the upper trunk, neck out of the head, toes out
of the foot. A cut leaves mass, centre and inertia of the whole segment what de Leva measured.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body.limits import standard_limits
from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    ELBOWS,
    HEAD,
    HIPS,
    JOINT_COUNT,
    JOINTS,
    KNEES,
    NECK,
    PARENT,
    PELVIS,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
    Body,
)


class Segment(NamedTuple):
    """One row of de Leva's Table 4, as fractions: of body mass, and of the segment's length."""

    mass: float
    com: float  # from the segment's upper (proximal, cranial, heel) end
    gyration: tuple[float, float, float]  # about the sagittal (front-back), transverse (left-right) and long axis


# head VERT-CERV; trunk SUPR-XYPH, XYPH-OMPH, OMPH-MIDH; hand WJC-DAC3; foot HEEL-TTIP; else joint centre to joint
# centre
DE_LEVA = {
    "male": {
        "head": Segment(0.0694, 0.5002, (0.303, 0.315, 0.261)),
        "upper_trunk": Segment(0.1596, 0.2999, (0.716, 0.454, 0.659)),
        "middle_trunk": Segment(0.1633, 0.4502, (0.482, 0.383, 0.468)),
        "lower_trunk": Segment(0.1117, 0.6115, (0.615, 0.551, 0.587)),
        "upper_arm": Segment(0.0271, 0.5772, (0.285, 0.269, 0.158)),
        "forearm": Segment(0.0162, 0.4574, (0.276, 0.265, 0.121)),
        "hand": Segment(0.0061, 0.3624, (0.288, 0.235, 0.184)),
        "thigh": Segment(0.1416, 0.4095, (0.329, 0.329, 0.149)),
        "shank": Segment(0.0433, 0.4395, (0.251, 0.246, 0.102)),
        "foot": Segment(0.0137, 0.4415, (0.257, 0.245, 0.124)),
    },
    "female": {
        "head": Segment(0.0668, 0.4841, (0.271, 0.295, 0.261)),
        "upper_trunk": Segment(0.1545, 0.2077, (0.746, 0.502, 0.718)),
        "middle_trunk": Segment(0.1465, 0.4512, (0.433, 0.354, 0.415)),
        "lower_trunk": Segment(0.1247, 0.4920, (0.433, 0.402, 0.444)),
        "upper_arm": Segment(0.0255, 0.5754, (0.278, 0.260, 0.148)),
        "forearm": Segment(0.0138, 0.4559, (0.261, 0.257, 0.094)),
        "hand": Segment(0.0056, 0.3427, (0.244, 0.208, 0.154)),
        "thigh": Segment(0.1478, 0.3612, (0.369, 0.364, 0.162)),
        "shank": Segment(0.0481, 0.4352, (0.267, 0.263, 0.092)),
        "foot": Segment(0.0129, 0.4014, (0.299, 0.279, 0.139)),
    },
}


class Build(NamedTuple):
    """Lengths of de Leva's mean subject as fractions of stature (1.741 m, 73.0 kg and 1.735 m, 61.9 kg)."""

    body_mass_index: float
    trunk: float  # MIDH to MIDS, mid-hip to mid-shoulder
    omphalion: float  # the landmarks' heights as fractions of that trunk
    xiphion: float
    suprasternale: float
    cervicale: float
    head: float  # CERV to VERT
    upper_arm: float
    forearm: float
    hand: float  # WJC to DAC3, the tip of the third finger
    thigh: float
    shank: float
    foot: float  # heel to toe tip


BUILD = {
    "male": Build(
        24.08, 0.2961, 0.2826, 0.7007, 1.0318, 1.1703, 0.1395, 0.1618, 0.1545, 0.108, 0.2425, 0.2529, 0.1482
    ),
    "female": Build(
        20.56, 0.2870, 0.3645, 0.7769, 1.0631, 1.2348, 0.1405, 0.1586, 0.1523, 0.105, 0.2124, 0.2528, 0.1316
    ),
}

# Shares of stature after Drillis and Contini 1966 (Winter, Biomechanics and Motor Control of Human Movement, fig. 4.1)
ANKLE_HEIGHT = 0.039
HALF_SHOULDERS = 0.105
HALF_HIPS = 0.05
CROWN_OVER_HEAD_JOINT = 0.0845  # vertex over the skull's lowest joint: most of CERV-VERT, the neck being the rest
TOE_JOINT_HEIGHT = 0.012
# Of a foot's length: heel contact behind the ankle, ball and toe contacts ahead of ankle and ball, half widths
HEEL_BEHIND, BALL_AHEAD, TOE_AHEAD = 0.20, 0.47, 0.22
HALF_WIDTHS = (0.12, 0.18, 0.14)

# Of the parts cut off: the head without neck weighs 4.2 kg of a man's 5.07 kg (Yoganandan et al. 2009); the others by
# volume
NECK_OF_HEAD, CLAVICLE_OF_UPPER_TRUNK, TOES_OF_FOOT = 0.17, 0.08, 0.15


class Part(NamedTuple):
    """A body part while it is worked out: its joint, and the rest in the identity pose, seen from the pelvis."""

    joint: int
    mass_kg: float
    com_m: np.ndarray  # (3,)
    inertia_kgm2: np.ndarray  # (3, 3) about its COM


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
    parts = _parts(offset_m, np.asarray(head_top_m, float), np.asarray(fingertip_m, float), sex, float(mass_kg))
    low, high = standard_limits()
    joints = joints_at_identity(offset_m)
    return Body(
        offset_m=offset_m,
        head_top_m=np.array(head_top_m, float),
        palm_m=np.array(fingertip_m, float) * DE_LEVA[sex]["hand"].com,
        fingertip_m=np.array(fingertip_m, float),
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


def _parts(offset_m, head_top_m, fingertip_m, sex, body_mass_kg):
    """All 21 parts, in the order of their joints."""
    table, build, joints = DE_LEVA[sex], BUILD[sex], joints_at_identity(offset_m)
    foot_m = build.foot * stature_m(offset_m)
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
