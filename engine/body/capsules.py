"""The body's shape as capsules: what a ball meets, what falls on the floor, what a mannequin may be drawn around.

Limbs take their radius from the mass they carry at the density of flesh, so that shape and mass model agree; trunk,
head, hands and feet, which are no cylinders, take shares of stature from NASA-STD-3000 (chest depth 0.14, hip breadth
0.20, head breadth 0.089, hand breadth 0.05, neck breadth 0.066 of it).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from engine.body.anthropometry import stature_m
from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    ELBOWS,
    HEAD,
    HIPS,
    KNEES,
    NECK,
    PELVIS,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
    Body,
)
from engine.maths import quaternion, vector
from engine.maths.kernel import njit

FLESH_KGPM3 = 1050.0


class Capsules(NamedTuple):
    """C capsules; arrays only, so that kernels take them whole. Their names, in the same order: CAPSULES."""

    joint: np.ndarray  # (C,) the joint that carries it
    start_m: np.ndarray  # (C, 3) in that joint's frame
    end_m: np.ndarray  # (C, 3)
    radius_m: np.ndarray  # (C,)


_ONE_SIDE = ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shank", "foot", "toes")
CAPSULES = (
    "pelvis", "belly", "chest", "upper_chest", "neck", "head",
    *(f"left_{name}" for name in _ONE_SIDE), *(f"right_{name}" for name in _ONE_SIDE),
)  # fmt: skip


def body_capsules(body: Body) -> Capsules:
    """The capsules of one body, in the order of CAPSULES. Pure; a few tens of microseconds: keep it with the body."""
    h = stature_m(body.offset_m)
    rows = [*_trunk(body, h), *_head(body, h), *_side(body, h, 0), *_side(body, h, 1)]
    joint, start, end, radius = zip(*rows, strict=True)
    return Capsules(np.array(joint), np.array(start, float), np.array(end, float), np.array(radius, float))


def _across(joint, height, half_width, radius):
    """A capsule that lies across the body."""
    return joint, (0.0, -half_width, height), (0.0, half_width, height), radius


def _trunk(body, h):
    """Pelvis, belly and two of the chest: lying across, as a trunk is twice as wide as it is deep."""
    spine = float(body.offset_m[NECK, 2])
    return [
        _across(PELVIS, 0.3 * float(body.offset_m[HIPS[0], 2]), 0.040 * h, 0.065 * h),
        _across(WAIST, 0.35 * float(body.offset_m[BACK, 2]), 0.032 * h, 0.060 * h),
        _across(BACK, 0.22 * spine, 0.036 * h, 0.066 * h),
        _across(BACK, 0.62 * spine, 0.050 * h, 0.060 * h),
    ]


def _head(body, h):
    """Neck, and a head a little forward of the joint under the skull: it carries the face."""
    radius, crown = 0.046 * h, body.head_top_m
    top = (crown[0] + 0.008 * h, crown[1], crown[2] - radius)
    chin = (0.012 * h, 0.0, min(0.02 * h, top[2]))
    return [(NECK, (0.0, 0.0, 0.0), tuple(body.offset_m[HEAD]), 0.033 * h), (HEAD, chin, top, radius)]


def _limb(body, joint, end):
    """A bone from its joint to the next, as thick as its mass makes it."""
    volume = body.part_mass_kg[joint] / FLESH_KGPM3
    radius = math.sqrt(volume / (math.pi * float(np.sqrt((end * end).sum()))))
    return joint, (0.0, 0.0, 0.0), tuple(end), radius


def _side(body, h, side):
    """Arm and leg of one side."""
    foot_radius, toe_radius = 0.019 * h, 0.013 * h
    ground = float(body.sole_m[side, 0, 2])
    heel = body.sole_m[side, :2].mean(axis=0)
    toe_ground = float(body.sole_m[side, 4, 2])
    tip = body.sole_m[side, 4:].mean(axis=0)
    ball = tuple(body.offset_m[TOES[side]] * [1, 1, 0] + [0.0, 0.0, ground + foot_radius])
    hand_radius = 0.021 * h
    fingertip, shoulder = body.fingertip_m[side], body.offset_m[SHOULDERS[side]]
    reach = float(np.sqrt((fingertip * fingertip).sum()))
    return [
        (CLAVICLES[side], tuple(0.4 * shoulder), tuple(shoulder), 0.034 * h),
        _limb(body, SHOULDERS[side], body.offset_m[ELBOWS[side]]),
        _limb(body, ELBOWS[side], body.offset_m[WRISTS[side]]),
        (WRISTS[side], tuple(0.2 * fingertip), tuple(fingertip * (1.0 - hand_radius / reach)), hand_radius),
        _limb(body, HIPS[side], body.offset_m[KNEES[side]]),
        _limb(body, KNEES[side], body.offset_m[ANKLES[side]]),
        (ANKLES[side], (heel[0], heel[1], ground + foot_radius), ball, foot_radius),
        (TOES[side], (0.0, 0.0, toe_ground + toe_radius), (tip[0], tip[1], toe_ground + toe_radius), toe_radius),
    ]


@njit(cache=True)
def capsules_at(capsules, positions, orientations):
    """(C, 2, 3) both ends of every capsule's segment in the world, for one pose."""
    out = np.empty((len(capsules.joint), 2, 3))
    for c in range(len(capsules.joint)):
        j = capsules.joint[c]
        a = vector.add(positions[j], quaternion.rotate(orientations[j], capsules.start_m[c]))
        b = vector.add(positions[j], quaternion.rotate(orientations[j], capsules.end_m[c]))
        out[c, 0, 0], out[c, 0, 1], out[c, 0, 2] = a
        out[c, 1, 0], out[c, 1, 1], out[c, 1, 2] = b
    return out
