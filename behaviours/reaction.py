"""The reaction as a state machine that reads like fig. 4.1 of the thesis.

    play -> (startle) -> protect -> respond -> recover_blend -> recover_return -> play
                            |          `-> down (knocked off the feet)
                            `-> hold (nothing came) -> recover_return

`begin_*` enters a phase: it sets what the phase's source of poses needs (`behaviours.sources`), plans the feet, and
keeps what is left of the old motion (`behaviours.seams`). The systems below say when.
"""

from __future__ import annotations

from behaviours import feet as foot_plan
from behaviours import seams
from behaviours.blending import blend_end, primary_support
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
from behaviours.falling import begin_falling
from behaviours.held_feet import hold_feet, knees_between, leg_lengths
from behaviours.knocked_down import has_fallen, response_is_over
from behaviours.playing import body_of, capsules_of, clip_pose, perception_clip_s, planted_in_clip
from behaviours.protection import perceived_threat, protect_from
from behaviours.recovery import begin_recovery, begin_return, resume_clip
from behaviours.rules.startle import startle_pose
from behaviours.search import choose_return
from behaviours.settling import settled_pose
from behaviours.sources import choose_hand_ways, foot_goals, source_pose
from behaviours.startled import within_reach
from behaviours.sustained import Case
from behaviours.timing import TICK_S, time_to_contact_s, whole_ticks
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import ANKLES, KNEES, Pose
from engine.core.schedule import Stage, system

BUSY = (Phase.STARTLE, Phase.PROTECT, Phase.RESPOND, Phase.RECOVER_BLEND, Phase.DOWN, Phase.STOPPED)
STATE = (
    Blend, Blow, Character, Feet, Flight, Playback, Posture, Ragdoll, Reaction, Residual, Struck, Sustained, Threat,
)  # fmt: skip
STEP_SHARE = 0.9  # of the time to contact: a foot stands before the blow comes


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


def begin_blend(world, row: int, tick: int, start: Pose, end: Pose, ticks: float) -> None:
    """Sets the two ends of a blend that left its first end at the last tick."""
    b, f = world[Blend], world[Feet]
    b.from_root_m[row], b.from_rotations[row] = start
    b.to_root_m[row], b.to_rotations[row] = end
    b.since[row], b.ticks[row] = tick - 1, ticks
    body = body_of(world, row)
    positions, _ = joints_of(body, start)
    b.support[row] = primary_support(f.planted[row], positions[list(ANKLES)], com_of(body, start))
    choose_hand_ways(world, row)


def begin_startle(world, row: int, tick: int, threat_row: int) -> None:
    """The reflex (3.2.6): a fifth of the way to a recoil, the head towards the threat, the standing feet where they
    are.
    """
    settings = world.assets.settings
    old = moment_before(world, row, tick)
    now, _ = seams.shown(world, row)
    ahead_s = world[Reaction].clip_s[row] + settings.timing.startle_ahead_s
    ahead = clip_pose(world, row, ahead_s)
    toward = -world[Threat].travel[threat_row]
    body = body_of(world, row)
    startled = startle_pose(body, ahead, toward, settings)
    plant_standing_feet(world, row, tick)
    startled = within_reach(body, now, ahead, startled, lambda pose: standing_in(world, row, tick, pose))
    begin_blend(world, row, tick, now, startled, float(whole_ticks(settings.timing.startle_s)))
    enter(world, row, tick, Phase.STARTLE)
    keep_continuous(world, row, tick, old)


def standing_in(world, row: int, tick: int, pose: Pose) -> Pose:
    """The pose with the held feet where they are held, the pelvis lowered as far as that takes: an end that can be
    reached.
    """
    body = body_of(world, row)
    end = blend_end(body, capsules_of(world, row), *pose)
    goals = foot_plan.goals_of(world[Feet], row, tick)
    knees = knees_between(end, end, False, end.positions[list(KNEES)])
    own = leg_lengths(end.positions)
    hold_feet(body, goals, own, knees, 0.0, end.root_m, end.rotations, end.positions, end.orientations)
    return Pose(end.root_m, end.rotations)


def plant_standing_feet(world, row: int, tick: int) -> None:
    """The feet that stand in the clip are held where they are shown; the others go with the pose."""
    f, body, now = world[Feet], body_of(world, row), seams.shown(world, row)[0]
    standing = planted_in_clip(world, row, world[Reaction].clip_s[row])
    for side in range(2):
        if standing[side]:
            foot_plan.hold(f, row, side, foot_plan.footing_of(body, now, side))
        else:
            foot_plan.let_go(f, row, side)


def begin_protecting(world, row: int, tick: int) -> None:
    """The blend to the sustained pose, stretched by the slack so that it is never reached early (4.2)."""
    settings, s = world.assets.settings, world[Sustained]
    old = moment_before(world, row, tick)
    now, _ = seams.shown(world, row)
    sustained = Pose(s.root_m[row].copy(), s.rotations[row].copy())
    takes = protecting_ticks(world, row, tick)
    plan_steps(world, row, tick, sustained, STEP_SHARE * takes)
    begin_blend(world, row, tick, now, sustained, takes * (1.0 + settings.timing.slack_share))
    enter(world, row, tick, Phase.PROTECT)
    keep_continuous(world, row, tick, old)


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


def plan_steps(world, row: int, tick: int, to: Pose, ticks: float) -> None:
    """Each foot is held where it is, or steps to where the pose has it."""
    body, f, now = body_of(world, row), world[Feet], seams.shown(world, row)[0]
    for side in range(2):
        start, end = foot_plan.footing_of(body, now, side), foot_plan.footing_of(body, to, side)
        if not world[Sustained].held[row, side]:
            foot_plan.let_go(f, row, side)
        else:
            foot_plan.hold_or_step(f, row, side, start, end, tick - 1, ticks, world.assets.settings.balance)


@system(Stage.DECIDE, reads=STATE, writes=STATE)
def notice(world, tick):
    """Whoever perceives a threat now works out the pose to meet it in, and startles or begins to protect (3, 4.2)."""
    threats, r, c = world[Threat], world[Reaction], world[Character]
    settings = world.assets.settings
    for threat_row in world.rows(Threat, Flight):
        if not threats.noticed[threat_row] or threats.taken_up[threat_row]:
            continue
        threats.taken_up[threat_row] = True
        row = world.row(int(threats.at[threat_row]))
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
        left_s = ttc_s - settings.timing.startle_s
        startle = bool(c.startle[row]) and left_s >= settings.startle.least_sustained_s
        protect_from(world, row, perceived_threat(world, row, threat_row))
        world.emit(
            "perceived",
            world.entity(row),
            threat=int(r.threat[row]),
            ttc_s=ttc_s,
            startle="taken" if startle else ("too late" if c.startle[row] else "off"),
            case=Case(int(world[Sustained].case[row])).name.lower(),
        )
        if startle:
            begin_startle(world, row, tick, threat_row)
        else:
            begin_protecting(world, row, tick)


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
        elif phase == Phase.PROTECT and (tick > r.contact[row] + MISS_TICKS or is_off(world, row)):
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
