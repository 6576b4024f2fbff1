"""Arms pushed out of the body: what is deeper in head, trunk or the other arm than it is allowed to be comes out of
it, by the least turn of shoulders and elbows.

A push is a smooth function of the pose that it is given, nothing is remembered: it begins unnoticeably where an arm
first is deeper than allowed and grows with the cube of what is left, so an arm that is taken through the body slides
along it. Least squares (Levenberg 1944, Marquardt 1963) over four turns an arm, limits of joints among what is dear.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.blends.arm_ways import BEYOND_RAD, SWUNG, overstep, place_arm, within_limits
from behaviours.blends.hand_ways import APART_M
from behaviours.blends.swung_ways import put_capsules
from engine.body.kinematics import joints_into
from engine.body.overlap import ARM_CAPSULES, PAIRS, depths_at, segment
from engine.body.skeleton import CLAVICLES, ELBOWS, JOINT_COUNT, SHOULDERS, WRISTS
from engine.maths import quaternion, vector
from engine.maths.copying import copy_into
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.maths.least_squares import bounded_step, normal_equations
from engine.maths.shapes import boxes_apart, nearest_between
from engine.maths.springs import decaying

TURNS = 4  # of an arm: its shoulder's, a rotation vector in the world, and its elbow's flexion
VARIABLES = 2 * TURNS
LIMIT_ROW, DEPTH_ROW = VARIABLES, VARIABLES + 12  # rows of the residuals: turns, limits, depths
ROWS = DEPTH_ROW + len(PAIRS)
TRIES, FIRST_DAMPING = 14, 0.01
MOST_STEP_RAD, NUDGE_RAD = 0.2, 1e-6
DEPTH_M = 0.003  # what is left of a push that turns an arm by TURN_RAD: so far in the body, or beyond what is allowed
TURN_RAD = 0.25
LEVER_M = 0.2  # of a usual push: from the shoulder to where a forearm touches
LINE_APART_M = 0.002  # skins of an arm that has a line to keep to keep no farther off


@njit(cache=True)
def push_arms_out(body, capsules, allowed_m, root_m, rotations):
    """Takes both arms out of the body, as far as they are deeper in it than allowed (P,) for each of `overlap.PAIRS`,
    metres. In place: rotations (J, 4). Returns how far that moves the hands, left and right.
    """
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    ends_m = np.empty((1, len(ARM_CAPSULES), 2, 3))
    put_capsules(capsules, -1, positions, orientations, ends_m, 0)
    residuals, slopes = np.zeros(ROWS), np.zeros((ROWS, VARIABLES))
    if depth_trouble(capsules, allowed_m, positions, orientations, ends_m, residuals, slopes) == 0.0:
        return 0.0, 0.0
    wrists = (vector.at(positions, WRISTS[0]), vector.at(positions, WRISTS[1]))
    was, turns = rotations.copy(), np.zeros(VARIABLES)
    least_turns(body, capsules, allowed_m, was, turns, rotations, positions, orientations, ends_m, residuals, slopes)
    for side in range(2):
        turn_arm(body, side, turns, was, rotations, positions, orientations)
        for joint in (SHOULDERS[side], ELBOWS[side]):
            q = within_limits(body, joint, was[joint], was[joint], 0.0, rotations[joint], BEYOND_RAD)[0]
            quaternion.put(rotations, joint, q)
        place_arm(body, side, rotations, positions, orientations)
    return (
        vector.distance(wrists[0], vector.at(positions, WRISTS[0])),
        vector.distance(wrists[1], vector.at(positions, WRISTS[1])),
    )


@inner_kernel
def least_turns(body, capsules, allowed_m, was, turns, rotations, positions, orientations, ends_m, residuals, slopes):
    """Levenberg and Marquardt's descent to the turns (8,) that leave the least trouble, in place."""
    trial, step = np.empty(VARIABLES), np.empty(VARIABLES)
    trial_residuals, trial_slopes = np.zeros(ROWS), np.zeros((ROWS, VARIABLES))
    matrix, slope = np.empty((VARIABLES, VARIABLES)), np.empty(VARIABLES)
    low, high = np.full(VARIABLES, -np.inf), np.full(VARIABLES, np.inf)
    value = trouble(
        body, capsules, allowed_m, was, turns, rotations, positions, orientations, ends_m, residuals, slopes
    )
    damping = 0.0
    normal_equations(slopes, residuals, matrix, slope)
    for _ in range(TRIES):
        bounded_step(matrix, slope, turns, low, high, damping, step)
        for k in range(VARIABLES):
            trial[k] = turns[k] + min(max(step[k], -MOST_STEP_RAD), MOST_STEP_RAD)
        left = trouble(
            body, capsules, allowed_m, was, trial, rotations, positions, orientations, ends_m, trial_residuals,
            trial_slopes,
        )  # fmt: skip
        if left < value:
            value, damping = left, 0.1 * damping
            copy_into(turns, trial)
            copy_into(residuals, trial_residuals)
            normal_equations(trial_slopes, residuals, matrix, slope)
        else:
            damping = max(10.0 * damping, FIRST_DAMPING)


@inner_kernel
def trouble(body, capsules, allowed_m, was, turns, rotations, positions, orientations, ends_m, residuals, slopes):
    """Both arms turned from how they were, and all that is wrong with that: writes (ROWS,) and (ROWS, 8), returns the
    sum of squares.
    """
    for side in range(2):
        turn_arm(body, side, turns, was, rotations, positions, orientations)
        put_capsules(capsules, side, positions, orientations, ends_m, 0)
    total = depth_trouble(capsules, allowed_m, positions, orientations, ends_m, residuals, slopes)
    for side in range(2):
        for part in range(2):
            total += limit_trouble(body, side, part, was, rotations, orientations, residuals, slopes)
    for k in range(VARIABLES):
        residuals[k], slopes[k, k] = turns[k], 1.0
        total += turns[k] * turns[k]
    return total


@njit(cache=True)
def let_lines_be(modes, allowed_m):
    """Allows an arm that has a line to keep to to come as near as LINE_APART_M, in place: (P,) depths, metres.

    modes: (2,) of `behaviours.blends.arm_ways`.
    """
    for n in range(len(PAIRS)):
        for c in (PAIRS[n, 0], PAIRS[n, 1]):
            side = ARM_CAPSULES[c, 0]
            if side >= 0 and modes[side] != SWUNG:
                allowed_m[n] = max(allowed_m[n], -LINE_APART_M)


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
    push_arms_out(body, capsules, allowed_m, root_m, rotations)


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
def depth_trouble(capsules, allowed_m, positions, orientations, ends_m, residuals, slopes):
    """The rows of both that are about depth; returns their sum of squares."""
    total = 0.0
    for n in range(len(PAIRS)):
        row = DEPTH_ROW + n
        residuals[row] = 0.0
        for k in range(VARIABLES):
            slopes[row, k] = 0.0
        a, b = PAIRS[n, 0], PAIRS[n, 1]
        one, other = segment(ends_m, 0, a), segment(ends_m, 0, b)
        touch_m = capsules.radius_m[a] + capsules.radius_m[b] - allowed_m[n]
        if boxes_apart(one[0], one[1], other[0], other[1], touch_m):
            continue
        s, t = nearest_between(one[0], one[1], other[0], other[1])
        p, q = vector.mix(one[0], one[1], s), vector.mix(other[0], other[1], t)
        over = capsules.radius_m[a] + capsules.radius_m[b] - vector.distance(p, q) - allowed_m[n]
        if over <= 0.0:
            continue
        residuals[row], rises = dear(over, DEPTH_M + max(0.0, -allowed_m[n]), 1.0 / LEVER_M)
        total += residuals[row] * residuals[row]
        out = vector.unit(vector.subtract(p, q), (0.0, 0.0, 1.0))
        press(a, p, vector.scale(out, -rises), positions, orientations, slopes[row])
        press(b, q, vector.scale(out, rises), positions, orientations, slopes[row])
    return total


@inner_kernel
def dear(over, room, radians_per):
    """How dear it is to be over something, and how that grows: of the sum of both squares, that and a turn of TURN_RAD
    that takes it away, the least is where `over` is the room. radians_per: how large a turn takes away one of it.
    """
    scale = math.sqrt(0.5 * TURN_RAD * radians_per * room)
    return scale * (over / room) ** 2, 2.0 * scale * over / room**2


@inner_kernel
def press(capsule, place_m, along, positions, orientations, slopes):
    """Adds what each turn of the arm that a capsule belongs to, if any, moves a place of it `along` a direction,
    world.
    """
    side = ARM_CAPSULES[capsule, 0]
    if side < 0:
        return
    shoulder, elbow = SHOULDERS[side], ELBOWS[side]
    turning = vector.cross(vector.subtract(place_m, vector.at(positions, shoulder)), along)
    for k in range(3):
        slopes[side * TURNS + k] += turning[k]
    hinge = quaternion.rotate(quaternion.at(orientations, shoulder), (0.0, -1.0, 0.0))
    arm = vector.subtract(place_m, vector.at(positions, elbow))
    slopes[side * TURNS + 3] += vector.inner(vector.cross(hinge, arm), along)


@inner_kernel
def limit_trouble(body, side, part, was, rotations, orientations, residuals, slopes):
    """The rows of both that are about the limits of a shoulder (part 0) or an elbow (1), which the pose that is pushed
    (J, 4) may overstep; returns their sum of squares.
    """
    joint, first, total = SHOULDERS[side] if part == 0 else ELBOWS[side], LIMIT_ROW + 6 * side + 3 * part, 0.0
    q = quaternion.at(rotations, joint)
    beyond, _ = overstep(body, joint, was[joint], was[joint], 0.0, q)
    for axis in range(3):
        residuals[first + axis] = 0.0
        for k in range(VARIABLES):
            slopes[first + axis, k] = 0.0
    if beyond[0] == 0.0 and beyond[1] == 0.0 and beyond[2] == 0.0:
        return 0.0
    above = quaternion.at(orientations, CLAVICLES[side])
    for turn in range(3 if part == 0 else 1):
        # shoulders turn about the world's axes, elbows about -Y of the upper arm
        about, column = (0.0, -1.0, 0.0), side * TURNS + 3
        if part == 0:
            world = (1.0 if turn == 0 else 0.0, 1.0 if turn == 1 else 0.0, 1.0 if turn == 2 else 0.0)
            about, column = quaternion.unrotate(above, world), side * TURNS + turn
        nudged = quaternion.multiply(quaternion.from_rotation_vector(vector.scale(about, NUDGE_RAD)), q)
        grown, _ = overstep(body, joint, was[joint], was[joint], 0.0, nudged)
        for k in range(3):
            rises = math.copysign(dear(abs(beyond[k]), BEYOND_RAD, 1.0)[1], beyond[k])
            slopes[first + k, column] = rises * (grown[k] - beyond[k]) / NUDGE_RAD
    for k in range(3):
        residuals[first + k] = dear(abs(beyond[k]), BEYOND_RAD, 1.0)[0]
        total += residuals[first + k] * residuals[first + k]
    return total


@inner_kernel
def turn_arm(body, side, turns, was, rotations, positions, orientations):
    """One arm turned from how it was (J, 4), and what hangs on it carried along. In place."""
    shoulder, elbow, k = SHOULDERS[side], ELBOWS[side], side * TURNS
    above = quaternion.at(orientations, CLAVICLES[side])
    turn = quaternion.unrotate(above, (turns[k], turns[k + 1], turns[k + 2]))
    turned = quaternion.multiply(quaternion.from_rotation_vector(turn), quaternion.at(was, shoulder))
    quaternion.put(rotations, shoulder, quaternion.normalise(turned))
    bent = quaternion.multiply(quaternion.about_y(-turns[k + 3]), quaternion.at(was, elbow))
    quaternion.put(rotations, elbow, quaternion.normalise(bent))
    place_arm(body, side, rotations, positions, orientations)
