"""The arms (section 5.3): elbow angle in closed form, then a turn about the line from shoulder to target; or hanging
by parameters.
"""

from __future__ import annotations

import math

from engine.body import limb_ik, limits, two_bones
from engine.body.skeleton import CLAVICLES, ELBOWS, SHOULDERS, WRISTS
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

# slots of an arm's parameters, radians; zeros are the neutral arm
OUT, FORWARD, ELBOW, TURN, PALM, SWIVEL = range(6)

# the neutral arm: a little away from the thigh, the elbow soft, the palm turned a little back
NEUTRAL_OUT, NEUTRAL_FORWARD, NEUTRAL_ELBOW, NEUTRAL_PALM = (math.radians(a) for a in (10.0, 2.0, 16.0, 12.0))
# by default the elbow points this far out from straight down and back when it reaches
NEUTRAL_SWIVEL = math.radians(20.0)
# how far an arm that hangs follows gravity (1) rather than the chest (0)
HANG = 0.85
SOFT_LEAN = 0.1  # radians of sideways lean over which the flank takes an arm up ...
MOST_LEAN = 0.45  # ... and about how far it carries it; from there on the arm drops past it


@inner_kernel
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
    quaternion.put(rotations, s, limits.clamp_rotation(body.limit_low_rad[s], body.limit_high_rad[s], shoulder))
    bend = quaternion.about_y(-min(max(arm[ELBOW] + NEUTRAL_ELBOW, 0.0), -body.limit_low_rad[e, 1]))
    palm = min(max(arm[PALM] + NEUTRAL_PALM, body.limit_low_rad[e, 2]), body.limit_high_rad[e, 2])
    quaternion.put(rotations, e, quaternion.multiply(bend, quaternion.about_z(-out * palm)))
    quaternion.put(rotations, WRISTS[side], quaternion.IDENTITY)


@inner_kernel
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


@inner_kernel
def ready_arm(side, rotations):
    """An arm that is about to reach: at the side, the elbow at a right angle. Where it starts from decides nothing
    but its palm.
    """
    quaternion.put(rotations, SHOULDERS[side], quaternion.IDENTITY)
    quaternion.put(rotations, ELBOWS[side], quaternion.about_y(-0.5 * math.pi))
    quaternion.put(rotations, WRISTS[side], quaternion.IDENTITY)


@njit(cache=True)
def arm_length_m(body, side):
    """Shoulder to wrist of the straight arm."""
    return -(body.offset_m[ELBOWS[side], 2] + body.offset_m[WRISTS[side], 2])


@njit(cache=True)
def reach(body, rotations, positions, orientations, side, target_m, swivel_rad):
    """Puts a wrist on a world target, elbow at a swivel, in place (arrays of one pose). Returns how far it misses,
    metres.
    """
    root = vector.at(positions, SHOULDERS[side])
    along = vector.unit(vector.subtract((target_m[0], target_m[1], target_m[2]), root), (0.0, 0.0, -1.0))
    swivel = swivel_rad + _zero_from_carried(orientations, side, along)
    return limb_ik.apply_arm(body, rotations, positions, orientations, side, target_m, swivel, limb_ik.CARRIED, 0.0)


@njit(cache=True)
def elbow_zero(orientations, side, along):
    """Where the elbow points at swivel 0 for an arm along a unit vector; world.

    Down for an arm straight ahead, carried to other arms by the least turn. It turns over only for an arm straight
    back, which no shoulder allows. (`limb_ik.CARRIED` does behind and above the shoulder, which is where a target comes
    to be when somebody leans and turns away from it.)
    """
    clavicle = quaternion.at(orientations, CLAVICLES[side])
    ahead, down = quaternion.rotate(clavicle, (1.0, 0.0, 0.0)), quaternion.rotate(clavicle, (0.0, 0.0, -1.0))
    return two_bones.carried_zero(ahead, down, along)


@inner_kernel
def _zero_from_carried(orientations, side, along):
    """The swivel, counted from `limb_ik.CARRIED`, at which the elbow points along `elbow_zero`."""
    carried = limb_ik.arm_zero(orientations, side, limb_ik.CARRIED, along)
    zero = elbow_zero(orientations, side, along)
    turn = math.atan2(vector.inner(along, vector.cross(carried, zero)), vector.inner(carried, zero))
    return (1.0 - 2.0 * side) * turn
