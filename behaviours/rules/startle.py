"""Startle (Hermens 2006, 3.2.6): the reflex before the considered defence. A fifth of a full recoil, both sides
alike.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.rules.recoil import raise_clavicle, retract_arm
from behaviours.settings import Settings
from engine.body.capsules import Capsules, body_capsules, capsules_at
from engine.body.kinematics import joints_of
from engine.body.limits import clamp_keeping
from engine.body.overlap import PAIRS, depths_into
from engine.body.skeleton import CLAVICLES, ELBOWS, HEAD, LEFT, NECK, SHOULDERS, Body, Pose
from engine.maths import quaternion
from engine.maths.kernel import njit

LIFT_RAD, LIFTS, HALVINGS = math.radians(6.0), 11, 8  # how far aside both arms are lifted out of the body, at most


def recoiled(rotations: np.ndarray, settings: Settings) -> np.ndarray:
    """The full recoil of table 3.2, lower half, arms too, on a pose's rotations (J, 4); a copy."""
    out = np.array(rotations, float)
    for side in range(2):
        raise_clavicle(out, side, 1.0, settings.recoil)
        retract_arm(out, side, 1.0, settings.recoil)
    return out


@njit(cache=True)
def turn_towards(head_orientation, toward, share):
    """The yaw, radians, that turns the face a share of the way to a threat; `toward` is the direction to it, world."""
    if toward[0] * toward[0] + toward[1] * toward[1] < 1e-9:
        return 0.0
    way = math.atan2(toward[1], toward[0]) - quaternion.heading(head_orientation)
    return share * ((way + math.pi) % (2.0 * math.pi) - math.pi)


def startle_pose(body: Body, pose_ahead: Pose, toward, settings: Settings) -> Pose:
    """The startle pose: the clip 1/12 s ahead, mixed with its own full recoil, the head turned some of the way to the
    threat.

    toward (3,): unit vector to the threat, world. The turn is shared by neck and head, within their limits. No balance.
    """
    s = settings.startle
    rotations = arms_recoiled(body, pose_ahead, settings)
    _, orientations = joints_of(body, Pose(pose_ahead.root_m, rotations))
    yaw = turn_towards(orientations[HEAD], (float(toward[0]), float(toward[1])), s.head_turn_share)
    for joint in (NECK, HEAD):
        up = quaternion.unrotate(orientations[joint], (0.0, 0.0, 1.0))
        turned = quaternion.multiply(rotations[joint], quaternion.from_axis_angle(up, 0.5 * yaw))
        rotations[joint] = clamp_keeping(
            body.limit_low_rad[joint], body.limit_high_rad[joint], pose_ahead.rotations[joint], turned
        )
    return Pose(np.array(pose_ahead.root_m, float), rotations)


def arms_recoiled(body: Body, pose_ahead: Pose, settings: Settings) -> np.ndarray:
    """(J, 4) the clip's rotations with both arms a share of the way to their full recoil, within their limits.

    A forearm that flexes beside the hip or before the chest may go into it. Both arms are then lifted aside as far as
    it takes to have no more of that than the clip itself, or, where that is of no help, draw in that much less.
    """
    capsules, weight = body_capsules(body), settings.startle.recoil_weight
    own_m = np.maximum(depths_m(body, capsules, pose_ahead), 0.0)
    full = recoiled(pose_ahead.rotations, settings)

    def drawn_in(share: float, aside_rad: float) -> np.ndarray:
        rotations = np.array(pose_ahead.rotations, float)
        for side in range(2):
            lift = quaternion.about_x(aside_rad if side == LEFT else -aside_rad)
            for joint in (CLAVICLES[side], SHOULDERS[side], ELBOWS[side]):
                part = weight if joint == CLAVICLES[side] else share * weight
                turned = quaternion.slerp(pose_ahead.rotations[joint], full[joint], part)
                turned = quaternion.multiply(lift, turned) if joint == SHOULDERS[side] else turned
                rotations[joint] = clamp_keeping(
                    body.limit_low_rad[joint], body.limit_high_rad[joint], pose_ahead.rotations[joint], turned
                )
        return rotations

    def clear(share: float, aside_rad: float) -> bool:
        pose = Pose(pose_ahead.root_m, drawn_in(share, aside_rad))
        return bool((depths_m(body, capsules, pose) <= own_m).all())

    aside_rad = next((k * LIFT_RAD for k in range(LIFTS) if clear(1.0, k * LIFT_RAD)), None)
    if aside_rad is not None:
        return drawn_in(1.0, aside_rad and _least(lambda lift_rad: clear(1.0, lift_rad), 0.0, aside_rad))
    return drawn_in(_least(lambda share: clear(share, 0.0), 1.0, 0.0), 0.0)


def _least(clear, bad: float, good: float) -> float:
    """By halving: the nearest to what is bad that is as good, between both."""
    for _ in range(HALVINGS):
        middle = 0.5 * (bad + good)
        bad, good = (bad, middle) if clear(middle) else (middle, good)
    return good


def depths_m(body: Body, capsules: Capsules, pose: Pose) -> np.ndarray:
    """(P,) how deep each of overlap.PAIRS lies in each other, metres; negative when apart."""
    out = np.empty(len(PAIRS))
    depths_into(capsules_at(capsules, *joints_of(body, pose)), capsules.radius_m, PAIRS, out)
    return out
