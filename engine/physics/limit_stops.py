"""Limits that stop a joint: it turns no farther than a person's does, or than the pose that is held.

Each component of a joint's rotation near its limit is a row for `engine.physics.stops`: the rate at which it comes
away from there.
"""

from __future__ import annotations

import math

from engine.body.limits import components
from engine.body.skeleton import JOINT_COUNT
from engine.maths import quaternion
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

NEAR_RAD = 0.4  # of its limit: nothing turns farther than this in `stops.EASE_S`
CREEP_RADPS, CREEP_RAD = 0.3, math.radians(0.3)  # what a limp joint gives, and how far that goes
TOUCHING_RAD = 0.05  # what a blow closes at once: this counts as touching
MOST_SWING_RAD = 2.9  # nearer to half a turn, where the axis of a swing flips, its components say nothing
NEAR_RADPS = 0.5  # a bound that is met by less than this may be broken by the impulses of others: it is kept in view
NUDGE_RAD = 1e-6


@njit(cache=True)
def limits_into(qpos, qvel, low, high, target, ease_s, limp, farthest_rad, rows, least):
    """Fills in the rows (N, nv), zero before, and bounds (N,) of the limits of all joints; how many."""
    count = 0
    for j in range(1, JOINT_COUNT):
        count = _limits_of(j, qpos, qvel, low[j], high[j], target[j], ease_s, limp, farthest_rad, rows, least, count)
    return count


@inner_kernel
def _limits_of(j, qpos, qvel, low, high, target, ease_s, limp, farthest_rad, rows, least, count):
    """Adds the rows of one joint's limits, those that the target oversteps moved out to it: all that are not far, if
    one is broken or nearly so, since what holds that one turns into the others."""
    a, v = 3 + 4 * j, 3 + 3 * j
    q = quaternion.normalise((qpos[a], qpos[a + 1], qpos[a + 2], qpos[a + 3]))
    now, aim = components(q), components(target)
    if now[0] * now[0] + now[1] * now[1] > MOST_SWING_RAD**2:
        return count
    near = False
    for k in range(3):
        near |= min(now[k] - min(low[k], aim[k]), max(high[k], aim[k]) - now[k]) <= farthest_rad
    if not near:
        return count
    turned = (
        components(quaternion.multiply(q, quaternion.from_rotation_vector((NUDGE_RAD, 0.0, 0.0)))),
        components(quaternion.multiply(q, quaternion.from_rotation_vector((0.0, NUDGE_RAD, 0.0)))),
        components(quaternion.multiply(q, quaternion.from_rotation_vector((0.0, 0.0, NUDGE_RAD)))),
    )
    first, broken = count, False
    for k in range(3):
        for sign in (1.0, -1.0):
            room = now[k] - min(low[k], aim[k]) if sign > 0.0 else max(high[k], aim[k]) - now[k]
            if room > farthest_rad or count == len(least):
                continue
            rate = 0.0
            for axis in range(3):
                slope = sign * (turned[axis][k] - now[k]) / NUDGE_RAD
                rows[count, v + axis] = slope
                rate += slope * qvel[v + axis]
            creep = CREEP_RADPS * min(max(1.0 + room / CREEP_RAD, 0.0), 1.0)
            least[count] = -max(room, 0.0) / ease_s - limp * creep
            broken |= rate < least[count] + NEAR_RADPS
            count += 1
    if broken:
        return count
    rows[first:count, v : v + 3] = 0.0
    return first
