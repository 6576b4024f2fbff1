"""Arms and legs in closed form: a limb is opened, swung onto its target and turned about it, starting from how it is.

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

from numba import njit

from engine.body.skeleton import ANKLES, CLAVICLES, ELBOWS, HIPS, KNEES, PELVIS, SHOULDERS, TOES, WRISTS
from engine.maths import quaternion, vector

SOFT_REACH_M = 0.01  # spec A4: reach saturates over 1 cm
KEEP = math.nan  # as swivel: leave the mid joint where the least swing leaves it

# what an arm's swivel is measured from
DOWN, CARRIED = 0, 1


@njit(cache=True)
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


@njit(cache=True)
def swivel_of(root, mid, end, joint_axis, zero, sign):
    """The swivel angle, radians in [-pi, pi]: from the direction `zero` (any length, projected) to the mid joint.

    sign +1 left, -1 right. The mid joint's direction is taken from the hinge, so that a straight limb has one too.
    """
    n = vector.unit(vector.subtract(end, root), vector.subtract(mid, root))
    pointing = vector.cross(n, hinge_of(root, mid, end, joint_axis))
    around, along = vector.cross(zero, pointing), vector.reject(zero, n)
    return sign * math.atan2(vector.inner(n, around), vector.inner(along, pointing))


@njit(cache=True)
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
    t = min((wanted_m - start) / width, 1.0)
    return start + width * t * (1.0 - t) * (1.0 - t) + soft_m * t * t * (3.0 - 2.0 * t)


@njit(cache=True)
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


@njit(cache=True)
def _bend(u, v, hinge, target_m, greatest_rad, soft_m):
    """The angle to turn v about the hinge by, so that |u + v| becomes the target distance (cosine law, any hinge)."""
    present_m = vector.length(vector.add(u, v))
    u_along, v_along = vector.inner(u, hinge), vector.inner(v, hinge)
    across = vector.length(vector.reject(u, hinge)) * vector.length(vector.reject(v, hinge))
    if across < 1e-12:
        return 0.0
    fixed = vector.inner(u, u) + vector.inner(v, v) + 2.0 * u_along * v_along
    reach_m = soft_reach(target_m, present_m, math.sqrt(fixed + 2.0 * across), soft_m)
    if abs(reach_m - present_m) < 1e-13:
        return 0.0
    present = math.atan2(vector.inner(hinge, vector.cross(u, v)), vector.inner(u, v) - u_along * v_along)
    cosine = min(max((reach_m * reach_m - fixed) / (2.0 * across), -1.0), 1.0)
    wanted = min(math.acos(cosine), max(greatest_rad, present))
    return _flexion_towards(wanted, present) - present


@njit(cache=True)
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


@njit(cache=True)
def _put(rows, row, value):
    for k in range(len(value)):
        rows[row, k] = value[k]


@njit(cache=True)
def place_children(offset_m, rotations, positions, orientations, joint, child):
    """Forward kinematics of one joint from its parent: writes the child's position and orientation."""
    _put(positions, child, vector.add(positions[joint], quaternion.rotate(orientations[joint], offset_m[child])))
    _put(orientations, child, quaternion.multiply(orientations[joint], rotations[child]))


@njit(cache=True)
def turn_end_to(offset_m, rotations, positions, orientations, parent, joint, world_orientation, child):
    """Gives a wrist or ankle a world orientation: its local rotation, and the toe (child, or -1) that hangs on it."""
    _put(orientations, joint, quaternion.normalise(world_orientation))
    local = quaternion.multiply(quaternion.conjugate(orientations[parent]), orientations[joint])
    _put(rotations, joint, quaternion.normalise(local))
    if child >= 0:
        place_children(offset_m, rotations, positions, orientations, joint, child)


@njit(cache=True)
def _apply(offset_m, rotations, positions, orientations, parent, upper, middle, end, limb, lower):
    """Writes both turns back: local rotations of upper and middle joint, positions and orientations down to the end."""
    _turn_local(rotations, orientations, parent, upper, limb)
    _turn_local(rotations, orientations, upper, middle, lower)
    _put(orientations, upper, quaternion.normalise(quaternion.multiply(orientations[parent], rotations[upper])))
    place_children(offset_m, rotations, positions, orientations, upper, middle)
    place_children(offset_m, rotations, positions, orientations, middle, end)


@njit(cache=True)
def _turn_local(rotations, orientations, parent, joint, world_turn):
    """local = conj(P) T P * local: a world turn T about the joint, seen from its parent. No turn, no change."""
    seen = quaternion.multiply(
        quaternion.multiply(quaternion.conjugate(orientations[parent]), world_turn), orientations[parent]
    )
    _put(rotations, joint, quaternion.normalise(quaternion.multiply(seen, rotations[joint])))


@njit(cache=True)
def _point(rows, j):
    return (rows[j, 0], rows[j, 1], rows[j, 2])


@njit(cache=True)
def elbow_axis(orientations, side):
    """The elbow's world axis of flexion: -Y of the upper arm."""
    return quaternion.rotate(orientations[SHOULDERS[side]], (0.0, -1.0, 0.0))


@njit(cache=True)
def knee_axis(orientations, side):
    """The knee's world axis of flexion: +Y of the thigh."""
    return quaternion.rotate(orientations[HIPS[side]], (0.0, 1.0, 0.0))


@njit(cache=True)
def arm_zero(orientations, side, reference, n):
    """Where the elbow points at swivel 0 for an arm along unit n; world.

    DOWN (spec A3): -Z of the clavicle. Turns over when the arm swings through hanging or straight up: fit for poses.
    CARRIED: the same in the plane straight ahead (back for a hanging arm, down for one held forward, forward for one
    held up), carried elsewhere; it turns over only behind and above the shoulder, where no arm goes: fit for blends.
    """
    clavicle = orientations[CLAVICLES[side]]
    if reference == DOWN:
        return quaternion.rotate(clavicle, (0.0, 0.0, -1.0))
    h = math.sqrt(0.5)
    return carried_zero(quaternion.rotate(clavicle, (h, 0.0, -h)), quaternion.rotate(clavicle, (-h, 0.0, -h)), n)


@njit(cache=True)
def knee_zero(orientations, n):
    """Where the knee points at swivel 0 for a leg along unit n; world: the pelvis's forward axis, carried there.

    A fixed forward axis would turn over in a kick or a high knee, when the thigh comes to lie along it; the foot's own
    axis does when the heel comes up. Carried from straight down, it is forward for a standing or a spread leg, up for
    one held forward, down for one held back, and turns over only for a leg straight up.
    """
    pelvis = orientations[PELVIS]
    return carried_zero(quaternion.rotate(pelvis, (0.0, 0.0, -1.0)), quaternion.rotate(pelvis, (1.0, 0.0, 0.0)), n)


@njit(cache=True)
def side_sign(side):
    """+1 left, -1 right."""
    return 1.0 - 2.0 * side


@njit(cache=True)
def arm_swivel(positions, orientations, side, reference=DOWN):
    """The swivel of an arm as it is now, radians, positive away from the body."""
    root, end = _point(positions, SHOULDERS[side]), _point(positions, WRISTS[side])
    n = vector.unit(vector.subtract(end, root), (0.0, 0.0, -1.0))
    zero = arm_zero(orientations, side, reference, n)
    mid, axis = _point(positions, ELBOWS[side]), elbow_axis(orientations, side)
    return swivel_of(root, mid, end, axis, zero, side_sign(side))


@njit(cache=True)
def leg_swivel(positions, orientations, side):
    """The swivel of a leg as it is now, radians, positive away from the other leg."""
    root, mid, end = _point(positions, HIPS[side]), _point(positions, KNEES[side]), _point(positions, ANKLES[side])
    n = vector.unit(vector.subtract(end, root), (0.0, 0.0, -1.0))
    return swivel_of(root, mid, end, knee_axis(orientations, side), knee_zero(orientations, n), side_sign(side))


@njit(cache=True)
def apply_arm(
    body, rotations, positions, orientations, side, target_m, swivel_rad, reference=DOWN, soft_m=SOFT_REACH_M
):
    """Puts a wrist on a world target with the elbow at a swivel (KEEP: where the least swing leaves it).

    rotations (J, 4), positions (J, 3), orientations (J, 4) of one pose, consistent, are updated in place from the
    shoulder down; the hand stays as it is on the forearm. Returns how far the wrist misses, metres. soft_m 0: exact up
    to full length.
    """
    return arm_onto(
        body.offset_m, -body.limit_low_rad[ELBOWS[side], 1], rotations, positions, orientations, side,
        (target_m[0], target_m[1], target_m[2]), swivel_rad, reference, soft_m,
    )  # fmt: skip


@njit(cache=True)
def arm_onto(
    offset_m, greatest_rad, rotations, positions, orientations, side, target, swivel_rad, reference, soft_m
):
    """apply_arm for hot kernels that cannot hand a whole body on; greatest_rad is the most the elbow flexes."""
    shoulder, elbow, wrist = SHOULDERS[side], ELBOWS[side], WRISTS[side]
    root = _point(positions, shoulder)
    n = vector.unit(vector.subtract(target, root), (0.0, 0.0, -1.0))
    limb, lower, miss_m = solve_limb(
        root, _point(positions, elbow), _point(positions, wrist), elbow_axis(orientations, side), target,
        arm_zero(orientations, side, reference, n), swivel_rad, side_sign(side), greatest_rad, soft_m,
    )  # fmt: skip
    _apply(offset_m, rotations, positions, orientations, CLAVICLES[side], shoulder, elbow, wrist, limb, lower)
    return miss_m


@njit(cache=True)
def apply_leg(
    body, rotations, positions, orientations, side, target_m, foot_orientation, swivel_rad, soft_m=SOFT_REACH_M
):
    """Puts an ankle on a world target, the foot at a world orientation, the knee at a swivel (KEEP: moved least).

    Arrays as in apply_arm, updated in place from the hip down to the toe. Returns how far the ankle misses, metres.
    """
    return leg_onto(
        body.offset_m, body.limit_high_rad[KNEES[side], 1], rotations, positions, orientations, side,
        (target_m[0], target_m[1], target_m[2]), foot_orientation, swivel_rad, soft_m,
    )  # fmt: skip


@njit(cache=True)
def leg_onto(
    offset_m, greatest_rad, rotations, positions, orientations, side, target, foot_orientation, swivel_rad, soft_m
):
    """apply_leg for hot kernels, see arm_onto: greatest_rad is the most the knee flexes."""
    hip, knee, ankle = HIPS[side], KNEES[side], ANKLES[side]
    root = _point(positions, hip)
    foot = (foot_orientation[0], foot_orientation[1], foot_orientation[2], foot_orientation[3])
    n = vector.unit(vector.subtract(target, root), (0.0, 0.0, -1.0))
    limb, lower, miss_m = solve_limb(
        root, _point(positions, knee), _point(positions, ankle), knee_axis(orientations, side), target,
        knee_zero(orientations, n), swivel_rad, side_sign(side), greatest_rad, soft_m,
    )  # fmt: skip
    _apply(offset_m, rotations, positions, orientations, PELVIS, hip, knee, ankle, limb, lower)
    turn_end_to(offset_m, rotations, positions, orientations, knee, ankle, foot, TOES[side])
    return miss_m


@njit(cache=True)
def turn_hand_to(body, rotations, positions, orientations, side, world_orientation):
    """Gives a hand a world orientation, in place."""
    turn_end_to(body.offset_m, rotations, positions, orientations, ELBOWS[side], WRISTS[side], world_orientation, -1)
