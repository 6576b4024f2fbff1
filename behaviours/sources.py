"""Where a character's pose comes from in each phase, before continuity and footing (`behaviours.settle`) have their
say.

One function a source; `source_pose` picks by phase. All are pure in the tick, so a seam can ask a new source where it
was.
"""

from __future__ import annotations

import numpy as np

from behaviours.arm_ways import SWUNG, HandWays, straight_ways, swung_ways
from behaviours.blending import BlendEnd, blend_end, blend_into
from behaviours.components import NOBODY, Blend, Character, Feet, Phase, Posture, Ragdoll, Reaction
from behaviours.feet import goals_of
from behaviours.hand_ways import MOMENTS, choose_ways, let_be, moments_of
from behaviours.held_feet import FootGoals, knees_between
from behaviours.lying import blend_lying
from behaviours.overlap import PAIRS
from behaviours.playing import body_of, capsules_of, clip_pose, clip_time_s
from behaviours.pushed_out import push_arms_out
from behaviours.timing import TICK_S, ease, overshoot, whole_ticks
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, KNEES, TOES, WAIST, Pose
from engine.physics import ragdoll

ANKLE_ROWS, TOE_ROWS = list(ANKLES), list(TOES)
BLENDING = (Phase.STARTLE, Phase.PROTECT, Phase.HOLD, Phase.RECOVER_BLEND, Phase.RECOVER_RETURN)
PAUSING = (Phase.PROTECT, Phase.HOLD)  # the pose is there, the ball is not


def source_pose(world, row: int, tick: float) -> Pose:
    """The pose that the present phase asks for at a tick, whole or not. World; a copy."""
    phase = world[Reaction].phase[row]
    if phase == Phase.STOPPED:
        p = world[Posture]
        return Pose(p.root_m[row].copy(), p.rotations[row].copy())
    if phase == Phase.PLAY:
        return clip_pose(world, row, clip_time_s(world, row, tick))
    if phase in (Phase.RESPOND, Phase.DOWN):
        return simulated_pose(world, row, tick)
    if phase == Phase.RECOVER_BLEND:
        return simulation_into_sustained(world, row, tick)
    return blended_pose(world, row, tick)


def simulated_pose(world, row: int, tick: float) -> Pose:
    """The physics' pose; between its last two ticks, the nearer one's carried there by its velocities."""
    doll = world[Ragdoll]
    model = world.assets.models[int(world[Character].body[row])]
    since = float(tick - doll.stepped[row])
    if since < -0.5:
        return ragdoll.carried_on(model, doll.before[row], (since + 1.0) * TICK_S)
    return ragdoll.carried_on(model, doll.state[row], since * TICK_S)


def blended_pose(world, row: int, tick: float) -> Pose:
    """Between the two still ends of the present blend, at its clock (thesis 4.3)."""
    return blended(world, row, tick)[0]


def blended(world, row: int, tick: float) -> tuple[Pose, tuple[float, float]]:
    """The same, and how far its joints' limits keep either hand off its way, metres."""
    weight = ease((tick - world[Blend].since[row]) / world[Blend].ticks[row])
    if world[Reaction].phase[row] in PAUSING:
        after_s = float(tick - world[Blend].since[row] - world[Blend].ticks[row]) * TICK_S
        s = world.assets.settings.blend
        weight += overshoot(after_s, s.overshoot_share, s.overshoot_period_s, s.overshoot_half_life_s)
    start, end = blend_ends(world, row, tick)
    least = world.assets.settings.blend.knee_rule == "least"
    knees = knees_between(start, end, least, world[Blend].knees_m[row])
    ways = ways_of(world[Blend], row)
    pose, led_m = between(world, row, tick, start, end, weight, ways, knees)
    clear_swung_arms(world, row, start, end, weight, ways, pose)
    return pose, led_m


def clear_swung_arms(world, row, start, end, weight, ways, pose) -> None:
    """Pushes arms that are swung, and have no line to keep to, out of the body where their way leads into it."""
    if (ways.modes == SWUNG).any():
        allowed_m = np.empty(len(PAIRS))
        let_be(start.depths_m, end.depths_m, weight, allowed_m)
        push_arms_out(body_of(world, row), capsules_of(world, row), allowed_m, ways.modes == SWUNG, *pose)


def blend_ends(world, row: int, tick: float) -> tuple[BlendEnd, BlendEnd]:
    """The two ends of the present blend, as they are at a tick: still, but for somebody who protects in flight, whose
    first end flies on until it lands.
    """
    b = world[Blend]
    body, shape = body_of(world, row), capsules_of(world, row)
    first = Pose(b.from_root_m[row].copy(), b.from_rotations[row].copy())
    if world[Reaction].phase[row] == Phase.PROTECT and tick < b.lands[row]:
        first = flying(world, row, tick, first)
    return (
        blend_end(body, shape, first.root_m, first.rotations),
        blend_end(body, shape, b.to_root_m[row].copy(), b.to_rotations[row].copy()),
    )


def flying(world, row: int, tick: float, pose: Pose) -> Pose:
    """A pose on the pelvis and legs that the clip has at a tick, if it plays on."""
    on = clip_pose(world, row, clip_time_s(world, row, tick))
    on.rotations[WAIST : HIPS[0]] = pose.rotations[WAIST : HIPS[0]]
    return on


def ways_of(blend, row: int) -> HandWays:
    """How the hands go in a blend."""
    return HandWays(blend.modes[row], blend.bends[row])


def simulation_into_sustained(world, row: int, tick: float) -> Pose:
    """Recovery, part one: from the running simulation into the sequence of the return blend (thesis 4.1.3)."""
    body, shape = body_of(world, row), capsules_of(world, row)
    simulated, returning = simulated_pose(world, row, tick), blended_pose(world, row, tick)
    part_one = whole_ticks(world.assets.settings.recovery.part_one_s)
    weight = ease((tick - world[Reaction].since[row] + 1) / part_one)
    start = blend_end(body, shape, simulated.root_m, simulated.rotations)
    end = blend_end(body, shape, returning.root_m, returning.rotations)
    knees = knees_between(start, end, False, world[Blend].knees_m[row])
    pose = between(world, row, tick, start, end, weight, swung_ways(), knees)[0]
    clear_swung_arms(world, row, start, end, weight, swung_ways(), pose)
    return pose


def between(world, row, tick, start, end, weight, ways, knees) -> tuple[Pose, tuple[float, float]]:
    """A weight of the way from one end to another, on the feet as they are planned for that tick; returns as
    `blended`.
    """
    root_m, rotations = np.empty(3), np.empty((JOINT_COUNT, 4))
    body, support = body_of(world, row), int(world[Blend].support[row])
    if support == NOBODY:
        blend_lying(body, start, end, weight, root_m, rotations)
        return Pose(root_m, rotations), (0.0, 0.0)
    goals = goals_of(world[Feet], row, tick)
    led_m = blend_into(body, start, end, weight, support, goals, ways, knees, root_m, rotations)
    return Pose(root_m, rotations), led_m


def note_knees(world, row: int, tick: int) -> None:
    """Keeps where the knees of the present blend are, for the rule that moves them least from here (thesis 4.3)."""
    if world.assets.settings.blend.knee_rule == "least" and world[Reaction].phase[row] in BLENDING:
        pose = blended_pose(world, row, tick)
        world[Blend].knees_m[row] = joints_of(body_of(world, row), pose)[0][list(KNEES)]


def choose_hand_ways(world, row: int) -> None:
    """Decides, once for the present blend, whose feet are planned, how each hand goes (`behaviours.hand_ways`)."""
    b, body = world[Blend], body_of(world, row)
    b.modes[row], b.bends[row] = straight_ways()
    b.knees_m[row] = joints_of(body, Pose(b.from_root_m[row], b.from_rotations[row]))[0][list(KNEES)]
    if b.support[row] == NOBODY:
        return  # both ends lie
    start, end = blend_ends(world, row, b.since[row])
    progress = np.linspace(0.0, 1.0, MOMENTS)
    between_them = [
        between(
            world, row, b.since[row] + u * b.ticks[row], start, end, ease(u), straight_ways(),
            knees_between(start, end, False, b.knees_m[row]),
        )[0]
        for u in progress
    ]  # fmt: skip
    ways = straight_ways()
    shape = capsules_of(world, row)
    choose_ways(body, shape, start, end, moments_of(body, shape, start, end, progress, between_them), ways)
    b.modes[row], b.bends[row] = ways


def foot_goals(world, row: int, tick: float, source: Pose) -> FootGoals:
    """Where both ankles are to be: by the plan where a foot stands, else where the source has them: a foot in the air
    may be behind its plan, as far as leg and ankle go.
    """
    planned = goals_of(world[Feet], row, tick)
    positions, orientations = joints_of(body_of(world, row), source)
    loose = (~planned.bound | (planned.bears < 1.0))[:, None]
    return FootGoals(
        np.where(loose, positions[ANKLE_ROWS], planned.ankle_m),
        np.where(loose, orientations[ANKLE_ROWS], planned.turned),
        np.where(loose, source.rotations[TOE_ROWS], planned.toe),
        np.ones(2, bool),
        planned.bears,
    )
