"""Balance (section 4): the root ankle's two offsets bring the centre of mass over the place where it is wanted.

In a pose solve the offsets are searched for; while animating they are fed the error, tick by tick. In both cases the
lower body is solved anew for every offset, so the feet do not move.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.stance import lower_body
from behaviours.stance.assembly import assemble
from engine.body.skeleton import PELVIS
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

# of what the hips move, the centre of mass moves about this share: the start of the search
SHARE_OF_HIPS = 0.85
LARGEST_OFFSET_RAD = math.radians(35.0)
TOLERANCE_M = 1e-6
LONGEST_SEARCH = 25


class BalanceSearch(NamedTuple):
    """Where a search for the offsets stands; kept between evaluations, so that the next one starts warm."""

    offset_rad: np.ndarray  # (2,) the paper's X and Z
    inverse: np.ndarray  # (2, 2) radians per metre: offsets that move the centre of mass by a metre of world X, Y


@njit(cache=True)
def new_search(lower):
    """Offsets of zero and a first guess of what they do: they swing the leg about its ankle."""
    search = BalanceSearch(np.zeros(2), np.empty((2, 2)))
    gain = 1.0 / (SHARE_OF_HIPS * lower.leg_m[lower.root])
    ahead = quaternion.rotate(lower.facing, (1.0, 0.0, 0.0))
    c, s = ahead[0], ahead[1]
    # X swings ahead, Z swings to the right
    search.inverse[0, 0], search.inverse[0, 1] = gain * c, gain * s
    search.inverse[1, 0], search.inverse[1, 1] = gain * s, -gain * c
    return search


@njit(cache=True)
def offsets_towards(search, start_rad, error_m):
    """One step of the search from offsets: held within what an ankle can do."""
    inverse = search.inverse
    x = start_rad[0] + inverse[0, 0] * error_m[0] + inverse[0, 1] * error_m[1]
    z = start_rad[1] + inverse[1, 0] * error_m[0] + inverse[1, 1] * error_m[1]
    return (
        min(max(x, -LARGEST_OFFSET_RAD), LARGEST_OFFSET_RAD),
        min(max(z, -LARGEST_OFFSET_RAD), LARGEST_OFFSET_RAD),
    )


@njit(cache=True)
def settle(body, plan, search, com_m, figure):
    """One step of the search for a figure assembled at the search's offsets, with only the pelvis solved anew.

    What hangs above the pelvis goes along with it as one piece: a tenth of the cost of assembling, and still a smooth
    function of the unknowns. Returns the way of every point above the pelvis: (centre, turn, new centre), see
    `carried`.
    """
    error = (plan.balance_m[0] - com_m[0], plan.balance_m[1] - com_m[1])
    offsets = offsets_towards(search, (search.offset_rad[0], search.offset_rad[1]), error)
    place, pelvis, _, _ = lower_body.place_pelvis(body, plan.lower, offsets)
    turn = quaternion.multiply(pelvis, quaternion.conjugate(figure.orientations[PELVIS]))
    return (figure.root_m[0], figure.root_m[1], figure.root_m[2]), turn, place


@njit(cache=True)
def carried(way, point):
    """Where a point above the pelvis comes to be; see `settle`."""
    centre, turn, new_centre = way
    return vector.add(new_centre, quaternion.rotate(turn, vector.subtract(point, centre)))


@njit(cache=True)
def find_balance(body, plan, unknowns, search, figure):
    """The search of a pose solve: steps until the place is met, learning on the way (Broyden 1965). Leaves `search`
    there.

    Returns how far the centre of mass is from where it is wanted, metres. Assembles the figure with the offsets found.
    """
    offsets = (search.offset_rad[0], search.offset_rad[1])
    com = assemble(body, plan, unknowns, offsets, figure)
    error = (plan.balance_m[0] - com[0], plan.balance_m[1] - com[1])
    for _ in range(LONGEST_SEARCH):
        if math.hypot(error[0], error[1]) < TOLERANCE_M:
            break
        new = offsets_towards(search, offsets, error)
        moved = (new[0] - offsets[0], new[1] - offsets[1])
        if moved[0] == 0.0 and moved[1] == 0.0:
            break
        offsets = new
        com_before = com
        com = assemble(body, plan, unknowns, offsets, figure)
        _learn(search.inverse, moved, (com[0] - com_before[0], com[1] - com_before[1]))
        error = (plan.balance_m[0] - com[0], plan.balance_m[1] - com[1])
    search.offset_rad[0], search.offset_rad[1] = offsets
    return math.hypot(error[0], error[1])


@inner_kernel
def _learn(inverse, moved, went):
    """Broyden's update of the inverse: it now takes what the centre of mass did to what the offsets did."""
    guess = (
        inverse[0, 0] * went[0] + inverse[0, 1] * went[1],
        inverse[1, 0] * went[0] + inverse[1, 1] * went[1],
    )
    left = (moved[0] * inverse[0, 0] + moved[1] * inverse[1, 0], moved[0] * inverse[0, 1] + moved[1] * inverse[1, 1])
    scale = left[0] * went[0] + left[1] * went[1]
    if abs(scale) < 1e-12 * math.hypot(moved[0], moved[1]) or abs(scale) < 1e-24:
        return
    for i in range(2):
        for j in range(2):
            inverse[i, j] += (moved[i] - guess[i]) * left[j] / scale


def fed_back(search: BalanceSearch, offset_rad, error_m, per_s: float, dt_s: float):
    """The offsets after one tick of feedback (section 4): the error of the projection moves the ankle's Z and X axes.

    error_m: wanted less actual place, world X, Y. per_s: the rate at which an error dies away.
    """
    share = 1.0 - math.exp(-per_s * dt_s)
    return offsets_towards(search, offset_rad, (share * error_m[0], share * error_m[1]))
