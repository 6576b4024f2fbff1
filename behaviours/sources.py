"""Where a character's pose comes from in each phase, before continuity and footing (`behaviours.settle`) have their
say.

One function a source; `source_pose` picks by phase. All are pure in the tick, so a seam can ask a new source where it
was.
"""

from __future__ import annotations

import numpy as np

from behaviours.blending import blend_end, blend_into
from behaviours.components import NOBODY, Blend, Character, Feet, Phase, Posture, Ragdoll, Reaction
from behaviours.feet import goals_of
from behaviours.hand_ways import choose_arcs
from behaviours.held_feet import FootGoals
from behaviours.lying import blend_lying
from behaviours.playing import body_of, capsules_of, clip_pose, clip_time_s
from behaviours.timing import TICK_S, ease, overshoot, whole_ticks
from engine.body.kinematics import joints_of
from engine.body.skeleton import ANKLES, JOINT_COUNT, TOES, Pose
from engine.physics import ragdoll

ANKLE_ROWS, TOE_ROWS = list(ANKLES), list(TOES)
STRAIGHT = np.zeros((2, 2))
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
    """The same, and how far its hands were led off their straight lines to go round the body, metres."""
    b = world[Blend]
    body, shape = body_of(world, row), capsules_of(world, row)
    start = blend_end(body, shape, b.from_root_m[row].copy(), b.from_rotations[row].copy())
    end = blend_end(body, shape, b.to_root_m[row].copy(), b.to_rotations[row].copy())
    weight = ease((tick - b.since[row]) / b.ticks[row])
    if world[Reaction].phase[row] in PAUSING:
        after_s = float(tick - b.since[row] - b.ticks[row]) * TICK_S
        s = world.assets.settings.blend
        weight += overshoot(after_s, s.overshoot_share, s.overshoot_period_s, s.overshoot_half_life_s)
    return _between(world, row, tick, start, end, weight, b.arcs[row])


def simulation_into_sustained(world, row: int, tick: float) -> Pose:
    """Recovery, part one: from the running simulation into the sequence of the return blend (thesis 4.1.3)."""
    body, shape = body_of(world, row), capsules_of(world, row)
    simulated, returning = simulated_pose(world, row, tick), blended_pose(world, row, tick)
    part_one = whole_ticks(world.assets.settings.recovery.part_one_s)
    weight = ease((tick - world[Reaction].since[row] + 1) / part_one)
    start = blend_end(body, shape, simulated.root_m, simulated.rotations)
    end = blend_end(body, shape, returning.root_m, returning.rotations)
    return _between(world, row, tick, start, end, weight, STRAIGHT)[0]


def _between(world, row, tick, start, end, weight, arcs) -> tuple[Pose, tuple[float, float]]:
    root_m, rotations = np.empty(3), np.empty((JOINT_COUNT, 4))
    goals, support = goals_of(world[Feet], row, tick), int(world[Blend].support[row])
    if support == NOBODY:
        blend_lying(body_of(world, row), start, end, weight, root_m, rotations)
        return Pose(root_m, rotations), (0.0, 0.0)
    body, shape = body_of(world, row), capsules_of(world, row)
    led_m = blend_into(body, shape, start, end, weight, support, goals, arcs, root_m, rotations)
    return Pose(root_m, rotations), led_m


def choose_hand_ways(world, row: int, start: Pose, end: Pose) -> None:
    """Decides, once for a blend, how each hand goes from end to end; see `behaviours.hand_ways.choose_arcs`."""
    body, shape, b = body_of(world, row), capsules_of(world, row), world[Blend]
    b.arcs[row] = STRAIGHT
    if b.support[row] == NOBODY:
        return  # both ends lie
    goals = FootGoals(np.zeros((2, 3)), np.zeros((2, 4)), np.zeros((2, 4)), np.zeros(2, bool), np.zeros(2))
    first, last = blend_end(body, shape, *start), blend_end(body, shape, *end)
    b.arcs[row] = choose_arcs(body, shape, first, last, int(b.support[row]), goals)


def foot_goals(world, row: int, tick: float, source: Pose) -> FootGoals:
    """Where both ankles are to be: by the plan where a foot is held or steps, else where the source has them."""
    planned = goals_of(world[Feet], row, tick)
    positions, orientations = joints_of(body_of(world, row), source)
    free = ~planned.bound[:, None]
    return FootGoals(
        np.where(free, positions[ANKLE_ROWS], planned.ankle_m),
        np.where(free, orientations[ANKLE_ROWS], planned.turned),
        np.where(free, source.rotations[TOE_ROWS], planned.toe),
        np.ones(2, bool),
        planned.bears,
    )
