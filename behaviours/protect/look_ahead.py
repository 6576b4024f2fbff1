"""How far along its way the pelvis is when it meets the threat (Hermens 2006, 3.3 and 4.2; specification A4).

The look-ahead keeps the body's momentum, but over a foot that stays it can ask for more than a leg can give: too
long, or bent back beyond the hip's limit, or the shin forward beyond the ankle's, all the more when the body then
braces itself. The pelvis is drawn within reach, and no farther ahead than the planted legs allow.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.protect.apply_rules import place_trunk, plant_leg
from behaviours.protect.plant import pull_pelvis
from behaviours.rules.controls import LEAN, TURN
from engine.body.kinematics import joints_into
from engine.body.skeleton import HIPS, PELVIS
from engine.body.two_bones import SOFT_REACH_M
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

SHARES = 8  # of the look-ahead that are tried, all of it first
HALVINGS = 10
BRACED_M = (1.1, -0.04)  # where bracing takes the pelvis: shares of the COM's way, metres down; medians of real frames


class PelvisWay(NamedTuple):
    """The pelvis at perception and at the look-ahead, world; and the thighs of planted legs at perception, (2, 4)."""

    now_m: tuple[float, float, float]
    now_turned: tuple[float, float, float, float]
    ahead_m: tuple[float, float, float]
    ahead_turned: tuple[float, float, float, float]
    thighs: np.ndarray


@inner_kernel
def legs_trouble(task, controls, root_m, posed):
    """What limits forbid the planted legs with the pelvis here, lean and turn done, radians; 0 if nothing."""
    start, bones, feet = task.start, task.bones, task.feet
    place_trunk(
        root_m, controls[LEAN], controls[TURN], start.heading_rad, task.threat, task.choices, task.rules,
        bones.offset_m, start.rotations, start.orientations, start.low_rad, start.high_rad,
        posed.rotations, posed.positions, posed.orientations,
    )  # fmt: skip
    worst = 0.0
    for side in range(2):
        if feet.held[side]:
            _, wrong = plant_leg(
                side, vector.at(feet.ankle_m, side), quaternion.at(feet.turned, side), quaternion.at(feet.toe, side),
                task.build.knee_rad[side], SOFT_REACH_M, bones.offset_m, start.rotations, start.orientations,
                start.low_rad, start.high_rad, task.rules.limit_margin_rad,
                posed.rotations, posed.positions, posed.orientations,
            )  # fmt: skip
            worst = max(worst, wrong)
    return worst


@inner_kernel
def set_pelvis(task, controls, way, share, leg_share, posed):
    """Puts the start pose's pelvis this share of its way, drawn within reach of the planted feet, in place."""
    start, bones = task.start, task.bones
    root = vector.mix(way.now_m, way.ahead_m, share)
    quaternion.put(start.rotations, PELVIS, quaternion.slerp(way.now_turned, way.ahead_turned, share))
    joints_into(bones.offset_m, root, start.rotations, posed.positions, start.orientations)
    for side in range(2):
        if task.feet.held[side]:  # a planted leg's thigh starts from where it is in the world, whatever the pelvis does
            quaternion.put(start.orientations, HIPS[side], quaternion.at(way.thighs, side))
    legs_trouble(task, controls, root, posed)
    pulled = pull_pelvis(task.build.leg_m, posed.positions, task.feet, leg_share)
    for k in range(3):
        start.root_m[k] = root[k] + pulled[k]


@inner_kernel
def _braced_trouble(task, controls, way, share, leg_share, braced, posed):
    set_pelvis(task, controls, way, share, leg_share, posed)
    root = task.start.root_m
    return legs_trouble(task, controls, (root[0] + braced[0], root[1] + braced[1], root[2] + braced[2]), posed)


@njit(cache=True)
def go_ahead(task, controls, way, leg_share, brace_m, posed):
    """Puts the start pose's pelvis as far on its way as the planted legs allow, braced, in place.

    Returns the share, at most 1; the least bad one where none is allowed.
    """
    direction = task.threat.direction
    towards = vector.unit((-direction[0], -direction[1], 0.0), (0.0, 0.0, 0.0))
    forward, down = BRACED_M
    braced = (towards[0] * brace_m * forward, towards[1] * brace_m * forward, down)
    best = 1.0
    least = _braced_trouble(task, controls, way, best, leg_share, braced, posed)
    for k in range(1, SHARES + 1):
        if least == 0.0:
            break
        share = 1.0 - k / SHARES
        wrong = _braced_trouble(task, controls, way, share, leg_share, braced, posed)
        if wrong < least - 1e-9:
            best, least = share, wrong
    too_far = best + 1.0 / SHARES
    for _ in range(HALVINGS if best < 1.0 and least == 0.0 else 0):
        middle = 0.5 * (best + too_far)
        if _braced_trouble(task, controls, way, middle, leg_share, braced, posed) == 0.0:
            best = middle
        else:
            too_far = middle
    set_pelvis(task, controls, way, best, leg_share, posed)
    return best
