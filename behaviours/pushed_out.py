"""Arms pushed out of the body: what is deeper in head, trunk or the other arm than it is allowed to be comes out of
it, by the least turn of shoulders and elbows.

A push is a smooth function of the pose that it is given, nothing is remembered: it begins unnoticeably where an arm
first is deeper than allowed and grows with the cube of what is left, so an arm that is taken through the body slides
along it. Least squares (Gauss and Newton) over four turns an arm, always as many steps, so that nothing jumps.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from behaviours.arm_ways import BEYOND_RAD, place_arm, within_limits
from behaviours.hand_ways import APART_M
from behaviours.least_squares import bounded_step, normal_equations
from behaviours.overlap import ARM_CAPSULES, PAIRS, depths_at, segment
from behaviours.swung_ways import put_capsules
from engine.body.kinematics import joints_into
from engine.body.skeleton import CLAVICLES, ELBOWS, JOINT_COUNT, SHOULDERS
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.shapes import nearest_between
from engine.maths.springs import decaying

TURNS = 4  # of an arm: its shoulder's, a rotation vector in the world, and its elbow's flexion
VARIABLES = 2 * TURNS
STEPS = 8
MOST_STEP_RAD = 0.2
DEPTH_M = 0.003  # what is left of a push that turns an arm by TURN_RAD: so far in the body, or beyond what is allowed
TURN_RAD = 0.25
LEVER_M = 0.2  # of a usual push: from the shoulder to where a forearm touches


@njit(cache=True)
def push_arms_out(body, capsules, allowed_m, free, root_m, rotations):
    """Takes both arms, or whichever is free (2,), out of the body, as far as they are deeper in it than allowed (P,)
    for each of `overlap.PAIRS`, metres. In place: rotations (J, 4). Returns whether that changed anything.
    """
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    ends_m = np.empty((1, len(ARM_CAPSULES), 2, 3))
    put_capsules(capsules, -1, positions, orientations, ends_m, 0)
    residuals, jacobian = np.zeros(VARIABLES + len(PAIRS)), np.zeros((VARIABLES + len(PAIRS), VARIABLES))
    turns, step = np.zeros(VARIABLES), np.empty(VARIABLES)
    matrix, slope = np.empty((VARIABLES, VARIABLES)), np.empty(VARIABLES)
    low, high = np.full(VARIABLES, -np.inf), np.full(VARIABLES, np.inf)
    if not too_deep_into(capsules, allowed_m, free, positions, orientations, ends_m, residuals, jacobian):
        return False
    was = rotations.copy()
    for _ in range(STEPS):
        for k in range(VARIABLES):
            residuals[k], jacobian[k, k] = turns[k], 1.0
        normal_equations(jacobian, residuals, matrix, slope)
        bounded_step(matrix, slope, turns, low, high, 0.0, step)
        shorten(step)
        for k in range(VARIABLES):
            turns[k] += step[k]
        for side in range(2):
            if free[side]:
                turn_arm(body, side, step, rotations, positions, orientations)
                put_capsules(capsules, side, positions, orientations, ends_m, 0)
        too_deep_into(capsules, allowed_m, free, positions, orientations, ends_m, residuals, jacobian)
    for side in range(2):
        for joint in (SHOULDERS[side], ELBOWS[side]):
            q = within_limits(body, joint, was[joint], was[joint], 0.0, rotations[joint], BEYOND_RAD)[0]
            quaternion.put(rotations, joint, q)
    return True


@njit(cache=True)
def keep_arms_out(body, capsules, source, deeper_m, elapsed_s, half_life_s, root_m, rotations):
    """Keeps what is left of a seam (in a pose (3,), (J, 4)) from taking arms into the body. In place.

    Let be is what the source's rotations (J, 4) have, and `deeper_m` (P,), what the old motion had beyond that at the
    seam, as it dies away.
    """
    allowed_m = np.empty(len(PAIRS))
    depths_of(body, capsules, root_m, source, allowed_m)
    for n in range(len(PAIRS)):
        allowed_m[n] = max(allowed_m[n], -APART_M) + decaying(deeper_m[n], 0.0, half_life_s, elapsed_s)[0]
    push_arms_out(body, capsules, allowed_m, np.ones(2, np.bool_), root_m, rotations)


@njit(cache=True)
def deeper_into(body, capsules, source, shown, out):
    """By how much arms are deeper in the body as shown (J, 4) than the source's (J, 4) are, or may be. Writes (P,)."""
    root_m, own_m = np.zeros(3), np.empty(len(PAIRS))
    depths_of(body, capsules, root_m, source, own_m)
    depths_of(body, capsules, root_m, shown, out)
    for n in range(len(PAIRS)):
        out[n] = max(out[n] - max(own_m[n], -APART_M), 0.0)


@njit(cache=True)
def depths_of(body, capsules, root_m, rotations, out):
    """How deep each of `overlap.PAIRS` lies in each other in one pose, metres. Writes (P,)."""
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    depths_at(capsules, positions, orientations, out)


@inner_kernel
def too_deep_into(capsules, allowed_m, free, positions, orientations, ends_m, residuals, jacobian):
    """The rows of the residuals and slopes of both that are about depth, below those of the turns. Returns whether
    anything is too deep.
    """
    found = False
    for n in range(len(PAIRS)):
        row = VARIABLES + n
        residuals[row] = 0.0
        for k in range(VARIABLES):
            jacobian[row, k] = 0.0
        a, b = PAIRS[n, 0], PAIRS[n, 1]
        one, other = segment(ends_m, 0, a), segment(ends_m, 0, b)
        s, t = nearest_between(one[0], one[1], other[0], other[1])
        p, q = vector.mix(one[0], one[1], s), vector.mix(other[0], other[1], t)
        over = capsules.radius_m[a] + capsules.radius_m[b] - vector.distance(p, q) - allowed_m[n]
        if over <= 0.0:
            continue
        # over = room after a push of TURN_RAD at LEVER_M: two over, and over / room, whose square is what counts
        room = DEPTH_M + max(0.0, -allowed_m[n])
        dear = (0.5 * TURN_RAD * room / LEVER_M) ** 0.5
        residuals[row] = dear * (over / room) ** 2
        rises = 2.0 * dear * over / room**2
        out = vector.unit(vector.subtract(p, q), (0.0, 0.0, 1.0))
        found = press(a, p, vector.scale(out, -rises), free, positions, orientations, jacobian[row]) or found
        found = press(b, q, vector.scale(out, rises), free, positions, orientations, jacobian[row]) or found
    return found


@inner_kernel
def press(capsule, place_m, along, free, positions, orientations, slopes):
    """Adds what each turn of the arm that a capsule belongs to moves a place of it `along` a direction, world. Returns
    whether it can.
    """
    side = ARM_CAPSULES[capsule, 0]
    if side < 0 or not free[side]:
        return False
    shoulder, elbow = SHOULDERS[side], ELBOWS[side]
    turning = vector.cross(vector.subtract(place_m, vector.at(positions, shoulder)), along)
    for k in range(3):
        slopes[side * TURNS + k] += turning[k]
    hinge = quaternion.rotate(quaternion.at(orientations, shoulder), (0.0, -1.0, 0.0))
    arm = vector.subtract(place_m, vector.at(positions, elbow))
    slopes[side * TURNS + 3] += vector.inner(vector.cross(hinge, arm), along)
    return True


@inner_kernel
def shorten(step):
    """Draws a step in to MOST_STEP_RAD, in place."""
    longest = 0.0
    for k in range(VARIABLES):
        longest = max(longest, abs(step[k]))
    if longest > MOST_STEP_RAD:
        for k in range(VARIABLES):
            step[k] *= MOST_STEP_RAD / longest


@inner_kernel
def turn_arm(body, side, step, rotations, positions, orientations):
    """Turns one arm by its part of a step, and carries what hangs on it along. In place."""
    clavicle, shoulder, elbow = CLAVICLES[side], SHOULDERS[side], ELBOWS[side]
    k = side * TURNS
    turn = quaternion.from_rotation_vector((step[k], step[k + 1], step[k + 2]))
    upper = quaternion.multiply(turn, quaternion.at(orientations, shoulder))
    local = quaternion.multiply(quaternion.conjugate(quaternion.at(orientations, clavicle)), upper)
    quaternion.put(rotations, shoulder, quaternion.normalise(local))
    bent = quaternion.multiply(quaternion.about_y(-step[k + 3]), quaternion.at(rotations, elbow))
    quaternion.put(rotations, elbow, quaternion.normalise(bent))
    place_arm(body, side, rotations, positions, orientations)
