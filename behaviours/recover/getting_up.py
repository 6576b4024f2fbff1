"""After a knock-down (specification A8): once the body lies still, the search may find it a motion that gets up.

    down -> recover_blend -> recover_return -> play

A get-up is a motion of the library that starts lying and will stand. The window that fits best is laid where the body
lies; the servos bring the body towards the pose in which that motion begins, while the picture goes over to it.
"""

from __future__ import annotations

import math

from behaviours.components import NOBODY, Blend, Feet, Phase, Reaction, Struck, Sustained
from behaviours.phases import STATE, enter, keep_continuous
from behaviours.playing import body_of, clip_pose, return_clip_s
from behaviours.recover.search import Found, best_window, enter_window, say_found, window_since_blow
from behaviours.recover.windows import joint_shares
from behaviours.settle import feet as foot_plan
from behaviours.settle.seams import shown
from behaviours.settle.sources import choose_first_ways, choose_hand_ways
from behaviours.timing import TICK_S, whole_ticks
from engine.core.schedule import Stage, system

NO_GET_UP = "no motion that gets up"  # is in the library


@system(Stage.DECIDE, reads=STATE, writes=STATE)
def get_up(world, tick):
    """Whoever is down and has lain still for a while gets up, if a motion for it is near enough."""
    settings, s = world.assets.settings.search, world[Struck]
    for row in world.rows(Struck, Reaction):
        if world[Reaction].phase[row] != Phase.DOWN or s.said[row]:
            continue
        s.rests[row] = s.rests[row] + 1 if mean_speed_mps(world, row) < settings.rest_mps else 0
        if s.rests[row] >= whole_ticks(settings.rest_s):
            rise_or_stay(world, row, tick)


def mean_speed_mps(world, row: int) -> float:
    """How fast the body moves under the physics: root mean square over its mass."""
    share = joint_shares(body_of(world, row))
    speed = window_since_blow(world, row).joints_mps[0]
    return math.sqrt(float((share * (speed**2).sum(axis=1)).sum()))


def rise_or_stay(world, row: int, tick: int) -> None:
    """Looks for a get-up. Without one, or with none near enough, the body stays down; that is said once."""
    settings, library = world.assets.settings.search, world.assets.libraries[row]
    found = library and best_window(
        library.motions, window_since_blow(world, row), "rising", settings.velocity_s, settings.candidates
    )
    if found is not None and found.distance_m <= settings.get_up_within_m:
        say_found(world, row, found, "get_up")
        begin_getting_up(world, row, tick, found)
        return
    world[Struck].said[row] = True
    reason = NO_GET_UP if found is None else f"the nearest get-up begins {found.distance_m:.2f} m off"
    world.emit("stays_down", world.entity(row), reason=reason)


def begin_getting_up(world, row: int, tick: int, found: Found) -> None:
    """From lying as fallen to lying as the motion begins; the feet, which carry nothing, go with the pose."""
    settings, b, s = world.assets.settings.search, world[Blend], world[Sustained]
    with keep_continuous(world, row, tick):
        enter_window(world, row, world.assets.libraries[row], found)
        begins = clip_pose(world, row, return_clip_s(world, row))
        b.from_root_m[row], b.from_rotations[row] = shown(world, row)[0]
        b.to_root_m[row], b.to_rotations[row] = begins
        b.lead_s[row] = 0.0
        b.since[row], b.ticks[row], b.support[row] = tick - 1, settings.get_up_blend_s / TICK_S, NOBODY
        s.root_m[row], s.rotations[row] = begins
        for side in range(2):
            foot_plan.let_go(world[Feet], row, side)
        choose_hand_ways(world, row)
        choose_first_ways(world, row, tick)
        enter(world, row, tick, Phase.RECOVER_BLEND)
