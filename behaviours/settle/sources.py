"""Where a character's pose comes from in each phase, before continuity and footing (`behaviours.settle`) have their
say.

One function a source; `source_pose` picks by phase. All are pure in the tick, so a seam can ask a new source where it
was.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.blends.arm_ways import HandWays, straight_ways, swung_ways
from behaviours.blends.blending import BlendEnd, blend_end, blend_into
from behaviours.blends.hand_ways import MOMENTS, choose_ways, let_be, moments_of
from behaviours.blends.held_feet import FootGoals, knees_between
from behaviours.blends.lying import blend_lying
from behaviours.blends.pushed_out import let_lines_be, push_arms_out
from behaviours.components import NOBODY, Blend, Character, Feet, Phase, Posture, Ragdoll, Reaction
from behaviours.playing import body_of, capsules_of, clip_pose, clip_time_s, pace_rise, return_clip_s
from behaviours.settle.feet import footing_of, goals_of
from behaviours.timing import TICK_S, ease, overshoot, whole_ticks
from engine.body.kinematics import joints_into, joints_of
from engine.body.overlap import PAIRS
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, KNEES, TOES, WAIST, Pose
from engine.maths.kernel import njit
from engine.physics import ragdoll

SAME_TURN = 1e-9  # of a quaternion: a toe that is bent as planned, to the last digits
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
    """The same, and how far limits of joints, or the body, keep either hand off its way, metres."""
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
    pushed_m = keep_out(world, row, start, end, weight, ways, pose)
    return pose, (max(led_m[0], pushed_m[0]), max(led_m[1], pushed_m[1]))


def keep_out(world, row, start, end, weight, ways, pose) -> tuple[float, float]:
    """Pushes the arms of a blend's pose out of the body where their ways lead into it, in place. Returns how far that
    moves the hands.
    """
    allowed_m = np.empty(len(PAIRS))
    let_be(start.depths_m, end.depths_m, weight, allowed_m)
    let_lines_be(ways.modes, allowed_m)
    return push_arms_out(body_of(world, row), capsules_of(world, row), allowed_m, *pose)


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
        blend_end(body, shape, *second_end(world, row, tick)),
    )


def second_end(world, row: int, tick: float) -> Pose:
    """Where the present blend leads, at a tick: a still pose; on the way back to a clip, that pose on the pelvis and
    legs of the clip, which is played up to there and comes to its own pace.
    """
    b = world[Blend]
    lead_s = float(b.lead_s[row])
    if lead_s == 0.0:
        return Pose(b.to_root_m[row].copy(), b.to_rotations[row].copy())
    left_s = (float(b.since[row]) + float(b.ticks[row]) - tick) * TICK_S
    rise = pace_rise(world.assets.settings.recovery.lead_s)
    on = clip_pose(world, row, return_clip_s(world, row) - still_to_play_s(left_s, lead_s, rise))
    on.rotations[WAIST : HIPS[0]] = b.to_rotations[row, WAIST : HIPS[0]]
    return on


def still_to_play_s(left_s: float, lead_s: float, rise: float) -> float:
    """How much of a clip is left to be played, of a lead, when so much time is left, seconds: its pace rises evenly
    from none, by `rise` a second, and at the end goes on rising to its own.
    """
    takes_s = math.sqrt(2.0 * lead_s / rise)
    return lead_s - 0.5 * rise * max(0.0, takes_s - left_s) ** 2


def planned_feet(world, row: int, tick: float) -> FootGoals:
    """Where the feet are planned to be at a tick."""
    f = world[Feet]
    if not f.goes_on[row].any():
        return goals_of(f, row, tick)
    body, on = body_of(world, row), second_end(world, row, tick)
    return goals_of(f, row, tick, (footing_of(body, on, 0), footing_of(body, on, 1)))


def flying(world, row: int, tick: float, pose: Pose) -> Pose:
    """A pose on the pelvis and legs that the clip has at a tick, if it plays on."""
    on = clip_pose(world, row, clip_time_s(world, row, tick))
    on.rotations[WAIST : HIPS[0]] = pose.rotations[WAIST : HIPS[0]]
    return on


def ways_of(blend, row: int) -> HandWays:
    """How the hands go in a blend."""
    return HandWays(blend.modes[row], blend.bends[row])


def first_ways_of(blend, row: int) -> HandWays:
    """How they go in part one of recovery."""
    return HandWays(blend.first_modes[row], blend.first_bends[row])


def simulation_into_sustained(world, row: int, tick: float) -> Pose:
    """Recovery, part one: from the running simulation into the sequence of the return blend (thesis 4.1.3)."""
    start, end = ends_of_part_one(world, row, tick, tick)
    part_one = whole_ticks(world.assets.settings.recovery.part_one_s)
    weight = ease((tick - world[Reaction].since[row] + 1) / part_one)
    ways = first_ways_of(world[Blend], row)
    pose = two_sequences(world, row, tick, start, end, weight, ways)
    keep_out(world, row, start, end, weight, ways, pose)
    return pose


def ends_of_part_one(world, row: int, tick: float, later: float) -> tuple[BlendEnd, BlendEnd]:
    """The simulation at one tick, and the return blend at another."""
    body, shape = body_of(world, row), capsules_of(world, row)
    simulated, returning = simulated_pose(world, row, tick), blended_pose(world, row, later)
    return (
        blend_end(body, shape, simulated.root_m, simulated.rotations),
        blend_end(body, shape, returning.root_m, returning.rotations),
    )


def two_sequences(world, row: int, tick: float, start, end, weight: float, ways: HandWays) -> Pose:
    """A weight of the way from the one to the other."""
    return between(
        world, row, tick, start, end, weight, ways, knees_between(start, end, False, world[Blend].knees_m[row])
    )[0]


def between(world, row, tick, start, end, weight, ways, knees) -> tuple[Pose, tuple[float, float]]:
    """A weight of the way from one end to another, on the feet as they are planned for that tick; returns as
    `blended`.
    """
    root_m, rotations = np.empty(3), np.empty((JOINT_COUNT, 4))
    body, support = body_of(world, row), int(world[Blend].support[row])
    if support == NOBODY:
        blend_lying(body, start, end, weight, ways, root_m, rotations)
        return Pose(root_m, rotations), (0.0, 0.0)
    goals = planned_feet(world, row, tick)
    led_m = blend_into(body, start, end, weight, support, goals, ways, knees, root_m, rotations)
    return Pose(root_m, rotations), led_m


def note_knees(world, row: int, tick: int) -> None:
    """Keeps where the knees of the present blend are, for the rule that moves them least from here (thesis 4.3)."""
    if world.assets.settings.blend.knee_rule == "least" and world[Reaction].phase[row] in BLENDING:
        pose = blended_pose(world, row, tick)
        world[Blend].knees_m[row] = joints_of(body_of(world, row), pose)[0][list(KNEES)]


def choose_hand_ways(world, row: int) -> None:
    """Decides, once for the present blend, whose feet are planned, how each hand goes (`blends.hand_ways`)."""
    b, body = world[Blend], body_of(world, row)
    b.knees_m[row] = joints_of(body, Pose(b.from_root_m[row], b.from_rotations[row]))[0][list(KNEES)]
    # of bodies that lie, arms are swung: nobody's hands go straight lines under them
    ways = swung_ways() if b.support[row] == NOBODY else straight_ways()
    start, end = blend_ends(world, row, b.since[row])[0], blend_ends(world, row, b.since[row] + b.ticks[row])[1]
    progress, between_them = np.linspace(0.0, 1.0, MOMENTS), []
    for u in progress:
        at = b.since[row] + u * b.ticks[row]
        then = blend_ends(world, row, at)[1] if b.lead_s[row] > 0.0 else end
        knees = knees_between(start, then, False, b.knees_m[row])
        between_them.append(between(world, row, at, start, then, ease(u), ways, knees)[0])
    shape = capsules_of(world, row)
    choose_ways(body, shape, start, end, moments_of(body, shape, start, end, progress, between_them), ways)
    b.modes[row], b.bends[row] = ways


def choose_first_ways(world, row: int, tick: int) -> None:
    """Likewise for part one of recovery, which begins at a tick, as if the simulation stood still and the return blend
    were where it will be at its end: evenly, unless that leads into the body.
    """
    b, body, shape = world[Blend], body_of(world, row), capsules_of(world, row)
    ticks = whole_ticks(world.assets.settings.recovery.part_one_s)
    start, end = ends_of_part_one(world, row, tick - 1, tick - 1 + ticks)
    progress, ways = np.linspace(0.0, 1.0, MOMENTS), swung_ways()
    poses = [two_sequences(world, row, tick - 1 + u * ticks, start, end, ease(u), ways) for u in progress]
    choose_ways(body, shape, start, end, moments_of(body, shape, start, end, progress, poses), ways)
    b.first_modes[row], b.first_bends[row] = ways


def foot_goals(world, row: int, tick: float, source: Pose) -> FootGoals:
    """Where both ankles are to be: by the plan where a foot stands, else where the source has them: a foot in the air
    may be behind its plan, as far as leg and ankle go, and one that stands may be on its toes.
    """
    goals = planned_feet(world, row, tick)
    goals_over(body_of(world, row), *source, *goals)
    return goals


@njit(cache=True)
def goals_over(body, root_m, rotations, ankle_m, turned, toe, bound, bears):
    """Goals of both feet, `held_feet.FootGoals`, given up for a pose's own where that leaves them, in place."""
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    for side in range(2):
        ankle, bent, rolled = ANKLES[side], TOES[side], 0.0
        for k in range(4):
            rolled = max(rolled, abs(rotations[bent, k] - toe[side, k]))
        if not bound[side] or bears[side] < 1.0 or rolled > SAME_TURN:
            for k in range(3):
                ankle_m[side, k] = positions[ankle, k]
            for k in range(4):
                turned[side, k], toe[side, k] = orientations[ankle, k], rotations[bent, k]
        bound[side] = True
