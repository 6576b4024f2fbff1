"""The protective motion (thesis 4.1.1): the startle, and the blend to the sustained pose.

    (startle) -> protect

`begin_*` enters a phase: it sets what the phase's source of poses needs (`behaviours.settle.sources`), plans the feet,
and keeps what is left of the old motion (`behaviours.phases`). When, is for `behaviours.reaction` to say.
"""

from __future__ import annotations

from behaviours.blends.blending import blend_end, primary_support
from behaviours.blends.held_feet import hold_feet, kept_bent, knees_between, leg_lengths
from behaviours.components import Blend, Feet, Phase, Reaction, Sustained, Threat
from behaviours.phases import enter, keep_continuous, set_blend
from behaviours.playing import body_of, capsules_of, clip_pose, clip_time_s, planted_in_clip
from behaviours.protect.protection import flight_ticks
from behaviours.protect.startled import lift_out_of_floor, within_reach
from behaviours.rules.startle import startle_pose
from behaviours.settle import feet as foot_plan
from behaviours.settle import seams
from behaviours.settle.footwork import land, step_into
from behaviours.settle.sources import BLENDING, choose_hand_ways, flying, source_pose
from behaviours.timing import TICK_S, time_to_contact_s, whole_ticks
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import ANKLES, HIPS, KNEES, WAIST, Pose


def begin_startle(world, row: int, tick: int, threat_row: int) -> None:
    """The reflex (3.2.6): a fifth of the way to a recoil, the head towards the threat, the standing feet where they
    are.
    """
    settings, body, clip_s = world.assets.settings, body_of(world, row), world[Reaction].clip_s[row]
    now, _ = seams.shown(world, row)
    with keep_continuous(world, row, tick):
        ahead = clip_pose(world, row, clip_s + settings.timing.startle_ahead_s)
        startled = startle_pose(body, ahead, -world[Threat].travel[threat_row], settings)
        plant_standing_feet(world, row, clip_s)
        startled = within_reach(body, now, ahead, startled, lambda pose: standing_in(world, row, tick, pose))
        set_blend(world, row, tick, now, startled, float(whole_ticks(settings.timing.startle_s)))
        choose_hand_ways(world, row)
        enter(world, row, tick, Phase.STARTLE)


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
    settings = world.assets.settings
    with keep_continuous(world, row, tick):
        now, lands = where_from(world, row, tick)
        # taken up late, it is as far as it gets when the ball is there: nobody's arms fly up in no time
        least = whole_ticks(settings.startle.least_sustained_s)
        takes = max(protecting_ticks(world, row, tick), float(least))
        sustained = sustained_pose(world, row)
        set_blend(world, row, tick, now, sustained, takes * (1.0 + settings.timing.slack_share))
        world[Blend].lands[row] = lands
        if lands > tick:
            fly_on(world, row, lands)
        else:
            step_into(world, row, tick, now, sustained, takes)
        enter(world, row, tick, Phase.PROTECT)


def sustained_pose(world, row: int) -> Pose:
    """The one in force; a copy."""
    s = world[Sustained]
    return Pose(s.root_m[row].copy(), s.rotations[row].copy())


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
    with keep_continuous(world, row, tick):
        now, takes = source_pose(world, row, tick - 1), protecting_ticks(world, row, tick)
        land(world, row, tick, now, sustained_pose(world, row), takes)


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
