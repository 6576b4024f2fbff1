"""The whole body as one solid, limbs melted into the trunk, in the pose in which it is meshed: arms and legs apart.

Also how fine its cells must be where, and what is painted on it: glass before the eyes, shoes, shorts and knee pads.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from engine.body import skeleton as sk
from engine.body.skeleton import Body
from engine.maths import quaternion
from engine.render.sculpture.arm import forearm, upper_arm
from engine.render.sculpture.hand import hand
from engine.render.sculpture.head import outside_lens, skull_and_face
from engine.render.sculpture.leg import foot_and_toes, shin, thigh
from engine.render.sculpture.parts import outwards
from engine.render.sculpture.trunk import abdomen, pelvis, ribs, shoulder_drop_m, throat, trunk_of, yoke
from engine.render.surface import Shape, blend, ellipsoid, near_only, placed, shifted, taper

ARMS_APART_RAD, LEGS_APART_RAD = math.radians(48.0), math.radians(9.0)
ROOT_M, LEVELS = 0.080, 4  # cells of 80 mm, down to 5 mm
TRUNK_CELL_M, HEAD_CELL_M, HAND_CELL_M = 0.020, 0.010, 0.005
SHORTS, PAD_HALF_M = 0.46, 0.054  # how far down the thigh they reach, as its share; half the height of a knee pad
NEAR_M = 0.09  # wider than any blend


class Bind(NamedTuple):
    """Where the joints are while the body is meshed."""

    positions: np.ndarray  # (21, 3) the pelvis at the origin
    orientations: np.ndarray  # (21, 4) w x y z


def bind_pose(body: Body) -> Bind:
    """Arms half raised and legs apart, so that nothing touches what it is not part of; feet level."""
    turns = {}
    for side in (sk.LEFT, sk.RIGHT):
        turns[sk.SHOULDERS[side]] = quaternion.about_x(outwards(side) * ARMS_APART_RAD)
        turns[sk.HIPS[side]] = quaternion.about_x(outwards(side) * LEGS_APART_RAD)
        turns[sk.ANKLES[side]] = quaternion.about_x(-outwards(side) * LEGS_APART_RAD)
    positions, orientations = np.zeros((sk.JOINT_COUNT, 3)), np.tile((1.0, 0.0, 0.0, 0.0), (sk.JOINT_COUNT, 1))
    for joint in range(1, sk.JOINT_COUNT):
        carried = tuple(orientations[sk.PARENT[joint]])
        positions[joint] = positions[sk.PARENT[joint]] + quaternion.rotate(carried, tuple(body.offset_m[joint]))
        orientations[joint] = quaternion.multiply(carried, turns.get(joint, quaternion.IDENTITY))
    return Bind(positions, orientations)


def whole_body(body: Body, bind: Bind) -> Shape:
    """One solid in the frame of the pelvis. Mirrored exactly where the body is."""
    trunk = trunk_of(bind.positions, shoulder_drop_m(bind.positions))
    yokes = [_at(bind, sk.CLAVICLES[side], yoke(body, side, trunk.drop_m)) for side in (sk.LEFT, sk.RIGHT)]
    middle = blend(0.06, *[near_only(flesh(trunk), 2.0 * NEAR_M) for flesh in (pelvis, abdomen, ribs)])
    core = blend(0.05, middle, *yokes)
    head = _at(bind, sk.HEAD, skull_and_face(body)[1])
    neck = _at(bind, sk.NECK, shifted(throat(body, 0.94), np.array((-0.006, 0.0, 0.0))))
    limbs = [_at(bind, sk.SHOULDERS[side], _arm(body, side, trunk.drop_m)) for side in (sk.LEFT, sk.RIGHT)]
    legs = [_at(bind, sk.HIPS[side], _leg(body, side)) for side in (sk.LEFT, sk.RIGHT)]
    feet = [_at(bind, sk.ANKLES[side], _foot(body, side)) for side in (sk.LEFT, sk.RIGHT)]
    below = blend(0.02, *[blend(0.03, leg, foot) for leg, foot in zip(legs, feet, strict=True)])
    return blend(0.014, blend(0.036, blend(0.055, core, below), neck, *limbs), head)


def cell_m(body: Body, bind: Bind, coarser: float):
    """A function (N, 3) -> (N,): how large a cell may be there, metres. Small around hands, face, head and feet."""
    head = bind.positions[sk.HEAD]
    centres = [
        (head + body.head_top_m + (0.07, 0.0, -0.13), 0.06, HAND_CELL_M, 0.3),  # the face
        (head + 0.45 * body.head_top_m, 0.13, HEAD_CELL_M, 0.5),
    ]
    for side in (sk.LEFT, sk.RIGHT):
        tip, toe = body.fingertip_m[side], body.offset_m[sk.TOES[side]]
        centres.append((_from(bind, sk.WRISTS[side], 0.58 * tip), 0.56 * float(np.linalg.norm(tip)), HAND_CELL_M, 0.6))
        centres.append((_from(bind, sk.ANKLES[side], 0.6 * toe), 0.16, HEAD_CELL_M, 0.5))

    def wanted(points: np.ndarray) -> np.ndarray:
        cell = np.full(len(points), TRUNK_CELL_M)
        for centre, radius_m, finest_m, growth in centres:
            outside_m = np.linalg.norm(points - centre, axis=1) - radius_m
            cell = np.minimum(cell, finest_m + growth * np.maximum(outside_m, 0.0))
        return coarser * cell

    return wanted


def paint_m(body: Body, bind: Bind, points: np.ndarray) -> np.ndarray:
    """(N, 3) -> (N, 3): about how far, in metres, from the dark dress, the glass and the shoes; negative on them."""
    lens = outside_lens(_seen_from(bind, sk.HEAD, points), body.head_top_m)
    dress = shoes = np.full(len(points), 1.0)
    trunk = trunk_of(bind.positions)
    waistband = points[:, 2] - trunk.at(0.30)[2]
    for side in (sk.LEFT, sk.RIGHT):
        foot = _seen_from(bind, sk.ANKLES[side], points)
        collar = foot[:, 2] - 0.022 + 0.12 * foot[:, 0]
        shoes = np.minimum(shoes, np.where(np.linalg.norm(foot, axis=1) < 0.35, collar, 1.0))
        thigh_m, mine = np.linalg.norm(body.offset_m[sk.KNEES[side]]), outwards(side) * points[:, 1] > 0.0
        leg = _seen_from(bind, sk.HIPS[side], points)
        beside = np.linalg.norm(leg[:, :2], axis=1) > 0.24  # an arm
        hem = -leg[:, 2] - SHORTS * thigh_m + 0.05 * leg[:, 1] * outwards(side)
        pad = np.abs(leg[:, 2] + thigh_m + 0.006) - PAD_HALF_M
        worn = np.minimum(np.maximum(waistband, hem), pad)
        dress = np.minimum(dress, np.where(mine & ~beside, worn, 1.0))
    return np.column_stack([dress, lens, shoes])


def _arm(body: Body, side: int, drop_m: float) -> Shape:
    """Upper arm, elbow, forearm and hand, straight, in the shoulder's frame."""
    elbow, wrist = body.offset_m[sk.ELBOWS[side]], body.offset_m[sk.WRISTS[side]]
    out = outwards(side)
    point = ellipsoid(elbow + (-0.018, 0.0, -0.004), (0.020, 0.023, 0.032))
    halves = (upper_arm(elbow, out, drop_m), shifted(forearm(wrist, out), elbow))
    bones = blend(0.010, *[near_only(flesh, NEAR_M) for flesh in halves])
    return blend(0.024, bones, point, near_only(shifted(hand(body.fingertip_m[side], -out), elbow + wrist), NEAR_M))


def _leg(body: Body, side: int) -> Shape:
    """Hip, thigh, knee and shin, straight, in the hip's frame."""
    knee, ankle = body.offset_m[sk.KNEES[side]], body.offset_m[sk.ANKLES[side]]
    out = outwards(side)
    hip = taper((-0.004, 0.020 * out, 0.012), 0.30 * knee + (0.004, 0.010 * out, 0.0), 0.074, 0.066)
    cap = ellipsoid(knee + (0.022, 0.0, 0.004), (0.030, 0.034, 0.042))
    ankles = [ellipsoid(knee + ankle + (-0.004, k * 0.023, -0.004), (0.019, 0.015, 0.022)) for k in (-1, 1)]
    bones = blend(0.012, *[near_only(flesh, NEAR_M) for flesh in (thigh(knee, out), shifted(shin(ankle, out), knee))])
    return blend(0.022, blend(0.04, bones, near_only(hip, NEAR_M)), cap, *ankles)


def _foot(body: Body, side: int) -> Shape:
    """Foot and toes in the ankle's frame; flat where they stand."""
    to_toe = body.offset_m[sk.TOES[side]]
    foot, toes = foot_and_toes(body.sole_m[side], to_toe)
    return blend(0.016, foot, shifted(toes, to_toe))


def _at(bind: Bind, joint: int, shape: Shape) -> Shape:
    """A shape of a joint's frame where the joint is, cheap to ask from afar."""
    return near_only(placed(shape, bind.positions[joint], bind.orientations[joint]), NEAR_M)


def _from(bind: Bind, joint: int, point) -> np.ndarray:
    """A point of a joint's frame, seen from the pelvis."""
    return bind.positions[joint] + np.array(quaternion.rotate(tuple(bind.orientations[joint]), tuple(point)))


def _seen_from(bind: Bind, joint: int, points: np.ndarray) -> np.ndarray:
    """Points (N, 3) of the pelvis's frame in a joint's."""
    axes = np.array([quaternion.rotate(tuple(bind.orientations[joint]), axis) for axis in np.eye(3)])
    return (points - bind.positions[joint]) @ axes.T
