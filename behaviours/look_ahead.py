"""How far along its way the pelvis is when it meets the threat (Hermens 2006, 3.3 and 4.2; specification A4).

The look-ahead keeps the body's momentum, but over a foot that stays it can ask for more than a leg can give: too long, or
bent back beyond the hip's limit, or the shin forward beyond the ankle's, all the more when the body then braces itself. The
pelvis is drawn within reach, and no farther ahead than the planted legs allow.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from behaviours.apply_rules import place_trunk, plant_leg
from behaviours.plant import pull_pelvis
from behaviours.rules.controls import LEAN, TURN
from engine.body.two_bones import SOFT_REACH_M
from engine.maths import quaternion, vector

SHARES = 8  # of the look-ahead that are tried, all of it first
HALVINGS = 10
BRACED_M = (1.1, -0.04)  # where bracing takes the pelvis: shares of the COM's way, metres down; medians of real frames


@njit(cache=True)
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
                start.low_rad, start.high_rad, task.rules.limit_margin_rad, posed.obstacles,
                task.build.obstacle_radius_m, posed.rotations, posed.positions, posed.orientations,
            )  # fmt: skip
            worst = max(worst, wrong)
    return worst


@njit(cache=True)
def pelvis_on_its_way(task, controls, now_m, ahead_m, share, leg_share, posed):
    """(3,) the pelvis this share of the way from now to ahead, drawn within reach of the planted feet."""
    x, y, z = vector.mix(now_m, ahead_m, share)
    root_m = np.array((x, y, z))
    legs_trouble(task, controls, (x, y, z), posed)
    return root_m + pull_pelvis(task.build.leg_m, posed.positions, task.feet, leg_share)


@njit(cache=True)
def _braced_trouble(task, controls, now_m, ahead_m, share, leg_share, braced, posed):
    root = pelvis_on_its_way(task, controls, now_m, ahead_m, share, leg_share, posed)
    return legs_trouble(task, controls, (root[0] + braced[0], root[1] + braced[1], root[2] + braced[2]), posed)


@njit(cache=True)
def farthest_ahead(task, controls, now_m, ahead_m, leg_share, brace_m, posed):
    """The share of the look-ahead, at most 1, that the planted legs allow, braced; the least bad where none is allowed.

    now_m, ahead_m: the pelvis at perception and at the look-ahead, tuples, world metres.
    """
    direction = task.threat.direction
    towards = vector.unit((-direction[0], -direction[1], 0.0), (0.0, 0.0, 0.0))
    forward, down = BRACED_M
    braced = (towards[0] * brace_m * forward, towards[1] * brace_m * forward, down)
    best = 1.0
    least = _braced_trouble(task, controls, now_m, ahead_m, best, leg_share, braced, posed)
    for k in range(1, SHARES + 1):
        if least == 0.0:
            break
        share = 1.0 - k / SHARES
        wrong = _braced_trouble(task, controls, now_m, ahead_m, share, leg_share, braced, posed)
        if wrong < least - 1e-9:
            best, least = share, wrong
    if best == 1.0 or least > 0.0:
        return best
    too_far = best + 1.0 / SHARES
    for _ in range(HALVINGS):
        middle = 0.5 * (best + too_far)
        if _braced_trouble(task, controls, now_m, ahead_m, middle, leg_share, braced, posed) == 0.0:
            best = middle
        else:
            too_far = middle
    return best
