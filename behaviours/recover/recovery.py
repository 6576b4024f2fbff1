"""Recovery (thesis 4.1.3): back to a meaningful motion, in two parts.

Part one blends two sequences: the running simulation, and the sustained pose held and then a quarter of the way to
the return pose. Part two is the rest of the way. The return blend thus lasts 500 ms, the first 125 of them in part
one (A9). The return pose is the clip 1/6 s after perception, or where a foot next stands in it if none does then, its
path shifted so that this foot stands where it stood.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.blends.blending import primary_support
from behaviours.components import Blend, Feet, Playback, Reaction, Sustained
from behaviours.placing import placed
from behaviours.playing import body_of, clip_of, clip_pose, pace_after, planted_in_clip, play_from, return_clip_s
from behaviours.settle import feet as foot_plan
from behaviours.settle.seams import shown
from behaviours.settle.sources import choose_first_ways, choose_hand_ways
from behaviours.timing import TICK_S, whole_ticks
from engine.body import footing
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import ANKLES, Pose
from engine.maths import quaternion, vector

JOLT_MPS = 1.0  # that a pelvis changes its velocity by from one tick to the next: 12 g
# a foot that stands moves this much in a recording
STAYS_M, STAYS_RAD = 0.015, math.radians(6.0)


def return_blend_ticks(world) -> float:
    """How long the return blend lasts: part two is what part one's share leaves of it."""
    r = world.assets.settings.recovery
    return r.part_two_s / (1.0 - r.part_one_share) / TICK_S


def begin_recovery(world, row: int, tick: int) -> None:
    """Part one: sets the feet down where the blow has left them, the sustained pose over them, and the way back from
    there.
    """
    recovery = world.assets.settings.recovery
    stand_where_the_blow_left(world, row, tick)
    move_sustained_over_feet(world, row)
    part_one = whole_ticks(recovery.part_one_s)
    begins = tick - 1 + part_one - recovery.part_one_share * return_blend_ticks(world)
    plan_return(world, row, tick, begins)
    choose_first_ways(world, row, tick)


def begin_return(world, row: int, tick: int) -> None:
    """Straight back from the sustained pose: nothing was touched, so there is no physics to blend out of."""
    plan_return(world, row, tick, float(tick - 1))


def stand_where_the_blow_left(world, row: int, tick: int) -> None:
    """Each foot is held flat where it comes to rest; one in the air steps down below itself."""
    f, body, settings = world[Feet], body_of(world, row), world.assets.settings
    (now, before) = shown(world, row)
    at, turned = joints_of(body, now)
    was, _ = joints_of(body, before)
    settle_s = settings.blend.seam_half_life_s / (2.0 * math.log(2.0))
    for side, ankle in enumerate(ANKLES):
        flat = footing.flat_orientation(footing.foot_heading(turned, side))
        height = footing.sole_depth_m(body, side)
        # where a foot that slides on comes to rest, as the seam's decay will take it there
        rest = at[ankle] + (at[ankle] - was[ankle]) / TICK_S * settle_s
        end = foot_plan.Footing(np.array([rest[0], rest[1], height]), np.array(flat), np.array(quaternion.IDENTITY))
        if at[ankle, 2] - height < settings.balance.lift_over_m:
            foot_plan.hold(f, row, side, end)
        else:
            ticks = 0.5 * whole_ticks(settings.recovery.part_one_s)
            start = foot_plan.footing_of(body, now, side)
            foot_plan.step(f, row, side, start, end, tick - 1, ticks, settings.balance)


def move_sustained_over_feet(world, row: int) -> None:
    """Shifts the sustained pose on the ground by as much as the blow has shifted its feet, on average."""
    s, body = world[Sustained], body_of(world, row)
    at, _ = joints_of(body, Pose(s.root_m[row], s.rotations[row]))
    shift = (world[Feet].ankle_m[row] - at[list(ANKLES)]).sum(axis=0) * 0.5
    s.root_m[row, :2] += shift[:2]


def land_first(world, row: int) -> None:
    """Where no foot stands in the clip at re-entry, goes on to its next landing: nobody floats back into a flight."""
    r, timing = world[Reaction], world.assets.settings.timing
    begins_s, longest_s = float(r.clip_s[row]), world.assets.settings.recovery.land_within_s
    for waited in range(whole_ticks(longest_s) + 1):
        if planted_in_clip(world, row, begins_s + waited * TICK_S + timing.sustained_ahead_s).any():
            r.clip_s[row] = begins_s + waited * TICK_S
            return


def plan_return(world, row: int, tick: int, begins: float) -> None:
    """The blend from the sustained pose to the return pose, and the foot that has to step for it."""
    s, b, f, body = world[Sustained], world[Blend], world[Feet], body_of(world, row)
    sustained = Pose(s.root_m[row].copy(), s.rotations[row].copy())
    land_first(world, row)
    support_side = anchor_clip(world, row)
    back_s = return_clip_s(world, row)
    back = clip_pose(world, row, back_s)
    b.from_root_m[row], b.from_rotations[row] = sustained
    b.to_root_m[row], b.to_rotations[row] = back
    b.since[row], b.ticks[row], b.support[row] = round(begins), return_blend_ticks(world), support_side
    b.lead_s[row] = lead_s(world, row, support_side, foot_plan.footing_of(body, back, support_side))
    for side in range(2):
        start, end = foot_plan.planned(f, row, side), foot_plan.footing_of(body, back, side)
        since, ticks = b.since[row], b.ticks[row]
        if f.mode[row, side] == foot_plan.STEPPING:  # in the air still: one step goes all the way back
            start = foot_plan.Footing(
                f.from_m[row, side].copy(), f.from_turned[row, side].copy(), f.from_toe[row, side].copy()
            )
            since, ticks = f.since[row, side], b.since[row] + b.ticks[row] - f.since[row, side]
        balance, lead = world.assets.settings.balance, float(b.lead_s[row])
        foot_plan.hold_or_step(f, row, side, start, end, since, ticks, balance)
        if lead > 0.0:
            if f.mode[row, side] == foot_plan.HELD and not stays(world, row, side, back_s - lead, end):
                foot_plan.step(f, row, side, start, end, since, ticks, balance)
            f.goes_on[row, side] = f.mode[row, side] == foot_plan.STEPPING
    choose_hand_ways(world, row)


def lead_s(world, row: int, side: int, end: foot_plan.Footing) -> float:
    """How much of the clip is played on the way back, up to the return pose: at most what there is of it since the foot
    of the side that supports has come to where it ends, and stands there. One that glides on would slide with it.

    Else one would come to rest in the return pose, on one leg perhaps, before the clip goes on.
    """
    recovery, back_s = world.assets.settings.recovery, return_clip_s(world, row)
    most_s = min(recovery.lead_s, 0.5 * float(world[Blend].ticks[row]) * TICK_S)
    if not clip_of(world, row).loops:
        most_s = min(most_s, back_s)
    ticks = 0
    while (ticks + 1) * TICK_S <= most_s + 1e-9:
        before_s = back_s - (ticks + 1) * TICK_S
        if not stays(world, row, side, before_s, end) or jolts(world, row, before_s + TICK_S):
            break
        ticks += 1
    return ticks * TICK_S


def jolts(world, row: int, time_s: float) -> bool:
    """Whether a clip jumps at a clip time, as recordings do where markers were lost: no pelvis moves like that."""
    before, here, after = (clip_pose(world, row, time_s + k * TICK_S).root_m for k in (-1, 0, 1))
    return vector.length(vector.subtract(before + after, 2.0 * here)) > JOLT_MPS * TICK_S


def stays(world, row: int, side: int, time_s: float, end: foot_plan.Footing) -> bool:
    """Whether a foot is at a clip time already where it ends, but for what a foot that stands moves in a recording."""
    at = foot_plan.footing_of(body_of(world, row), clip_pose(world, row, time_s), side)
    near = vector.distance(at.ankle_m, end.ankle_m) < STAYS_M
    return bool(near and quaternion.angle_between(at.turned, end.turned) < STAYS_RAD)


def anchor_clip(world, row: int) -> int:
    """Shifts and turns the clip's path so that the foot which supports the return pose is where that foot stands now.

    Returns that foot's side.
    """
    f, p, body = world[Feet], world[Playback], body_of(world, row)
    back_s = return_clip_s(world, row)
    back = clip_pose(world, row, back_s)
    at, turned = joints_of(body, back)
    ankles = at[list(ANKLES)]
    side = int(primary_support(planted_in_clip(world, row, back_s), ankles, com_of(body, back)))
    stands_m, stands_turned = f.ankle_m[row, side], f.turned[row, side]
    turn = quaternion.heading(stands_turned) - quaternion.heading(turned[ANKLES[side]])
    turn = (turn + math.pi) % (2.0 * math.pi) - math.pi
    moved = placed(Pose(np.array([*p.place_m[row], 0.0]), back.rotations), (0.0, 0.0), turn, ankles[side])
    p.place_m[row] = moved.root_m[:2] + stands_m[:2] - ankles[side][:2]
    p.heading_rad[row] += turn
    return side


def resume_clip(world, row: int, tick: int) -> None:
    """The clip runs again, from the return pose at the last tick, as fast as it has come to it; the feet go with it."""
    pace = pace_after(float(world[Blend].lead_s[row]), world.assets.settings.recovery.lead_s)
    play_from(world, row, tick - 1, return_clip_s(world, row), pace)
    for side in range(2):
        foot_plan.let_go(world[Feet], row, side)
