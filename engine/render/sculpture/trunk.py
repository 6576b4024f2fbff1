"""Pelvis, midriff, rib cage, neck and the shoulders' yokes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from engine.body import skeleton as sk
from engine.body.skeleton import Body
from engine.render.sculpture.parts import JOINT, SHELL, Part, outwards
from engine.render.surface import Shape, ball, blend, both_sides, carve, ellipsoid, half_space, shifted, taper

SHOULDERS_UNDER_HEAD_M = 0.155  # joints of a person's shoulders under the joint of the head, at least


class Trunk(NamedTuple):
    """Landmarks in the identity pose, seen from the pelvis."""

    rest: np.ndarray  # (21, 3) all joints
    hips: np.ndarray  # (3,) between the hip joints
    neck: np.ndarray  # (3,) where the neck comes out
    drop_m: float = 0.0  # how far under the shoulder joints the flesh of the shoulders lies; see shoulder_drop_m

    @property
    def height(self) -> float:
        return float(self.neck[2] - self.hips[2])

    def at(self, share: float, forward: float = 0.0, left: float = 0.0) -> np.ndarray:
        """A place by its share of the height from hips to neck, halfway between the spine's and the hips' depth."""
        z = self.hips[2] + share * self.height
        spine = self.rest[[sk.PELVIS, sk.WAIST, sk.BACK, sk.NECK, sk.HEAD]]
        middle = 0.5 * (np.interp(z, spine[:, 2], spine[:, 0]) + self.hips[0])
        return np.array([middle + forward, left, z])


def trunk_parts(body: Body, rest: np.ndarray) -> list[Part]:
    """Everything between hips and head. rest: (21, 3) joints of the identity pose, the pelvis at the origin."""
    trunk = trunk_of(rest)
    bowl = carve(0.03, pelvis(trunk), half_space(trunk.at(0.315), (0, 0, -1.0)))
    cage = carve(0.03, ribs(trunk), half_space(trunk.at(0.405), (0, 0, 1.0)))
    return [
        Part(sk.PELVIS, SHELL, bowl, 0.0205),
        Part(sk.WAIST, JOINT, shifted(midriff(trunk), -rest[sk.WAIST]), 0.030),
        Part(sk.BACK, SHELL, shifted(cage, -rest[sk.BACK]), 0.0195),
        Part(sk.NECK, JOINT, throat(body), 0.014),
        *[Part(sk.CLAVICLES[side], SHELL, yoke(body, side), 0.021) for side in (sk.LEFT, sk.RIGHT)],
    ]


def trunk_of(rest: np.ndarray, drop_m: float = 0.0) -> Trunk:
    """The landmarks of a body whose joints (21, 3) are there in the identity pose."""
    return Trunk(rest, 0.5 * (rest[sk.LEFT_HIP] + rest[sk.RIGHT_HIP]), neck_root(rest) - (0.0, 0.0, drop_m), drop_m)


def shoulder_drop_m(rest: np.ndarray) -> float:
    """Some skeletons have the joints of their shoulders up at the neck, where a person's are a hand lower: sculpted
    around
    those joints the figure would shrug. How much lower the flesh is put, reference metres."""
    shoulders = 0.5 * (rest[sk.LEFT_SHOULDER][2] + rest[sk.RIGHT_SHOULDER][2])
    return float(np.clip(0.7 * (shoulders - rest[sk.HEAD][2] + SHOULDERS_UNDER_HEAD_M), 0.0, 0.055))


def throat(body: Body, slim: float = 1.0) -> Shape:
    """In the neck's frame."""
    return taper((-0.004, 0, -0.03), body.offset_m[sk.HEAD] + (0.0, 0, 0.01), 0.061 * slim, 0.055 * slim)


def neck_root(rest: np.ndarray) -> np.ndarray:
    """Where the neck comes out of the trunk: a little over the shoulders, even where a clip's neck turns much lower."""
    neck, head = rest[sk.NECK], rest[sk.HEAD]
    over_shoulders = 0.5 * (rest[sk.LEFT_SHOULDER][2] + rest[sk.RIGHT_SHOULDER][2]) + 0.055
    share = np.clip((over_shoulders - neck[2]) / max(head[2] - neck[2], 1e-6), 0.0, 0.6)
    return neck + share * (head - neck)


def pelvis(trunk: Trunk) -> Shape:
    """A bowl, a belt above it, and the seat."""
    hip_half = abs(trunk.rest[sk.LEFT_HIP][1] - trunk.hips[1])
    bowl = ellipsoid(trunk.at(0.08, 0.002), (0.098, max(0.152, hip_half + 0.062), 0.155 * trunk.height), 2.2)
    belt = taper(trunk.at(0.10, 0.004), trunk.at(0.34, 0.006), 0.132, 0.126, flat=(0.70, 1.0, 0.9))
    seat = both_sides(ball(trunk.at(0.0, -0.045, 0.068), 0.082))
    return blend(0.05, bowl, belt, seat)


def midriff(trunk: Trunk) -> Shape:
    """The soft part that shows between the two shells when the trunk bends."""
    return ellipsoid(trunk.at(0.36, 0.006), (0.080, 0.114, 0.185 * trunk.height), 2.1)


def abdomen(trunk: Trunk) -> Shape:
    """The waist of a body in one piece, between rib cage and pelvis."""
    return taper(trunk.at(0.26, 0.004), trunk.at(0.54, 0.008), 0.112, 0.114, flat=(0.70, 1.0, 0.8))


def ribs(trunk: Trunk) -> Shape:
    """Rib cage, chest, shoulder blades and the slopes to the neck."""
    shoulder = trunk.rest[sk.LEFT_SHOULDER]
    breadth = 0.5 * (0.146 + 0.80 * abs(shoulder[1] - trunk.neck[1]))
    cage = taper(trunk.at(0.74, 0.002), trunk.at(0.48, 0.012), breadth, 0.86 * breadth, flat=(0.74, 1.0, 0.94))
    chest = ellipsoid(trunk.at(0.78, 0.056, 0.064), (0.052, 0.072, 0.062))
    blade = ellipsoid(trunk.at(0.80, -0.042, 0.075), (0.060, 0.076, 0.10))
    shoulder = shoulder - (0.0, 0.0, trunk.drop_m)
    root = trunk.neck + (-0.010, 0.026, -0.016)
    trapezius = taper(root, root + 0.62 * (shoulder - root) + (0, 0, 0.004), 0.046, 0.044)
    return blend(0.06, cage, *map(both_sides, (chest, blade, trapezius)))


def yoke(body: Body, side: int, drop_m: float = 0.0) -> Shape:
    """What moves with the clavicle and closes the gap between rib cage and arm."""
    shoulder = body.offset_m[sk.SHOULDERS[side]] - (0.0, 0.0, drop_m)
    tip = shoulder + (0.0, -0.012 * outwards(side), -0.002)
    bar = taper(0.42 * shoulder + (0, 0, -0.012), tip, 0.052, 0.050, flat=(1.12, 1.0, 0.96))
    armpit = taper(0.62 * shoulder + (0, 0, -0.065), tip, 0.050, 0.046)
    return blend(0.03, bar, armpit)
