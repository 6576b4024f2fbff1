"""How a movement that a blow cuts short still arrives: as a movement does, not as if a brake were pulled.

When the ball comes the body is still on its way into the sustained pose. What it has beyond that pose then, in place
and velocity, is kept, and the servos follow it as it dies away, like what is left at any seam
(`behaviours.settle.inertialise`). So muscles damp what the blow adds, not the movement that they make themselves. It
swings a little beyond the pose, less where a joint has less room before its limit, and not at all with an arm, or a
foot that is about to come down.
"""

from __future__ import annotations

import math

from behaviours.components import Character, Feet, FootMode, Phase, Ragdoll, Reaction, Sustained
from behaviours.playing import body_of
from behaviours.settle.inertialise import remaining, turn_from, turned_by
from behaviours.settle.seams import MOMENT
from behaviours.timing import TICK_S
from engine.body.limits import clamp_keeping, components
from engine.body.skeleton import ANKLES, CLAVICLES, ELBOWS, HIPS, JOINT_COUNT, KNEES, SHOULDERS, WRISTS, Pose
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit
from engine.physics import ragdoll

UNDER_WAY = (Phase.RESPOND, Phase.RECOVER_BLEND)
SOONEST_S = 0.01  # half-life: so near to a limit that the movement is as good as given up
LAG_S = 0.02  # how far the body is behind what its servos pull towards
HALVINGS = 12


def begin_arriving(world, row: int, tick: int) -> None:
    """At the blow, when the physics' state is set: what the body has beyond the sustained pose."""
    doll, s = world[Ragdoll], world[Sustained]
    model = world.assets.models[int(world[Character].body[row])]
    now, ahead = (ragdoll.carried_on(model, doll.state[row], m * TICK_S) for m in (0.0, MOMENT))
    most_s = world.assets.settings.response.arrives_half_life_s
    stands = world[Feet].mode[row] == FootMode.HELD
    measure(
        model.body, s.rotations[row], now.rotations, ahead.rotations, MOMENT * TICK_S, most_s, stands,
        doll.arriving[row], doll.half_life_s[row],
    )  # fmt: skip
    doll.taken[row] = tick


def arriving(world, row: int, tick: int, held: Pose) -> Pose:
    """The held pose with what is left of that at a tick."""
    doll = world[Ragdoll]
    out = Pose(held.root_m.copy(), held.rotations.copy())
    if world[Reaction].phase[row] in UNDER_WAY:
        body, elapsed_s = body_of(world, row), float(tick - doll.taken[row]) * TICK_S
        add(body, doll.arriving[row], doll.half_life_s[row], elapsed_s, out.rotations)
    return out


@njit(cache=True)
def measure(body, held, now, ahead, dt_s, most_s, stands, arriving, half_life_s):
    """Fills in turns and velocities (2, J, 3) beyond held rotations (J, 4), of ones that go from now to ahead in dt_s,
    and half-lives (J,), `most_s` or what the limits ask for. Arms, and legs whose foot does not stand (2,), go no
    farther than their pose: beyond it is the own body, or the floor.
    """
    for j in range(JOINT_COUNT):
        no_farther = False
        for side in range(2):
            no_farther |= j in (CLAVICLES[side], SHOULDERS[side], ELBOWS[side], WRISTS[side])
            no_farther |= not stands[side] and j in (HIPS[side], KNEES[side], ANKLES[side])
        turn, later = turn_from(held[j], now[j]), turn_from(held[j], ahead[j])
        a, b, c = components(held[j]), components(now[j]), components(ahead[j])
        half_life_s[j] = most_s
        for k in range(3):
            arriving[0, j, k], arriving[1, j, k] = turn[k], (later[k] - turn[k]) / dt_s
            sign = 1.0 if c[k] >= b[k] else -1.0
            room = body.limit_high_rad[j, k] - a[k] if sign > 0.0 else a[k] - body.limit_low_rad[j, k]
            if j > 0:
                rate = abs(c[k] - b[k]) / dt_s
                own_s = half_life_within(
                    sign * (b[k] - a[k]) + rate * LAG_S, rate, 0.0 if no_farther else max(room, 0.0), most_s
                )
                half_life_s[j] = min(half_life_s[j], own_s)


@njit(cache=True)
def half_life_within(offset, velocity, room, most_s):
    """The longest half-life, at most most_s, with which an offset let go with a velocity (positive) goes no farther
    than its room beyond zero, or than it is; SOONEST_S where none does.
    """
    farthest = max(room, offset)
    low, high = SOONEST_S, most_s
    if low >= high or swing(offset, velocity, high) <= farthest:
        return high
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if swing(offset, velocity, middle) <= farthest:
            low = middle
        else:
            high = middle
    return low


@inner_kernel
def swing(offset, velocity, half_life_s):
    """The farthest that a critically damped offset let go with a velocity (positive) gets: (x + B t) exp(-y t), where
    B = v + y x, is greatest at t = v / (y B)."""
    y = 2.0 * math.log(2.0) / half_life_s
    b = velocity + y * offset
    return (offset + velocity / y) * math.exp(-velocity / b) if b > 0.0 else 0.0


@njit(cache=True)
def add(body, arriving, half_life_s, elapsed_s, rotations):
    """Adds what is left after a time to held rotations (J, 4), within limits or as far out as those are. In place."""
    for j in range(1, JOINT_COUNT):
        left = remaining(vector.at(arriving[0], j), vector.at(arriving[1], j), elapsed_s, half_life_s[j])
        q = turned_by(quaternion.at(rotations, j), left)
        q = clamp_keeping(body.limit_low_rad[j], body.limit_high_rad[j], rotations[j], q)
        quaternion.put(rotations, j, q)
