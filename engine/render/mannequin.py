"""The figure: a jointed mannequin sculpted around one Body's own bone lengths, each part rigid to its joint.

Every dimension is the subject's: along the bones from the Body, across them from stature (proportions of an average
adult, after the drawings of Loomis, *Figure Drawing for All It's Worth*, and the breadths of ISO 7250). Each part is
sculpted in the frame of its joint: X forward, Y left, Z up, metres.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body import skeleton as sk
from engine.body.skeleton import Body
from engine.render.surface import (
    Shape,
    ball,
    blend,
    both_sides,
    carve,
    ellipsoid,
    half_space,
    mesh,
    taper,
    without_buried,
)

SHELL, JOINT, VISOR, SHOE = range(4)  # materials: the figure's colour, its darker joints, the face's glass, the shoe


class Part(NamedTuple):
    """One rigid piece."""

    joint: int
    material: int
    shape: Shape
    cell_m: float


class MannequinMesh(NamedTuple):
    """All pieces in one buffer; positions and normals in the frame of the vertex's joint."""

    vertices: np.ndarray  # (V, 3) float32
    normals: np.ndarray  # (V, 3) float32
    tags: np.ndarray  # (V, 2) float32: joint, material
    triangles: np.ndarray  # (T, 3) int32


def mannequin_mesh(body: Body) -> MannequinMesh:
    """Sculpts and meshes a body; about a third of a second."""
    vertices, normals, tags, triangles, base = [], [], [], [], 0
    parts = mannequin_parts(body)
    for part in parts:
        covers = [other.shape for other in parts if other.joint == part.joint and other is not part]
        piece = without_buried(mesh(part.shape, part.cell_m), covers)
        vertices.append(piece.vertices)
        normals.append(piece.normals)
        tags.append(np.tile((part.joint, part.material), (len(piece.vertices), 1)))
        triangles.append(piece.triangles + base)
        base += len(piece.vertices)
    return MannequinMesh(
        np.concatenate(vertices).astype("f4"), np.concatenate(normals).astype("f4"),
        np.concatenate(tags).astype("f4"), np.concatenate(triangles).astype("i4"),
    )  # fmt: skip


def mannequin_parts(body: Body) -> list[Part]:
    """Every piece of one body."""
    rest = rest_positions(body)
    size = stature_m(body) / 1.75
    parts = _trunk(body, rest, size) + _head(body, size)
    for side in (sk.LEFT, sk.RIGHT):
        parts += _arm(body, side, size) + _hand(body, side, size) + _leg(body, side, size) + _foot(body, side, size)
    return parts


def rest_positions(body: Body) -> np.ndarray:
    """(21, 3) joints of the identity pose, the pelvis at the origin: frames are parallel, so offsets just add up."""
    rest = np.zeros((sk.JOINT_COUNT, 3))
    for joint in range(1, sk.JOINT_COUNT):
        rest[joint] = rest[sk.PARENT[joint]] + body.offset_m[joint]
    return rest


def stature_m(body: Body) -> float:
    """Crown to sole, standing in the identity pose."""
    rest = rest_positions(body)
    soles = min(rest[ankle][2] + body.sole_m[side, :4, 2].min() for side, ankle in enumerate(sk.ANKLES))
    return float(rest[sk.HEAD][2] + body.head_top_m[2] - soles)


def _trunk(body: Body, rest: np.ndarray, size: float) -> list[Part]:
    """Pelvis, midriff, rib cage, shoulder girdle and neck, placed by heights between the hips and the neck's root."""
    hips = 0.5 * (rest[sk.LEFT_HIP] + rest[sk.RIGHT_HIP])
    neck, back = rest[sk.NECK], rest[sk.BACK]
    height = neck[2] - hips[2]
    spine = rest[[sk.PELVIS, sk.WAIST, sk.BACK, sk.NECK]]

    def at(share: float, forward: float = 0.0, left: float = 0.0) -> np.ndarray:
        z = hips[2] + share * height
        x = 0.5 * (np.interp(z, spine[:, 2], spine[:, 0]) + hips[0])
        return np.array([x + forward * size, left * size, z])

    hip_half = abs(rest[sk.LEFT_HIP][1] - hips[1])
    pelvis = blend(
        0.05 * size,
        ellipsoid(at(0.08, 0.002), (0.098 * size, max(0.152 * size, hip_half + 0.062 * size), 0.155 * height), 2.2),
        taper(at(0.10, 0.004), at(0.34, 0.006), 0.132 * size, 0.126 * size, flat=(0.70, 1.0, 0.9)),
        both_sides(ball(at(0.0, -0.045, 0.068), 0.082 * size)),
    )
    pelvis = carve(0.03 * size, pelvis, half_space(at(0.315), (0, 0, -1.0)))
    midriff = ellipsoid(at(0.36, 0.006), (0.080 * size, 0.114 * size, 0.26 * height), 2.1)
    shoulder_half = abs(rest[sk.LEFT_SHOULDER][1] - neck[1])
    breadth = 0.5 * (0.146 * size + 0.80 * shoulder_half)
    ribs = blend(
        0.06 * size,
        taper(at(0.74, 0.002), at(0.48, 0.012), breadth, 0.86 * breadth, flat=(0.74, 1.0, 0.94)),
        both_sides(ellipsoid(at(0.78, 0.056, 0.064), (0.052 * size, 0.072 * size, 0.062 * size))),
        both_sides(ellipsoid(at(0.80, -0.042, 0.075), (0.060 * size, 0.076 * size, 0.10 * size))),
        both_sides(_trapezius(rest, size)),
    )
    ribs = carve(0.03 * size, ribs, half_space(at(0.405), (0, 0, 1.0)))
    throat = taper(
        (-0.004 * size, 0, -0.03 * size), body.offset_m[sk.HEAD] + (0.0, 0, 0.01 * size), 0.061 * size, 0.055 * size
    )
    parts = [
        Part(sk.PELVIS, SHELL, _shifted(pelvis, -rest[sk.PELVIS]), 0.0205 * size),
        Part(sk.WAIST, JOINT, _shifted(midriff, -rest[sk.WAIST]), 0.030 * size),
        Part(sk.BACK, SHELL, _shifted(ribs, -back), 0.0195 * size),
        Part(sk.NECK, JOINT, throat, 0.014 * size),
    ]
    for side in (sk.LEFT, sk.RIGHT):
        parts.append(_girdle(body, side, size))
    return parts


def _trapezius(rest: np.ndarray, size: float) -> Shape:
    """The left slope from the neck towards the shoulder, which stays with the rib cage."""
    shoulder = rest[sk.LEFT_SHOULDER]
    root = rest[sk.NECK] + (-0.010 * size, 0.026 * size, -0.016 * size)
    return taper(root, root + 0.62 * (shoulder - root) + (0, 0, 0.004 * size), 0.046 * size, 0.044 * size)


def _girdle(body: Body, side: int, size: float) -> Part:
    """The shoulder's yoke, which moves with the clavicle and closes the gap between rib cage and arm."""
    clavicle = sk.CLAVICLES[side]
    shoulder = body.offset_m[sk.SHOULDERS[side]]
    tip = shoulder + (0.0, -0.012 * size * _sign(side), -0.002 * size)
    yoke = blend(
        0.03 * size,
        taper(0.42 * shoulder + (0, 0, -0.012 * size), tip, 0.052 * size, 0.050 * size, flat=(1.12, 1.0, 0.96)),
        taper(0.62 * shoulder + (0, 0, -0.065 * size), tip, 0.050 * size, 0.046 * size),
    )
    return Part(clavicle, SHELL, yoke, 0.021 * size)


def _head(body: Body, size: float) -> list[Part]:
    """Skull, face and jaw with brow, nose, chin and ears, a dark visor for eyes: it must be plain where it looks."""
    crown, size = body.head_top_m, 1.04 * size  # a little large, as sculptors make it: it carries the expression

    def at(forward: float, left: float, below: float) -> np.ndarray:
        return crown + np.array([forward, left, -below]) * size

    skull = ellipsoid(at(-0.006, 0, 0.092), np.array([0.098, 0.077, 0.092]) * size)
    face = taper(at(0.034, 0, 0.112), at(0.050, 0, 0.176), 0.061 * size, 0.039 * size, flat=(1.0, 0.97, 1.0))
    jaw = taper(at(0.004, 0, 0.155), at(0.058, 0, 0.196), 0.052 * size, 0.023 * size, flat=(1.0, 0.96, 1.0))
    head = blend(0.03 * size, skull, face, jaw)
    brow = ellipsoid(at(0.080, 0, 0.082), np.array([0.013, 0.052, 0.010]) * size)
    head = blend(0.02 * size, head, brow)
    nose = taper(at(0.088, 0, 0.124), at(0.102, 0, 0.149), 0.008 * size, 0.0110 * size)
    ears = both_sides(ellipsoid(at(-0.008, 0.074, 0.118), np.array([0.019, 0.010, 0.030]) * size))
    glass = Shape(lambda points: head.field(points) - 0.0035 * size, head.low - 0.003, head.high + 0.003)
    visor = carve(0.006 * size, glass, lambda points: -_outside_lens((points - crown) / size) * size)
    return [
        Part(sk.HEAD, SHELL, blend(0.012 * size, head, nose, ears), 0.0115 * size),
        Part(sk.HEAD, VISOR, visor, 0.0058 * size),
    ]


def _outside_lens(local: np.ndarray) -> np.ndarray:
    """Positive outside the visor's outline, which wraps the eyes from temple to temple and rises over the nose.

    local: (N, 3) from the crown, for a stature of 1.75 m.
    """
    middle, half_height, half_width = -0.112, 0.0255, 0.0765
    height = np.where(local[:, 2] < middle, half_height - 0.009 * np.exp(-((local[:, 1] / 0.016) ** 2)), half_height)
    lens = ((local[:, 1] / half_width) ** 4 + ((local[:, 2] - middle) / height) ** 4) ** 0.25
    return np.maximum((lens - 1.0) * half_height, 0.015 - local[:, 0])


def _arm(body: Body, side: int, size: float) -> list[Part]:
    """Shoulder ball, upper arm with its biceps, elbow ball, forearm that swells below the elbow, wrist ball."""
    shoulder, elbow, wrist = sk.SHOULDERS[side], sk.ELBOWS[side], sk.WRISTS[side]
    upper, lower = body.offset_m[elbow], body.offset_m[wrist]
    out = _sign(side) * size
    upper_arm = _cut(0.014 * size, upper, 0.017 * size, blend(
        0.03 * size,
        taper((0, 0.008 * out, -0.004 * size), 0.97 * upper, 0.052 * size, 0.0385 * size),
        ellipsoid(0.16 * upper + (0, 0.010 * out, 0), (0.054 * size, 0.047 * size, 0.075 * size)),
        ellipsoid(0.48 * upper + (0.008 * size, 0.002 * out, 0), (0.044 * size, 0.042 * size, 0.085 * size)),
    ))  # fmt: skip
    forearm = _cut(0.012 * size, lower, 0.012 * size, blend(
        0.03 * size,
        taper(0.04 * lower, 0.98 * lower, 0.038 * size, 0.0262 * size, flat=(1.06, 1.0, 1.0)),
        ellipsoid(0.27 * lower + (0.006 * size, 0.004 * out, 0), (0.042 * size, 0.039 * size, 0.085 * size)),
    ), start_m=0.017 * size)  # fmt: skip
    return [
        Part(shoulder, SHELL, upper_arm, 0.017 * size),
        Part(elbow, JOINT, ball((0, 0, 0), 0.0385 * size), 0.0135 * size),
        Part(elbow, SHELL, forearm, 0.0145 * size),
        Part(wrist, JOINT, ball((0, 0, 0), 0.0265 * size), 0.011 * size),
    ]


def _hand(body: Body, side: int, size: float) -> list[Part]:
    """A mitten: palm, gently curled fingers together, and a thumb that points forwards."""
    wrist = sk.WRISTS[side]
    palm, tip = body.palm_m[side], body.fingertip_m[side]
    knuckles = palm + 0.40 * (tip - palm)
    inward = -_sign(side) * size  # palms face the thighs
    length = float(np.linalg.norm(tip))
    middle = knuckles + 0.55 * (tip - knuckles) + (0.0, 0.004 * inward, 0.0)
    end = knuckles + 0.90 * (tip - knuckles) + (0.0, 0.017 * inward, 0.0)
    wide = (1.9, 0.78, 1.0)
    hand = blend(
        0.012 * size,
        ellipsoid(0.96 * palm, (0.041 * size, 0.0175 * size, 0.285 * length), 2.8),
        taper(knuckles, middle, 0.0185 * size, 0.0165 * size, flat=wide),
        taper(middle, end, 0.0165 * size, 0.0125 * size, flat=wide),
        taper(
            0.20 * tip + (0.018 * size, 0.003 * inward, 0),
            0.40 * tip + (0.047 * size, 0.012 * inward, 0),
            0.0165 * size,
            0.0125 * size,
        ),
        taper(
            0.40 * tip + (0.047 * size, 0.012 * inward, 0),
            0.57 * tip + (0.054 * size, 0.017 * inward, 0),
            0.0125 * size,
            0.0095 * size,
        ),
    )
    return [Part(wrist, SHELL, hand, 0.0085 * size)]


def _leg(body: Body, side: int, size: float) -> list[Part]:
    """Thigh with its quadriceps, knee ball, shin with its calf, ankle ball."""
    hip, knee, ankle = sk.HIPS[side], sk.KNEES[side], sk.ANKLES[side]
    thigh, shin = body.offset_m[knee], body.offset_m[ankle]
    out = _sign(side) * size
    upper_leg = _cut(0.018 * size, thigh, 0.024 * size, blend(
        0.04 * size,
        taper((0.0, -0.002 * out, -0.015 * size), 0.98 * thigh, 0.081 * size, 0.0505 * size),
        ellipsoid(0.42 * thigh + (0.018 * size, 0.006 * out, 0), (0.066 * size, 0.066 * size, 0.15 * size)),
    ))  # fmt: skip
    lower_leg = _cut(0.014 * size, shin, 0.020 * size, blend(
        0.03 * size,
        taper(0.03 * shin, 0.98 * shin, 0.0485 * size, 0.0335 * size),
        ellipsoid(0.30 * shin + (-0.020 * size, 0.004 * out, 0), (0.050 * size, 0.050 * size, 0.115 * size)),
    ), start_m=0.024 * size)  # fmt: skip
    return [
        Part(hip, SHELL, upper_leg, 0.022 * size),
        Part(knee, JOINT, ball((0.004 * size, 0, 0), 0.0515 * size), 0.016 * size),
        Part(knee, SHELL, lower_leg, 0.017 * size),
        Part(ankle, JOINT, ball((0, 0, 0), 0.0365 * size), 0.014 * size),
    ]


def _foot(body: Body, side: int, size: float) -> list[Part]:
    """Heel, instep and ball of the foot on the ankle, the toes on theirs; both flat on the Body's own sole points."""
    ankle, toe = sk.ANKLES[side], sk.TOES[side]
    sole, to_toe = body.sole_m[side], body.offset_m[sk.TOES[side]]
    heel, ball_of_foot, tip = (0.5 * (sole[2 * k] + sole[2 * k + 1]) for k in range(3))
    ball_half = 0.5 * abs(sole[2][1] - sole[3][1]) + 0.004 * size
    heel_half = max(0.5 * abs(sole[0][1] - sole[1][1]) + 0.006 * size, 0.028 * size)
    ground = min(heel[2], ball_of_foot[2])
    thick = 0.030 * size
    foot = blend(
        0.03 * size,
        ellipsoid(heel + (0.026 * size, 0, 0.026 * size), (0.036 * size, heel_half, 0.034 * size), 2.3),
        taper(
            (-0.004 * size, 0, -0.020 * size),
            (0.8 * to_toe[0], 0.8 * to_toe[1], ground + thick),
            0.037 * size,
            0.026 * size,
        ),
        ellipsoid(
            (to_toe[0] - 0.010 * size, ball_of_foot[1], ground + 0.024 * size),
            (0.046 * size, ball_half, 0.028 * size),
            2.3,
        ),
    )
    under_toes = ground - to_toe[2]
    length = tip[0] + 0.006 * size
    toes = ellipsoid(
        (0.5 * (length - 0.024 * size), tip[1] * 0.7, under_toes + 0.019 * size),
        (0.5 * (length + 0.024 * size), 0.97 * ball_half, 0.022 * size), 2.4,
    )  # fmt: skip
    flat_sole = half_space((0, 0, ground), (0, 0, 1.0))
    flat_toes = half_space((0, 0, under_toes), (0, 0, 1.0))
    return [
        Part(ankle, SHOE, carve(0.008 * size, foot, flat_sole), 0.012 * size),
        Part(toe, SHOE, carve(0.008 * size, toes, flat_toes), 0.012 * size),
    ]


def _cut(round_m: float, bone: np.ndarray, end_m: float, limb: Shape, start_m: float | None = None) -> Shape:
    """A limb squared off short of the joint at the bone's end, and of its own where told: a rim around the ball."""
    cutters = [half_space(bone + (0, 0, end_m), (0, 0, 1.0))]
    if start_m is not None:
        cutters.append(half_space((0, 0, -start_m), (0, 0, -1.0)))
    return carve(round_m, limb, *cutters)


def _shifted(shape: Shape, by: np.ndarray) -> Shape:
    return Shape(lambda points: shape.field(points - by), shape.low + by, shape.high + by)


def _sign(side: int) -> float:
    """+1 to the left, -1 to the right: outwards along Y."""
    return 1.0 if side == sk.LEFT else -1.0
