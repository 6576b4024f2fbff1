"""Two bones and a hinge in closed form: a limb is opened, swung onto its target and turned, starting from how it is.

After Tolani, Goswami and Badler 2000, Real-time inverse kinematics techniques for anthropomorphic limbs (Graphical
Models 62), sections 3 and 4: the elbow's angle by the cosine law, the limb's direction, the swivel angle about the line
from root to target. Their solution builds a limb anew; this one corrects the limb that is there, so that a target and a
swivel that ask for nothing give exactly nothing, even where a clip's elbow or knee is no perfect hinge, and a blend
begins and ends on the clip's own pose.

Words: root, mid, end = shoulder, elbow, wrist or hip, knee, ankle. Hinge = world axis about which positive angles flex
the mid joint. Swivel = where the mid joint points about the line root to end: 0 along a reference direction, positive
away from the body on both sides (left towards +Y, right towards -Y for a limb that points forward and a reference that
points down).
"""

from __future__ import annotations

import math

from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

SOFT_REACH_M = 0.01  # spec A4: reach saturates over 1 cm
STRAIGHT_NOISE_RAD = 5e-8  # what the last bit of a straight limb's length makes of its angle
KEEP = math.nan  # as swivel: leave the mid joint where the least swing leaves it


@inner_kernel
def hinge_of(root, mid, end, joint_axis):
    """The unit axis about which the limb bends now, as flexion is positive; world.

    Bent, it is the normal of the limb's own plane; straight, where there is no such plane (or bent the wrong way), it
    is the joint's own axis; in between they are blended, over the first 20 degrees of flexion.
    """
    u, v = vector.subtract(mid, root), vector.subtract(end, mid)
    normal = vector.cross(u, v)
    sine = vector.inner(normal, joint_axis) / max(vector.length(u) * vector.length(v), 1e-12)
    t = min(max(sine / 0.35, 0.0), 1.0)
    return vector.unit(vector.mix(joint_axis, vector.unit(normal, joint_axis), t * t * (3.0 - 2.0 * t)), joint_axis)


@inner_kernel
def swivel_of(root, mid, end, joint_axis, zero, sign):
    """The swivel angle, radians in [-pi, pi]: from the direction `zero` (any length, projected) to the mid joint.

    sign +1 left, -1 right. The mid joint's direction is taken from the hinge, so that a straight limb has one too.
    """
    n = vector.unit(vector.subtract(end, root), vector.subtract(mid, root))
    pointing = vector.cross(n, hinge_of(root, mid, end, joint_axis))
    around, along = vector.cross(zero, pointing), vector.reject(zero, n)
    return sign * math.atan2(vector.inner(n, around), vector.inner(along, pointing))


@inner_kernel
def carried_zero(resting, resting_zero, n):
    """The reference direction for a limb along unit n, carried there from its resting direction by the least rotation.

    A fixed reference (down, forward) turns over wherever the limb passes along it. Carried along, the reference is
    smooth for every direction but the one opposite to `resting`. Unit vectors; returns a unit vector at right angles to
    n.
    """
    return quaternion.rotate(quaternion.between(resting, n), resting_zero)


@njit(cache=True)
def soft_reach(wanted_m, present_m, full_m, soft_m):
    """How far the limb stretches when a distance is wanted: never beyond its full length, and getting there smoothly.

    Up to soft_m short of the full length it is the wanted distance. Then one cubic, from there with slope 1, through
    the limb's present length (so that an almost straight limb that is asked for nothing stays exactly as it is), up to
    the full length with slope 0. It overshoots by 0.15 soft_m at most, and only for a limb that is straight already.
    """
    start = full_m - soft_m
    if soft_m <= 0.0 or wanted_m <= start:
        return min(wanted_m, full_m)
    x = min(max(present_m - start, 0.0), soft_m)
    # the width for which the cubic passes through (x, x): 2 W^2 - W (3 s + x) + 2 x s = 0
    width = 0.25 * (3.0 * soft_m + x + math.sqrt(max((soft_m - x) * (9.0 * soft_m - x), 0.0)))
    t = (wanted_m - start) / width
    if t >= 1.0:
        return full_m
    return start + width * t * (1.0 - t) * (1.0 - t) + soft_m * t * t * (3.0 - 2.0 * t)


@inner_kernel
def _flexion_towards(wanted_rad, present_rad):
    """The flexion to take for one wanted in [0, pi]: never backwards, but for a clip's own overstretched joint.

    A joint that is overstretched by p now keeps -p when the limb is to stay as long as it is, -> 0 when it is to be
    longer, and goes over into flexing forwards as it is to be shorter; the millimetre that costs is in the limb's miss.
    """
    p = -present_rad
    if p <= 0.0:
        return wanted_rad
    if wanted_rad <= p:
        return -wanted_rad
    t = min((wanted_rad - p) / (2.0 * p), 1.0)
    return wanted_rad - 2.0 * p * (1.0 - t * t * (3.0 - 2.0 * t))


@inner_kernel
def _bend(u, v, hinge, target_m, greatest_rad, soft_m):
    """The angle to turn v about the hinge by, so that |u + v| becomes the target distance (cosine law, any hinge)."""
    present_m = vector.length(vector.add(u, v))
    u_along, v_along = vector.inner(u, hinge), vector.inner(v, hinge)
    across = vector.length(vector.reject(u, hinge)) * vector.length(vector.reject(v, hinge))
    if across < 1e-12:
        return 0.0
    fixed = vector.inner(u, u) + vector.inner(v, v) + 2.0 * u_along * v_along
    full_m = math.sqrt(fixed + 2.0 * across)
    reach_m = soft_reach(target_m, present_m, full_m, soft_m)
    if abs(reach_m - present_m) < 1e-13:
        return 0.0
    present = math.atan2(vector.inner(hinge, vector.cross(u, v)), vector.inner(u, v) - u_along * v_along)
    half_sine = math.sqrt(min(max((full_m - reach_m) * (full_m + reach_m) / (4.0 * across), 0.0), 1.0))
    wanted = min(2.0 * math.asin(half_sine), max(greatest_rad, present))
    bend = _flexion_towards(wanted, present) - present
    return 0.0 if abs(bend) < STRAIGHT_NOISE_RAD else bend


@inner_kernel
def solve_limb(root, mid, end, joint_axis, target, zero, swivel_rad, sign, greatest_rad, soft_m):
    """Puts the limb's end on a target and its mid joint at a swivel. World, metres, radians.

    joint_axis: the mid joint's own unit axis of positive flexion; zero, swivel_rad, sign: see swivel_of (nan leaves the
    swivel alone); greatest_rad: the most that the mid joint flexes (a limb that is bent further already may stay so).
    Returns (turn of the whole limb about its root, turn of the lower part about the mid joint *before* that one: world
    quaternions; how far the end misses the target, metres).
    """
    u, v, towards = vector.subtract(mid, root), vector.subtract(end, mid), vector.subtract(target, root)
    hinge = hinge_of(root, mid, end, joint_axis)
    lower = quaternion.from_axis_angle(hinge, _bend(u, v, hinge, vector.length(towards), greatest_rad, soft_m))
    v = quaternion.rotate(lower, v)
    chord = vector.add(u, v)
    along = vector.unit(chord, u)
    n = vector.unit(towards, along)
    limb = quaternion.between(along, n)
    if not math.isnan(swivel_rad):
        new_mid = quaternion.rotate(limb, u)
        new_end = quaternion.rotate(limb, chord)
        axis = quaternion.rotate(limb, joint_axis)
        present = swivel_of((0.0, 0.0, 0.0), new_mid, new_end, axis, zero, sign)
        limb = quaternion.multiply(quaternion.from_axis_angle(n, sign * (swivel_rad - present)), limb)
    return limb, lower, vector.distance(quaternion.rotate(limb, chord), towards)
