"""The reaction as a state machine that reads like fig. 4.1 of the thesis.

    play -> (startle) -> protect -> respond -> recover_blend -> recover_return -> play
                            |          `-> down (knocked off the feet)
                            `-> hold (nothing came) -> recover_return

The systems here say when. How a phase begins is in `behaviours.protective_motion`, `respond` and `recover`; that
nothing jumps where one gives way to another is for `behaviours.phases`.
"""

from __future__ import annotations

from behaviours.components import (
    NOBODY,
    Blend,
    Character,
    Feet,
    Flight,
    Phase,
    Posture,
    Ragdoll,
    Reaction,
    Sustained,
    Threat,
)
from behaviours.phases import STATE, enter, keep_continuous
from behaviours.playing import body_of, perception_clip_s
from behaviours.protect.protection import flight_ticks, perceived_threat, protect_from
from behaviours.protect.sustained import Case
from behaviours.protective_motion import begin_protecting, begin_startle, touch_down
from behaviours.recover.recovery import begin_recovery, begin_return, resume_clip
from behaviours.recover.search import choose_return
from behaviours.respond.falling import begin_falling
from behaviours.respond.knocked_down import has_fallen, response_is_over
from behaviours.settle import feet as foot_plan
from behaviours.settle import seams
from behaviours.timing import TICK_S, whole_ticks
from engine.core.schedule import Stage, system

BUSY = (Phase.STARTLE, Phase.PROTECT, Phase.RESPOND, Phase.RECOVER_BLEND, Phase.DOWN, Phase.STOPPED)
MISS_TICKS = 6  # after the promised contact, before a threat that touched nothing counts as gone


@system(Stage.DECIDE, reads=STATE, writes=STATE)
def notice(world, tick):
    """Whoever perceives a threat now works out the pose to meet it in, and startles or begins to protect (3, 4.2)."""
    threats, r, c = world[Threat], world[Reaction], world[Character]
    for threat_row in soonest_first(world):
        row = world.row(int(threats.at[threat_row]))
        if waits(world, row, threat_row, tick):
            continue
        threats.taken_up[threat_row] = True
        if (r.phase[row] in BUSY and not r.flinches[row]) or not c.protects[row]:
            continue
        if threats.passes[threat_row]:
            flinch(world, row, tick, threat_row)
        else:
            react(world, row, tick, threat_row)


def react(world, row: int, tick: int, threat_row: int) -> None:
    """The pose to meet a threat in is worked out at once; what is shown first may be a startle."""
    r = world[Reaction]
    attend_to(world, row, tick, threat_row)
    ttc_s = (r.contact[row] - tick) * TICK_S
    startle = startles(world, row, ttc_s)
    protect_from(world, row, perceived_threat(world, row, threat_row))
    case = Case(int(world[Sustained].case[row])).name.lower()
    world.emit("perceived", world.entity(row), threat=int(r.threat[row]), ttc_s=ttc_s, startle=startle, case=case)
    if startle == "taken":
        begin_startle(world, row, tick, threat_row)
    else:
        begin_protecting(world, row, tick)


def attend_to(world, row: int, tick: int, threat_row: int, flinches: bool = False) -> None:
    """From now on it is this threat that the character's reaction is about."""
    r = world[Reaction]
    r.perceived[row], r.contact[row] = tick, world[Threat].contact[threat_row]
    r.threat[row], r.struck[row], r.flinches[row] = world.entity(threat_row), False, flinches
    r.clip_s[row] = perception_clip_s(world, row, tick)


def soonest_first(world) -> list[int]:
    """Rows of the threats that have been noticed and not been decided about, in the order in which they will come."""
    threats = world[Threat]
    rows = [int(row) for row in world.rows(Threat, Flight) if threats.noticed[row] and not threats.taken_up[row]]
    return sorted(rows, key=lambda row: int(threats.contact[row]))


def waits(world, row: int, threat_row: int, tick: int) -> bool:
    """Whether a threat that still comes is kept in mind by somebody who is busy with another: one after the other."""
    threats, r = world[Threat], world[Reaction]
    if r.phase[row] not in BUSY or r.flinches[row] or not world[Character].protects[row]:
        return False
    gone = threats.passes[threat_row] or threats.spent[threat_row] or threats.strayed[threat_row]
    return not gone and bool(tick < threats.contact[threat_row])


def startles(world, row: int, ttc_s: float) -> str:
    """Whether there is the time for a startle before the sustained pose (3.2.6), and the occasion: "taken", or why not.

    Nobody's knees give in flight, and a guard that is up already is not dropped to be startled.
    """
    r, settings = world[Reaction], world.assets.settings
    if not world[Character].startle[row]:
        return "off"
    if r.phase[row] != Phase.PLAY:
        return "on guard"
    if flight_ticks(world, row, float(r.clip_s[row]), ttc_s) > 0:
        return "in the air"
    return "taken" if ttc_s - settings.timing.startle_s >= settings.startle.least_sustained_s else "too late"


@system(Stage.DECIDE, reads=STATE, writes=STATE)
def advance_reactions(world, tick):
    """Each phase gives way to the next when its time is up (fig. 4.1)."""
    r, b, settings = world[Reaction], world[Blend], world.assets.settings
    for row in world.rows(Reaction, Posture):
        phase, lasted = Phase(int(r.phase[row])), tick - r.since[row]
        if phase == Phase.STARTLE and lasted >= whole_ticks(settings.timing.startle_s):
            end_startle(world, row, tick)
        elif phase == Phase.PROTECT and tick == b.lands[row] + 1:
            touch_down(world, row, tick)
        elif phase == Phase.PROTECT and tick > b.lands[row] and gives_up(world, row, tick):
            world.emit("missed", world.entity(row), threat=int(r.threat[row]))
            enter(world, row, tick, Phase.HOLD)
        elif phase == Phase.HOLD and lasted >= whole_ticks(settings.recovery.hold_s):
            end_hold(world, row, tick)
        elif phase == Phase.RESPOND and response_is_over(world, row, tick):
            end_response(world, row, tick)
        elif phase == Phase.RECOVER_BLEND and lasted >= whole_ticks(settings.recovery.part_one_s):
            end_part_one(world, row, tick)
        elif phase == Phase.RECOVER_RETURN and tick - 1 >= b.since[row] + b.ticks[row]:
            end_return(world, row, tick)


def end_startle(world, row: int, tick: int) -> None:
    """On to the sustained pose; or, where the threat only passes close, straight back to the clip."""
    if world[Reaction].flinches[row]:
        end_flinch(world, row, tick)
    else:
        begin_protecting(world, row, tick)


def gives_up(world, row: int, tick: int) -> bool:
    """Whether nothing has come, or will come any more."""
    return bool(tick > world[Reaction].contact[row] + MISS_TICKS) or is_off(world, row)


def is_off(world, row: int) -> bool:
    """Whether what a character guards against is no longer there, or no longer coming."""
    threat = int(world[Reaction].threat[row])
    return not world.alive(threat) or bool(world[Threat].strayed[world.row(threat)])


def flinch(world, row: int, tick: int, threat_row: int) -> None:
    """What only passes close may startle; it never calls for protection (A6)."""
    if not world[Character].startle[row] or world[Reaction].phase[row] != Phase.PLAY:
        return
    attend_to(world, row, tick, threat_row, flinches=True)
    world.emit("flinched", world.entity(row), threat=int(world[Reaction].threat[row]))
    begin_startle(world, row, tick, threat_row)


def end_flinch(world, row: int, tick: int) -> None:
    """From the startle straight back to the clip: from the pose that is shown, on the feet as they are."""
    f, s, body, now = world[Feet], world[Sustained], body_of(world, row), seams.shown(world, row)[0]
    with keep_continuous(world, row, tick):
        s.root_m[row], s.rotations[row] = now
        for side in range(2):
            foot_plan.hold(f, row, side, foot_plan.footing_of(body, now, side))
        world[Reaction].flinches[row] = False
        begin_return(world, row, tick)
        enter(world, row, tick, Phase.RECOVER_RETURN)


def end_hold(world, row: int, tick: int) -> None:
    """Nothing came: back to the clip without a physical part."""
    with keep_continuous(world, row, tick):
        begin_return(world, row, tick)
        enter(world, row, tick, Phase.RECOVER_RETURN)


def end_response(world, row: int, tick: int) -> None:
    """Back to control, or down if the feet can no longer get under the body."""
    if has_fallen(world, row):
        begin_falling(world, row)
        enter(world, row, tick, Phase.DOWN)
        return
    with keep_continuous(world, row, tick):
        choose_return(world, row)
        begin_recovery(world, row, tick)
        enter(world, row, tick, Phase.RECOVER_BLEND)


def end_part_one(world, row: int, tick: int) -> None:
    """The body is out of the physics' hands, and on its way to the return pose."""
    with keep_continuous(world, row, tick):
        world[Ragdoll].active[row] = False
        enter(world, row, tick, Phase.RECOVER_RETURN)


def end_return(world, row: int, tick: int) -> None:
    """The clip runs again."""
    with keep_continuous(world, row, tick):
        resume_clip(world, row, tick)
        enter(world, row, tick, Phase.PLAY)
    world[Reaction].threat[row] = NOBODY
