"""How long a blow is left to the physics, and whether it has knocked the character down (specification A8)."""

from __future__ import annotations

import math

import numpy as np

from behaviours.components import NOBODY, Blow, Character, Reaction, Struck
from behaviours.playing import body_of
from behaviours.settle.seams import shown
from behaviours.timing import TICK_S, whole_ticks
from engine.body import footing, support
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import PELVIS
from engine.maths import vector
from engine.maths.ballistics import GRAVITY_MPS2


def begin_reeling(world, row: int, com_mps) -> None:
    """At the first contact: how the body as a whole moves, and that nothing has been dealt to it yet."""
    s = world[Struck]
    s.com_mps[row], s.impulse_Ns[row] = com_mps, 0.0


def response_is_over(world, row: int, tick: int) -> bool:
    """Whether control may come back: the response has lasted its time, nothing presses any more; or all is lost.

    A blow that moves the whole body faster than `reel_over_mps` is left to the physics for longer, so that weight is
    seen: a light ball's effect is over after the 50 to 100 ms of the thesis, a heavy one's is not.
    """
    response, s, b = world.assets.settings.response, world[Struck], world[Blow]
    lasted_s = (tick - world[Reaction].since[row]) * TICK_S
    gained_mps = vector.length(s.impulse_Ns[row]) / world.assets.models[int(world[Character].body[row])].mass_kg
    reels_s = response.reel_s_per_mps * max(0.0, gained_mps - response.reel_over_mps)
    own_s = float(world[Character].response_s[row])
    longest_s = max(own_s, response.longest_s)
    if lasted_s < whole_ticks(own_s) * TICK_S:
        return False
    if lasted_s < whole_ticks(min(own_s + reels_s, longest_s)) * TICK_S:
        return has_fallen(world, row)
    presses = b.ball[row] != NOBODY or b.elapsed_s[row] < response.quiet_s
    return not presses or lasted_s >= longest_s


def has_fallen(world, row: int) -> bool:
    """Whether the feet can no longer get under the body: the capture point lies far outside them, or the hips are down.

    Capture point: COM + its velocity * sqrt(height / g) (Pratt et al. 2006), on the ground. Who ran when struck has
    feet for that: the velocity counts as it is, or as the blow has changed it, whichever leaves the better balance.
    """
    recovery, body = world.assets.settings.recovery, body_of(world, row)
    now, before = shown(world, row)
    com, was = com_of(body, now), com_of(body, before)
    at, turned = joints_of(body, now)
    if at[PELVIS, 2] < recovery.fallen_hip_share * footing.leg_length_m(body, 0):
        return True
    hull = support.polygon_of(body, at, turned, np.ones(2, bool))
    fall_s = math.sqrt(max(com[2], 0.1) / -GRAVITY_MPS2[2])
    moves_mps = (com[:2] - was[:2]) / TICK_S
    gained_mps = moves_mps - world[Struck].com_mps[row, :2]
    margins = [support.margin_m(hull, com[:2] + v * fall_s) for v in (moves_mps, gained_mps)]
    return bool(max(margins) < -recovery.capture_beyond_m)
