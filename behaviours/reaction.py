"""The reaction as a state machine that reads like fig. 4.1 of the thesis.

    play -> (startle) -> protect -> respond -> recover_blend -> recover_return -> play
                            |          `-> down (knocked off the feet)
                            `-> hold (nothing came) -> recover_return

`begin_*` enters a phase: it sets what the phase's source of poses needs (`behaviours.settle.sources`), plans the feet,
and keeps what is left of the old motion (`behaviours.settle.seams`). The systems below say when.
"""

from __future__ import annotations

from behaviours.blends.blending import blend_end, primary_support
from behaviours.blends.held_feet import hold_feet, kept_bent, knees_between, leg_lengths
from behaviours.components import (
    NOBODY,
    Blend,
    Blow,
    Character,
    Feet,
    Flight,
    Phase,
    Playback,
    Posture,
    Ragdoll,
    Reaction,
    Residual,
    Struck,
    Sustained,
    Threat,
)
from behaviours.playing import body_of, capsules_of, clip_pose, clip_time_s, perception_clip_s, planted_in_clip
from behaviours.protect.protection import flight_ticks, perceived_threat, protect_from
from behaviours.protect.startled import lift_out_of_floor, within_reach
from behaviours.protect.sustained import Case
from behaviours.recover.recovery import begin_recovery, begin_return, resume_clip
from behaviours.recover.search import choose_return
from behaviours.respond.falling import begin_falling
from behaviours.respond.knocked_down import has_fallen, response_is_over
from behaviours.rules.startle import startle_pose
from behaviours.settle import feet as foot_plan
from behaviours.settle import seams
from behaviours.settle.footwork import land, step_into
from behaviours.settle.settling import settled_pose
from behaviours.settle.sources import BLENDING, choose_hand_ways, flying, foot_goals, source_pose
from behaviours.timing import TICK_S, time_to_contact_s, whole_ticks
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import ANKLES, HIPS, KNEES, WAIST, Pose
from engine.core.schedule import Stage, system

BUSY = (Phase.STARTLE, Phase.PROTECT, Phase.RESPOND, Phase.RECOVER_BLEND, Phase.DOWN, Phase.STOPPED)
STATE = (
    Blend, Blow, Character, Feet, Flight, Playback, Posture, Ragdoll, Reaction, Residual, Struck, Sustained, Threat,
)  # fmt: skip


def enter(world, row: int, tick: int, phase: Phase) -> None:
    """Begins a phase now, and says so."""
    world[Reaction].phase[row] = phase
    world[Reaction].since[row] = tick
    world.emit("phase", world.entity(row), name=phase.name.lower())


def moment_before(world, row: int, tick: int) -> Pose:
    """What was shown a moment before the last tick, asked of the source that was in force. Before anything is
    changed.
    """
    return Pose(*settled_pose(world, row, tick - 1 - seams.MOMENT))


def keep_continuous(world, row: int, tick: int, shown_before: Pose) -> None:
    """Measures the seam between what was shown and what the new phase shows; call it when the phase is all set up."""
    last, later = tick - 1, tick - 1 + seams.MOMENT
    pose, pose_later = source_pose(world, row, last), source_pose(world, row, later)
    goals, goals_later = foot_goals(world, row, last, pose), foot_goals(world, row, later, pose_later)
    source = seams.Moving(pose, pose_later, goals, goals_later)
    seams.begin_seam(world, row, tick, body_of(world, row), shown_before, source)


def set_blend(world, row: int, tick: int, start: Pose, end: Pose, ticks: float) -> None:
    """Sets the two ends of a blend that left its first end at the last tick; how the hands go is yet to be chosen."""
    b, f = world[Blend], world[Feet]
    b.from_root_m[row], b.from_rotations[row] = start
    b.to_root_m[row], b.to_rotations[row] = end
    b.since[row], b.ticks[row] = tick - 1, ticks
    body = body_of(world, row)
    positions, _ = joints_of(body, start)
    b.support[row] = primary_support(f.planted[row], positions[list(ANKLES)], com_of(body, start))


def begin_startle(world, row: int, tick: int, threat_row: int) -> None:
    """The reflex (3.2.6): a fifth of the way to a recoil, the head towards the threat, the standing feet where they
    are.
    """
    settings = world.assets.settings
    old = moment_before(world, row, tick)
    now, _ = seams.shown(world, row)
    ahead = clip_pose(world, row, world[Reaction].clip_s[row] + settings.timing.startle_ahead_s)
    toward = -world[Threat].travel[threat_row]
    body = body_of(world, row)
    startled = startle_pose(body, ahead, toward, settings)
    plant_standing_feet(world, row, world[Reaction].clip_s[row])
    startled = within_reach(body, now, ahead, startled, lambda pose: standing_in(world, row, tick, pose))
    set_blend(world, row, tick, now, startled, float(whole_ticks(settings.timing.startle_s)))
    choose_hand_ways(world, row)
    enter(world, row, tick, Phase.STARTLE)
    keep_continuous(world, row, tick, old)


def standing_in(world, row: int, tick: int, pose: Pose) -> Pose:
    """The pose with the held feet where they are held, the pelvis lowered as far as that takes, the others above the
    floor: an end that can be reached.
    """
    body = body_of(world, row)
    end = blend_end(body, capsules_of(world, row), *pose)
    goals = foot_plan.goals_of(world[Feet], row, tick)
    knees = knees_between(end, end, False, end.positions[list(KNEES)])
    own = kept_bent(body, leg_lengths(end.positions))  # a knee that is dead straight leaves at a speed without bounds
    hold_feet(body, goals, own, knees, 0.0, end.root_m, end.rotations, end.positions, end.orientations)
    return lift_out_of_floor(body, Pose(end.root_m, end.rotations), ~goals.bound)


def plant_standing_feet(world, row: int, clip_s: float) -> None:
    """The feet that stand in the clip are held where they are shown; the others go with the pose."""
    f, body, now = world[Feet], body_of(world, row), seams.shown(world, row)[0]
    standing = planted_in_clip(world, row, clip_s)
    for side in range(2):
        if standing[side]:
            foot_plan.hold(f, row, side, foot_plan.footing_of(body, now, side))
        else:
            foot_plan.let_go(f, row, side)


def begin_protecting(world, row: int, tick: int) -> None:
    """The blend to the sustained pose, stretched by the slack so that it is never reached early (4.2)."""
    settings, s = world.assets.settings, world[Sustained]
    old = moment_before(world, row, tick)
    now, lands = where_from(world, row, tick)
    sustained = Pose(s.root_m[row].copy(), s.rotations[row].copy())
    # taken up late, it is as far as it gets when the ball is there: nobody's arms fly up in no time
    least = whole_ticks(settings.startle.least_sustained_s)
    takes = max(protecting_ticks(world, row, tick), float(least))
    set_blend(world, row, tick, now, sustained, takes * (1.0 + settings.timing.slack_share))
    world[Blend].lands[row] = lands
    if lands > tick:
        fly_on(world, row, lands)
    else:
        step_into(world, row, tick, now, sustained, takes)
    enter(world, row, tick, Phase.PROTECT)
    keep_continuous(world, row, tick, old)


def fly_on(world, row: int, lands: int) -> None:
    """Nobody hovers until the ball comes: who is in the air flies and lands as in the clip, and makes for the sustained
    pose meanwhile. The foot that will land supports.
    """
    b, body = world[Blend], body_of(world, row)
    for side in range(2):
        foot_plan.let_go(world[Feet], row, side)
    first = Pose(b.from_root_m[row], b.from_rotations[row])
    ankles = joints_of(body, first)[0][list(ANKLES)]
    standing = planted_in_clip(world, row, clip_time_s(world, row, lands))
    b.support[row] = primary_support(standing, ankles, com_of(body, first))
    choose_hand_ways(world, row)


def touch_down(world, row: int, tick: int) -> None:
    """A flight that was begun in is over: from here on the feet are planned."""
    old, s = moment_before(world, row, tick), world[Sustained]
    sustained = Pose(s.root_m[row].copy(), s.rotations[row].copy())
    land(world, row, tick, source_pose(world, row, tick - 1), sustained, protecting_ticks(world, row, tick))
    keep_continuous(world, row, tick, old)


def where_from(world, row: int, tick: int) -> tuple[Pose, int]:
    """What the blend to the sustained pose leaves, and the tick at which that lands; 0 for a foot on the ground.

    It is what is shown, on the pelvis and legs of the present blend, so that feet are where they are held: what a seam
    has left over there goes on by itself. Or, in flight, on those of the clip where it lands.
    """
    r, now = world[Reaction], seams.shown(world, row)[0]
    if r.phase[row] in BLENDING:
        source = source_pose(world, row, tick - 1)
        source.rotations[WAIST : HIPS[0]] = now.rotations[WAIST : HIPS[0]]
        return source, 0
    flies = flight_ticks(world, row, float(r.clip_s[row]), (r.contact[row] - tick) * TICK_S)
    if flies == 0 or r.phase[row] != Phase.PLAY:
        return now, 0
    return flying(world, row, tick + flies, now), tick + flies


def protecting_ticks(world, row: int, tick: int) -> float:
    """How long the movement takes: up to contact; or, angle-free (4.2), as long as it would against a threat from
    ahead.
    """
    r, timing = world[Reaction], world.assets.settings.timing
    left = max(1, int(r.contact[row]) - tick + 1)
    if not timing.angle_free or not world.alive(int(r.threat[row])):
        return float(left)
    speed_norm = float(world[Threat].speed_norm[world.row(int(r.threat[row]))])
    from_ahead = whole_ticks(time_to_contact_s(speed_norm, 1.0, timing))
    return float(min(left, max(1, from_ahead - (tick - int(r.perceived[row])))))


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
            continue
        r.perceived[row], r.contact[row] = tick, threats.contact[threat_row]
        r.threat[row] = world.entity(threat_row)
        r.struck[row], r.flinches[row] = False, False
        r.clip_s[row] = perception_clip_s(world, row, tick)
        ttc_s = (r.contact[row] - tick) * TICK_S
        startle = startles(world, row, ttc_s)
        protect_from(world, row, perceived_threat(world, row, threat_row))
        world.emit(
            "perceived",
            world.entity(row),
            threat=int(r.threat[row]),
            ttc_s=ttc_s,
            startle=startle,
            case=Case(int(world[Sustained].case[row])).name.lower(),
        )
        if startle == "taken":
            begin_startle(world, row, tick, threat_row)
        else:
            begin_protecting(world, row, tick)


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
    """Whether there is the time for a startle before the sustained pose (3.2.6), and the occasion: nobody's knees give
    in flight, and a guard that is up already is not dropped to be startled.
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
    r, settings = world[Reaction], world.assets.settings
    for row in world.rows(Reaction, Posture):
        phase, lasted = Phase(int(r.phase[row])), tick - r.since[row]
        if phase == Phase.STARTLE and lasted >= whole_ticks(settings.timing.startle_s):
            if r.flinches[row]:
                end_flinch(world, row, tick)
            else:
                begin_protecting(world, row, tick)
        elif phase == Phase.PROTECT and tick == world[Blend].lands[row] + 1:
            touch_down(world, row, tick)
        elif phase == Phase.PROTECT and tick > world[Blend].lands[row] and gives_up(world, row, tick):
            world.emit("missed", world.entity(row), threat=int(r.threat[row]))
            enter(world, row, tick, Phase.HOLD)
        elif phase == Phase.HOLD and lasted >= whole_ticks(settings.recovery.hold_s):
            old = moment_before(world, row, tick)
            begin_return(world, row, tick)
            enter(world, row, tick, Phase.RECOVER_RETURN)
            keep_continuous(world, row, tick, old)
        elif phase == Phase.RESPOND and response_is_over(world, row, tick):
            end_response(world, row, tick)
        elif phase == Phase.RECOVER_BLEND and lasted >= whole_ticks(settings.recovery.part_one_s):
            old = moment_before(world, row, tick)
            world[Ragdoll].active[row] = False
            enter(world, row, tick, Phase.RECOVER_RETURN)
            keep_continuous(world, row, tick, old)
        elif phase == Phase.RECOVER_RETURN and tick - 1 >= world[Blend].since[row] + world[Blend].ticks[row]:
            old = moment_before(world, row, tick)
            resume_clip(world, row, tick)
            enter(world, row, tick, Phase.PLAY)
            keep_continuous(world, row, tick, old)
            r.threat[row] = NOBODY


def gives_up(world, row: int, tick: int) -> bool:
    """Whether nothing has come, or will come any more."""
    return bool(tick > world[Reaction].contact[row] + MISS_TICKS) or is_off(world, row)


def is_off(world, row: int) -> bool:
    """Whether what a character guards against is no longer there, or no longer coming."""
    threat = int(world[Reaction].threat[row])
    return not world.alive(threat) or bool(world[Threat].strayed[world.row(threat)])


def flinch(world, row: int, tick: int, threat_row: int) -> None:
    """What only passes close may startle; it never calls for protection (A6)."""
    r = world[Reaction]
    if not world[Character].startle[row] or r.phase[row] != Phase.PLAY:
        return
    r.perceived[row], r.contact[row] = tick, world[Threat].contact[threat_row]
    r.threat[row], r.struck[row], r.flinches[row] = world.entity(threat_row), False, True
    r.clip_s[row] = perception_clip_s(world, row, tick)
    world.emit("flinched", world.entity(row), threat=int(r.threat[row]))
    begin_startle(world, row, tick, threat_row)


def end_flinch(world, row: int, tick: int) -> None:
    """From the startle straight back to the clip: from the pose that is shown, on the feet as they are."""
    f, s, body, now = world[Feet], world[Sustained], body_of(world, row), seams.shown(world, row)[0]
    old = moment_before(world, row, tick)
    s.root_m[row], s.rotations[row] = now
    for side in range(2):
        foot_plan.hold(f, row, side, foot_plan.footing_of(body, now, side))
    world[Reaction].flinches[row] = False
    begin_return(world, row, tick)
    enter(world, row, tick, Phase.RECOVER_RETURN)
    keep_continuous(world, row, tick, old)


MISS_TICKS = 6  # after the promised contact, before a threat that touched nothing counts as gone


def end_response(world, row: int, tick: int) -> None:
    """Back to control, or down if the feet can no longer get under the body."""
    if has_fallen(world, row):
        begin_falling(world, row)
        enter(world, row, tick, Phase.DOWN)
        return
    old = moment_before(world, row, tick)
    choose_return(world, row)
    begin_recovery(world, row, tick)
    enter(world, row, tick, Phase.RECOVER_BLEND)
    keep_continuous(world, row, tick, old)
