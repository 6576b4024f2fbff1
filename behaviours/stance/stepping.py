"""Changing the stance's width, or its place: steps from one solved stance to another (section 8).

Nobody lifts a foot that carries weight. So for each foot that has to go, the weight first goes over the other one,
which becomes dominant; then the foot steps; at the end comes the new stance.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.stance import footprints
from behaviours.stance.footprints import Footprints
from behaviours.stance.lower_body import PELVIS_EXACT
from behaviours.stance.sequence import Move
from behaviours.stance.shape import LEFT_FOOT, RIGHT_FOOT, Shape, changed
from behaviours.stance.solve import StanceResult, solve_shape
from engine.body.skeleton import ANKLES, HIPS, KNEES, LEFT, RIGHT, Body
from engine.maths import quaternion, vector

SHIFT_S, SWING_S = 0.5, 0.55
SAME_PLACE_M, SAME_TURN_RAD = 1e-3, 5e-3  # nearer than this no step is worth it
LANDING_SHARE = 0.35  # a step is a small fall: when the foot lands, the weight is on its way over
LEAST_KNEE_RAD, STRAIGHTEST = 0.25, 0.97  # of standing and stepping legs
FOOT_NAMES = (LEFT_FOOT, RIGHT_FOOT)


def steps_to(body: Body, start: StanceResult, end: StanceResult) -> list[Move]:
    """The moves from one stance to another whose feet stand elsewhere; the lighter foot steps first."""
    moves, feet = [], start.feet
    first = LEFT if start.plan.lower.root == RIGHT else RIGHT
    for side in (first, 1 - first):
        if not _elsewhere(feet, end.feet, side):
            continue
        moved = _with(feet, end.feet, side)
        moves.append(Move(standing_on(body, start.shape, feet, 1 - side, 1.0), SHIFT_S, 0.0))
        moves.append(Move(standing_on(body, start.shape, moved, 1 - side, LANDING_SHARE), SWING_S, 0.0))
        feet = moved
    return [*moves, Move(end, SHIFT_S)]


def stands_elsewhere(feet: Footprints, wanted: Footprints) -> bool:
    """Whether either foot has to go to stand as wanted."""
    return any(_elsewhere(feet, wanted, side) for side in (LEFT, RIGHT))


def standing_on(body: Body, shape: Shape, feet: Footprints, side: int, share: float) -> StanceResult:
    """The shape's stance with weight over one foot (share 1: all of it), which is dominant, and both knees ready to
    give.
    """
    flat = footprints.raised(body, feet, -feet.toe_rad)
    over = share if side == LEFT else -share
    place_m = footprints.middle_m(body, flat, over)
    numbers = shape.numbers
    ready = max(LEAST_KNEE_RAD, *(_knee_to_reach(body, flat, place_m, k) for k in (LEFT, RIGHT)))
    eased = changed(
        shape, dominant=FOOT_NAMES[side], trade_off=PELVIS_EXACT, pelvis_z_rad=0.0, rise_rad=0.0, balance_x=0.0,
        knee_left_rad=max(numbers.knee_left_rad, ready), knee_right_rad=max(numbers.knee_right_rad, ready),
    )  # fmt: skip
    return solve_shape(body, eased, flat, balance_m=place_m)


def _knee_to_reach(body, feet, place_m, side):
    """How far both knees have to be bent for a level pelvis over a place to be low enough for this foot's leg."""
    thigh, shin = vector.length(body.offset_m[KNEES[side]]), vector.length(body.offset_m[ANKLES[side]])
    out = (1.0 - 2.0 * side) * body.offset_m[HIPS[side], 1]
    ankle = feet.ankle_m[side]
    level = max(math.hypot(ankle[0] - place_m[0], ankle[1] - place_m[1]) - abs(out), 0.0)
    height = math.sqrt(max((STRAIGHTEST * (thigh + shin)) ** 2 - level**2, (thigh - shin) ** 2))
    cosine = (height**2 - thigh**2 - shin**2) / (2.0 * thigh * shin)
    return math.acos(min(max(cosine, -1.0), 1.0))


def _elsewhere(feet, wanted, side):
    far = vector.distance(feet.ankle_m[side], wanted.ankle_m[side]) > SAME_PLACE_M
    return far or quaternion.angle_between(feet.foot_turned[side], wanted.foot_turned[side]) > SAME_TURN_RAD


def _with(feet, wanted, side):
    """The feet, one of them already where it is wanted; flat."""
    parts = [np.array(part) for part in feet]
    for part, new in zip(parts, wanted, strict=True):
        part[side] = new[side]
    return Footprints(*parts)
