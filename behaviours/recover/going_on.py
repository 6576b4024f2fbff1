"""A motion that the search has found may end: then the character goes on with the clip of its own.

Nothing is struck here, so it is the recovery without its physical part: from the pose in which the found motion ends to
the window of the own clip that is nearest to it.
"""

from __future__ import annotations

import numpy as np

from behaviours.components import Feet, Phase, Playback, Reaction, Struck, Sustained
from behaviours.phases import STATE, enter, keep_continuous
from behaviours.playing import body_of, clip_of, clip_time_s, return_clip_s
from behaviours.recover.recovery import begin_return
from behaviours.recover.search import Window, best_window, enter_window
from behaviours.settle import feet as foot_plan
from behaviours.settle.seams import shown
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.core.schedule import Stage, system


@system(Stage.DECIDE, reads=STATE, writes=STATE)
def go_on(world, tick):
    """Whoever has come to the end of a motion that the search found takes up its own clip again."""
    for row in world.rows(Struck, Playback):
        if world[Reaction].phase[row] == Phase.PLAY:
            world[Struck].played[row] = world[Playback].clip[row]
            if is_over(world, row, tick):
                take_up_own_clip(world, row, tick)


def is_over(world, row: int, tick: int) -> bool:
    """Whether a found motion ends at this tick."""
    own, clip = world.assets.character_rows[row], clip_of(world, row)
    if world[Playback].clip[row] == own or clip.loops:
        return False
    return 0.0 <= clip_time_s(world, row, tick) - clip.duration_s < TICK_S


def take_up_own_clip(world, row: int, tick: int) -> None:
    """Blends to the window of the own clip that is nearest to the pose shown. Without one the last pose is held."""
    settings, library = world.assets.settings.search, world.assets.libraries[row]
    found = best_window(
        library.motions, shown_window(world, row), "standing", settings.velocity_s, settings.candidates, only_clip=0
    )
    if found is None:
        return
    s, f, body, now = world[Sustained], world[Feet], body_of(world, row), shown(world, row)[0]
    with keep_continuous(world, row, tick):
        s.root_m[row], s.rotations[row] = now
        for side in range(2):
            foot_plan.hold(f, row, side, foot_plan.footing_of(body, now, side))
        enter_window(world, row, library, found)
        begin_return(world, row, tick)
        world.emit("went_on", world.entity(row), clip=clip_of(world, row).name, entered_s=return_clip_s(world, row))
        enter(world, row, tick, Phase.RECOVER_RETURN)


def shown_window(world, row: int) -> Window:
    """What was shown at the last two ticks, as a window of one sample."""
    joints_m, before_m = (joints_of(body_of(world, row), pose)[0] for pose in shown(world, row))
    return Window(joints_m[np.newaxis], (joints_m - before_m)[np.newaxis] / TICK_S)
