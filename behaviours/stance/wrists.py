"""Wrists on their targets: the figure finished, in balance, with its arms inside their limits, and what a reach
lacks.
"""

from __future__ import annotations

import math

from behaviours.stance import arms, balance, elbows
from behaviours.stance.assembly import assemble
from engine.body import kinematics
from engine.body.skeleton import SHOULDERS
from engine.maths import vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

# rows of the (3, 2) array of wrists: how far each is from its target, metres; the swivel taken; the strain, radians
MISS, SWIVEL, STRAIN = range(3)

# an elbow is not stretched beyond this share of the arm's length as long as the torso can come nearer
COMFORTABLE = 0.97
# nor is it folded on a target that is nearer to the shoulder than this
NEAREST = 0.25
STRAIN_M = 0.3  # metres of lack that a radian of strain counts
FINISHING, FINISHED_M = 12, 1e-6


@njit(cache=True)
def reach_distance_m(plan, positions, side):
    """From a shoulder to its wrist's target."""
    return vector.distance(positions[SHOULDERS[side]], plan.wrist_m[side])


@inner_kernel
def distance_lack_m(away_m, arm_m):
    """How much too far or too near a target is for an arm of that length; negative where there is room to spare."""
    return max(away_m - COMFORTABLE * arm_m, NEAREST * arm_m - away_m)


@njit(cache=True)
def finish(body, plan, unknowns, search, figure, wrists):
    """The figure of the unknowns, in balance with its arms within their limits. Returns how far off balance it is,
    metres.
    """
    balance.find_balance(body, plan, unknowns, search, figure)
    error_m = 0.0
    for attempt in range(FINISHING + 1):
        # from the third time on the swivels stay near those taken, or two that are as good could take turns for ever
        reach_targets(body, plan, figure, wrists, attempt >= 2)
        com = kinematics.centre_of_mass(body, figure.positions, figure.orientations)
        error = (plan.balance_m[0] - com[0], plan.balance_m[1] - com[1])
        error_m = math.hypot(error[0], error[1])
        if error_m < FINISHED_M or attempt == FINISHING:
            break
        search.offset_rad[0], search.offset_rad[1] = balance.offsets_towards(search, search.offset_rad, error)
        assemble(body, plan, unknowns, (search.offset_rad[0], search.offset_rad[1]), figure)
    return error_m


@inner_kernel
def reach_targets(body, plan, figure, wrists, stay):
    """Puts the wrists that have one on their targets, in place, and writes what came of it to `wrists` (3, 2)."""
    for side in range(2):
        wanted = plan.arm[side, arms.SWIVEL] + arms.NEUTRAL_SWIVEL
        taken, strained = wrists[SWIVEL, side], wrists[STRAIN, side] > 0.0
        wrists[MISS, side], wrists[SWIVEL, side], wrists[STRAIN, side] = 0.0, wanted, 0.0
        if not plan.reaching[side]:
            continue
        if stay:
            miss_m, strain = elbows.reach_strained(
                body, figure.rotations, figure.positions, figure.orientations, side, plan.wrist_m[side], taken
            )
            if strain == 0.0 or strained:
                wrists[MISS, side], wrists[SWIVEL, side], wrists[STRAIN, side] = miss_m, taken, strain
                continue
        start = taken if stay else wanted
        wrists[MISS, side], wrists[SWIVEL, side], wrists[STRAIN, side] = elbows.reach_within_limits(
            body, figure.rotations, figure.positions, figure.orientations, side, plan.wrist_m[side], wanted, start
        )


@njit(cache=True)
def greatest_lack_m(body, plan, figure, wrists):
    """What a finished figure lacks: how much too far or too near the worse shoulder is, and how far its arm is beyond
    its limits, as metres.
    """
    worst = 0.0
    for side in range(2):
        if plan.reaching[side]:
            away = reach_distance_m(plan, figure.positions, side)
            astray = max(distance_lack_m(away, arms.arm_length_m(body, side)), 0.0)
            worst = max(worst, astray + STRAIN_M * wrists[STRAIN, side])
    return worst


@inner_kernel
def lacks_at(body, plan, unknowns, search, figure, wrists, lacks):
    """Writes (2,) what each wrist lacks with these unknowns, metres, negative where there is room to spare. Leaves
    the arms unfinished.

    Arms are strained as much as they are at the swivels that they have taken.
    """
    wanted = (plan.arm[0, arms.SWIVEL], plan.arm[1, arms.SWIVEL])
    for side in range(2):
        plan.arm[side, arms.SWIVEL] = wrists[SWIVEL, side] - arms.NEUTRAL_SWIVEL
    com_m = assemble(body, plan, unknowns, (search.offset_rad[0], search.offset_rad[1]), figure)
    way = balance.settle(body, plan, search, com_m, figure)
    for side in range(2):
        plan.arm[side, arms.SWIVEL] = wanted[side]
        lacks[side] = -1.0
        if plan.reaching[side]:
            away = vector.distance(balance.carried(way, figure.positions[SHOULDERS[side]]), plan.wrist_m[side])
            lacks[side] = distance_lack_m(away, arms.arm_length_m(body, side))
            strain = elbows.strain_rad(body, figure.rotations, side)
            if strain > elbows.ROUNDING_RAD:
                lacks[side] = max(lacks[side], 0.0) + STRAIN_M * strain
