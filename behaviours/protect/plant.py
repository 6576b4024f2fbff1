"""Both feet on the ground before the rules run (Hermens 2006, 3.3; specification A4): where each foot stands.

A foot that is planted at perception stays. One in the air goes to the nearest ground that its leg reaches, below
where the look-ahead has carried it; it is left in the air only where the hip is too high.
"""

from __future__ import annotations

import numpy as np

from behaviours.protect.task import FeetPlan
from engine.body.footing import leg_length_m, nearest_footing, sole_depth_m
from engine.body.skeleton import ANKLES, HIPS, TOES, Body
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel

CLEAR_M = 0.01  # of reach to spare, so that the foot need not stand exactly under its hip
PULLS = 60  # averaged projections: two legs that both fall short agree to a fraction of a millimetre


@inner_kernel
def pull_pelvis(leg_m, positions, feet, leg_share):
    """(3,) the least shift of the pelvis, metres, that brings every held foot within its share of the leg's length.

    positions (J, 3): hips of the rules pose. The look-ahead carries the pelvis out of the planted leg's reach in over a
    third of the frames of a walk; it is drawn back along the leg, which mostly lowers it.
    """
    shift, pull = np.zeros(3), np.zeros(3)
    for _ in range(PULLS):
        pull[:] = 0.0
        short = 0
        for side in range(2):
            hip, ankle = vector.at(positions, HIPS[side]), vector.at(feet.ankle_m, side)
            leg = (hip[0] + shift[0] - ankle[0], hip[1] + shift[1] - ankle[1], hip[2] + shift[2] - ankle[2])
            long, reach = vector.length(leg), leg_m[side] * leg_share
            if feet.held[side] and long > reach:
                short += 1
                for k in range(3):
                    pull[k] += leg[k] * (reach / long - 1.0)
        if short == 0:
            break
        shift += pull / short  # both at once, so that left and right are treated alike
    return shift


def stand_where_planted(planted, positions, orientations, rotations) -> FeetPlan:
    """The plan that holds every planted foot exactly where a pose (J, ...) has it; the other is not held."""
    ankles, toes = list(ANKLES), list(TOES)
    return FeetPlan(
        positions[ankles].copy(),
        orientations[ankles].copy(),
        rotations[toes].copy(),
        np.array(planted, bool),
        np.zeros(2),
    )


def lowering_m(body: Body, feet: FeetPlan, hips_m, leg_share: float, most_m: float) -> float:
    """How far the pelvis has to go down for a foot in the air to reach the ground under its hip; 0 if that is too far.

    Hips (2, 3) of the rules pose. On a stretched standing leg the other hip is about as high: it is worth a bent knee.
    """
    needed_m = 0.0
    for side in range(2):
        if not feet.held[side]:
            reach_m = leg_share * leg_length_m(body, side) - CLEAR_M
            short_m = float(hips_m[side][2]) - sole_depth_m(body, side) - reach_m
            if short_m <= most_m:
                needed_m = max(needed_m, short_m)
    return needed_m


def set_down(body: Body, feet: FeetPlan, hips_m, ahead_positions, ahead_orientations, leg_share: float) -> FeetPlan:
    """The plan with the feet that are in the air set down where they reach the ground: flat, heading as they will head.

    hips_m (2, 3): of the rules pose; ahead_... (J, ...): the clip at the look-ahead, which says where the feet are
    going.
    """
    feet = FeetPlan(*(array.copy() for array in feet))
    positions = np.ascontiguousarray(ahead_positions)
    positions[list(HIPS)] = hips_m
    for side in range(2):
        if not feet.held[side]:
            spare_m = leg_length_m(body, side) * (1.0 - leg_share)
            place, turned, reached = nearest_footing(body, positions, ahead_orientations, side, 0.0, spare_m)
            if reached:
                feet.ankle_m[side], feet.turned[side] = place, turned
                feet.toe[side] = quaternion.IDENTITY
                feet.held[side] = True
    return feet


def steps_m(feet: FeetPlan, now_positions: np.ndarray) -> np.ndarray:
    """(2,) how far each held foot goes from where it is at perception (J, 3); beyond 3 cm it is lifted, never
    dragged.
    """
    away = feet.ankle_m - now_positions[list(ANKLES)]
    return np.where(feet.held, np.sqrt(np.sum(away * away, axis=1)), 0.0)
