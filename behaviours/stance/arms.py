"""The arms (section 5.3): elbow angle in closed form, then a turn about the line from shoulder to target; or hanging
by parameters.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from engine.body import limb_ik, limits
from engine.body.skeleton import ELBOWS, PARENT, SHOULDERS, WRISTS
from engine.maths import quaternion, vector

# slots of an arm's parameters, radians; zeros are the neutral arm
OUT, FORWARD, ELBOW, TURN, PALM, SWIVEL = range(6)
ARM_PARAMETERS = ("out", "forward", "elbow", "turn", "palm", "swivel")

# the neutral arm: a little away from the thigh, the elbow soft, the palm turned a little back
NEUTRAL_OUT, NEUTRAL_FORWARD, NEUTRAL_ELBOW, NEUTRAL_PALM = (math.radians(a) for a in (10.0, 2.0, 16.0, 12.0))
# by default the elbow points this far out from straight down and back when it reaches
NEUTRAL_SWIVEL = math.radians(20.0)
# how far an arm that hangs follows gravity (1) rather than the chest (0)
HANG = 0.85
SOFT_LEAN = 0.1  # radians of sideways lean over which the flank takes an arm up ...
MOST_LEAN = 0.45  # ... and about how far it carries it; from there on the arm drops past it
# how the nearest allowed swivel is looked for
SWIVEL_STEPS, SWIVEL_STEP = 20, math.radians(6.0)
SECTIONS, GOLDEN = 18, 0.5 * (math.sqrt(5.0) - 1.0)
ROUNDING_RAD = 1e-6  # a straight elbow's angle is known no better


@njit(cache=True)
def hang_arm(body, arm, side, rotations, chest, clavicle):
    """An arm without target: away from the body, forward, turned in, the elbow bent; written to rotations (J, 4).

    arm (6,): see the slots. chest, clavicle: world orientations.
    """
    out = 1.0 - 2.0 * side
    base = _hanging_from(chest, out)
    lift = quaternion.from_rotation_vector((out * (arm[OUT] + NEUTRAL_OUT), -(arm[FORWARD] + NEUTRAL_FORWARD), 0.0))
    upper = quaternion.multiply(base, quaternion.multiply(lift, quaternion.about_z(-out * arm[TURN])))
    shoulder = quaternion.multiply(quaternion.conjugate(clavicle), upper)
    s, e = SHOULDERS[side], ELBOWS[side]
    _put(rotations, s, limits.clamp_rotation(body.limit_low_rad[s], body.limit_high_rad[s], shoulder))
    bend = quaternion.about_y(-min(max(arm[ELBOW] + NEUTRAL_ELBOW, 0.0), -body.limit_low_rad[e, 1]))
    palm = min(max(arm[PALM] + NEUTRAL_PALM, body.limit_low_rad[e, 2]), body.limit_high_rad[e, 2])
    _put(rotations, e, quaternion.multiply(bend, quaternion.about_z(-out * palm)))
    _put(rotations, WRISTS[side], quaternion.IDENTITY)


@njit(cache=True)
def _hanging_from(chest, out):
    """The frame that an arm without target hangs in: it goes with the chest's heading and follows gravity for the
    rest.

    So a bent back lets the arms drop and does not carry them behind itself. Sideways gravity pulls only the arm that
    it pulls off the body; the other one lies against the flank and leans with it.
    """
    heading = quaternion.about_z(quaternion.heading(chest))
    up = quaternion.unrotate(heading, quaternion.rotate(chest, (0.0, 0.0, 1.0)))
    bow = math.atan2(up[0], up[2])
    lean = out * math.atan2(-up[1], math.hypot(up[0], up[2]))  # + away from this arm, over which it then lies
    onto_flank = 0.5 * (lean + math.sqrt(lean * lean + SOFT_LEAN * SOFT_LEAN)) - 0.5 * SOFT_LEAN
    onto_flank = MOST_LEAN * math.tanh(onto_flank / MOST_LEAN)
    kept = (1.0 - HANG) * lean + HANG * onto_flank
    tipped = quaternion.multiply(quaternion.about_y((1.0 - HANG) * bow), quaternion.about_x(out * kept))
    return quaternion.multiply(heading, tipped)


@njit(cache=True)
def ready_arm(side, rotations):
    """An arm that is about to reach: at the side, the elbow at a right angle. Where it starts from decides nothing
    but its palm.
    """
    _put(rotations, SHOULDERS[side], quaternion.IDENTITY)
    _put(rotations, ELBOWS[side], quaternion.about_y(-0.5 * math.pi))
    _put(rotations, WRISTS[side], quaternion.IDENTITY)


@njit(cache=True)
def arm_length_m(body, side):
    """Shoulder to wrist of the straight arm."""
    return -(body.offset_m[ELBOWS[side], 2] + body.offset_m[WRISTS[side], 2])


@njit(cache=True)
def reach(body, rotations, positions, orientations, side, target_m, swivel_rad):
    """Puts a wrist on a world target, elbow at a swivel, in place (arrays of one pose). Returns how far it misses,
    metres.
    """
    return limb_ik.apply_arm(body, rotations, positions, orientations, side, target_m, swivel_rad, limb_ik.CARRIED, 0.0)


@njit(cache=True)
def reach_within_limits(body, rotations, positions, orientations, side, target_m, swivel_rad):
    """`reach` at the allowed swivel that is nearest to the wanted one. Returns the miss, the swivel taken, and the
    strain.

    Where no swivel is allowed, the one that strains least is taken, the arm is held at its limits and the wrist goes
    no farther than that; the strain is what the limits are short of, radians, else 0.
    """
    reach(body, rotations, positions, orientations, side, target_m, swivel_rad)
    least, easiest = strain_rad(body, rotations, side), swivel_rad
    if least <= ROUNDING_RAD:
        return _hold_at_limits(body, rotations, positions, orientations, side, target_m), swivel_rad, 0.0
    for k in range(1, SWIVEL_STEPS + 1):
        for way in (1.0, -1.0):
            allowed = swivel_rad + way * k * SWIVEL_STEP
            reach(body, rotations, positions, orientations, side, target_m, allowed)
            strain = strain_rad(body, rotations, side)
            if strain <= ROUNDING_RAD:
                forbidden = allowed - way * SWIVEL_STEP
                allowed = _edge_of_allowed(body, rotations, positions, orientations, side, target_m, forbidden, allowed)
                return _hold_at_limits(body, rotations, positions, orientations, side, target_m), allowed, 0.0
            if strain < least:
                least, easiest = strain, allowed
    easiest = _easiest_near(body, rotations, positions, orientations, side, target_m, easiest)
    least = strain_rad(body, rotations, side)
    if least <= ROUNDING_RAD:
        least = 0.0
    return _hold_at_limits(body, rotations, positions, orientations, side, target_m), easiest, least


@njit(cache=True)
def _easiest_near(body, rotations, positions, orientations, side, target_m, swivel_rad):
    """The swivel of the least strain within a step of one; leaves the arm there. Golden sections."""
    low, high = swivel_rad - SWIVEL_STEP, swivel_rad + SWIVEL_STEP
    strains = np.empty(2)
    for _ in range(SECTIONS):
        tries = (high - GOLDEN * (high - low), low + GOLDEN * (high - low))
        for k in range(2):
            reach(body, rotations, positions, orientations, side, target_m, tries[k])
            strains[k] = strain_rad(body, rotations, side)
        if strains[0] <= strains[1]:
            high = tries[1]
        else:
            low = tries[0]
    middle = 0.5 * (low + high)
    reach(body, rotations, positions, orientations, side, target_m, middle)
    return middle


@njit(cache=True)
def _hold_at_limits(body, rotations, positions, orientations, side, target_m):
    """Draws shoulder and elbow back to their limits, in place; returns how far the wrist then is from the target."""
    for joint in (SHOULDERS[side], ELBOWS[side]):
        held = limits.clamp_rotation(body.limit_low_rad[joint], body.limit_high_rad[joint], rotations[joint])
        _put(rotations, joint, held)
        limb_ik.place_children(body.offset_m, rotations, positions, orientations, PARENT[joint], joint)
    limb_ik.place_children(body.offset_m, rotations, positions, orientations, ELBOWS[side], WRISTS[side])
    return vector.distance(positions[WRISTS[side]], target_m)


@njit(cache=True)
def _edge_of_allowed(body, rotations, positions, orientations, side, target_m, forbidden, allowed):
    """Halves the way between a forbidden and an allowed swivel until they are one, and takes the allowed one."""
    for _ in range(20):
        middle = 0.5 * (forbidden + allowed)
        reach(body, rotations, positions, orientations, side, target_m, middle)
        if strain_rad(body, rotations, side) <= ROUNDING_RAD:
            allowed = middle
        else:
            forbidden = middle
    reach(body, rotations, positions, orientations, side, target_m, allowed)
    return allowed


@njit(cache=True)
def strain_rad(body, rotations, side):
    """How far shoulder and elbow are beyond their limits: the root of the sum of the squares of what each angle is
    over.
    """
    total = 0.0
    for joint in (SHOULDERS[side], ELBOWS[side]):
        angle = limits.components(rotations[joint])
        for axis in range(3):
            low, high = body.limit_low_rad[joint, axis], body.limit_high_rad[joint, axis]
            over = max(low - angle[axis], angle[axis] - high, 0.0)
            total += over * over
    return math.sqrt(total)


@njit(cache=True)
def _put(rotations, joint, q):
    rotations[joint, 0], rotations[joint, 1], rotations[joint, 2], rotations[joint, 3] = q
