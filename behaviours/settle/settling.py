"""What is shown: the source of the present phase, what is left of the last seam on top, the feet where they have to
be.
"""

from __future__ import annotations

import math

import numpy as np

from behaviours.blends.arm_ways import yielding
from behaviours.blends.held_feet import legs_to, lengths_left
from behaviours.blends.leg_limits import EARLY_RAD
from behaviours.blends.pushed_out import keep_arms_out
from behaviours.components import (
    Blend,
    Blow,
    Character,
    Feet,
    Phase,
    Playback,
    Posture,
    Ragdoll,
    Reaction,
    Residual,
    Sustained,
)
from behaviours.playing import body_of, capsules_of, clip_time_s, planted_in_clip
from behaviours.settle import feet as foot_plan
from behaviours.settle import seams
from behaviours.settle.inertialise import add_remaining, nothing_left, remaining, turned_by
from behaviours.settle.settled_legs import Footing, stand
from behaviours.settle.sources import foot_goals, note_knees, source_pose
from engine.body.kinematics import joints_into
from engine.body.limits import components, from_components
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, KNEES, PELVIS
from engine.core.schedule import Stage, system
from engine.maths import quaternion, springs, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

BELONGINGS = (Ragdoll, Blow, Residual, Blend, Feet, Sustained, Playback)  # what a pose is made from
# of the residual's half-life: how long what the old motion had beyond a limit, or inside the body, is let be
OLD_SHARE = 0.5
PASSES_RAD = math.radians(0.15)


@njit(cache=True)
def goals_with_residual(ankle_m, turned, ankles, ankle_turns, elapsed_s, half_life_s):
    """Moves both feet's goals by what is left of the last seam, in place: (2, 3), (2, 4), offsets (2, 2, 3)."""
    for side in range(2):
        r = remaining(ankles[0, side], ankles[1, side], elapsed_s, half_life_s)
        q = turned_by(turned[side], remaining(ankle_turns[0, side], ankle_turns[1, side], elapsed_s, half_life_s))
        for k in range(3):
            ankle_m[side, k] += r[k]
        for k in range(4):
            turned[side, k] = q[k]


@njit(cache=True)
def beyond_left(beyond, elapsed_s, half_life_s):
    """What is left of how far the old motion was beyond its limits, (J, 3), of that and its velocity, (2, J, 3).

    It dies away; but where the old motion is on its way out, it goes on at its speed for a hair, PASSES_RAD at most:
    else what keeps it within the limit would move at once, as fast as it.
    """
    left = springs.decaying(1.0, 0.0, half_life_s, elapsed_s)[0] * beyond[0]
    for j in range(JOINT_COUNT):
        for k in range(3):
            if beyond[0, j, k] * beyond[1, j, k] > 0.0:
                x = abs(beyond[1, j, k]) * max(elapsed_s, 0.0) / (math.e * PASSES_RAD)
                left[j, k] += math.copysign(PASSES_RAD * x * math.exp(1.0 - x), beyond[0, j, k])
    return left


@njit(cache=True)
def keep_joints(body, source, beyond, rotations):
    """Keeps a residual (in a pose (J, 4)) from taking head, trunk, arms and knees beyond their limits. In place.

    Beyond them is let be what the source (J, 4) itself is, and what is left of how far the old motion was: beyond (J,
    3), counted from limits drawn in by EARLY_RAD, radians, negative below.
    """
    for j in range(HIPS[0]):
        if j != PELVIS:
            keep_joint(body, j, source, beyond, 1.0, rotations)
    for j in KNEES:
        keep_joint(body, j, source, beyond, 1.0, rotations)


@njit(cache=True)
def keep_swinging_legs(body, source, beyond, bears, rotations):
    """Likewise hips and ankles, in so far as their foot bears nothing: one in the air may be where the leg goes. In
    place.
    """
    for side in range(2):
        if bears[side] < 1.0:
            for j in (HIPS[side], ANKLES[side]):
                keep_joint(body, j, source, beyond, 1.0 - bears[side], rotations)


@inner_kernel
def keep_joint(body, j, source, beyond, share, rotations):
    """One joint of those, drawn in by a share of what is too much. In place."""
    a, c = components(source[j]), components(rotations[j])
    low, high, old = vector.at(body.limit_low_rad, j), vector.at(body.limit_high_rad, j), vector.at(beyond, j)
    x = c[0] + share * (drawn_in(low[0], high[0], a[0], old[0], c[0]) - c[0])
    y = c[1] + share * (drawn_in(low[1], high[1], a[1], old[1], c[1]) - c[1])
    z = c[2] + share * (drawn_in(low[2], high[2], a[2], old[2], c[2]) - c[2])
    if x != c[0] or y != c[1] or z != c[2]:
        quaternion.put(rotations, j, from_components(x, y, z))


@inner_kernel
def drawn_in(low, high, own, old, value):
    """A component, gently, within its limits, or at least no farther out than its own or than it was; radians."""
    most, least = high + max(old - EARLY_RAD, 0.0), low + min(old + EARLY_RAD, 0.0)
    over = max(value - max(most, own), 0.0) + min(value - min(least, own), 0.0)
    return value - over + yielding(over)


@system(
    Stage.SETTLE,
    reads=(Playback, Posture, Character, Reaction, Blend, Blow, Ragdoll, Feet, Residual, Sustained),
    writes=(Posture, Feet, Reaction, Ragdoll, Residual, Blend),
)
def settle_poses(world, tick):
    """Every character's pose of this tick."""
    p = world[Posture]
    rows = world.rows(Posture, Reaction)
    foot_plan.land_finished_steps(world[Feet], rows, tick)
    for row in rows:
        root_m, rotations = settled_pose(world, int(row), tick)
        if not (np.isfinite(root_m).all() and np.isfinite(rotations).all()):
            stop(world, int(row), tick)
            root_m, rotations = p.root_m[row].copy(), p.rotations[row].copy()
        p.before_root_m[row], p.before_rotations[row] = p.root_m[row], p.rotations[row]
        p.root_m[row], p.rotations[row] = root_m, rotations
        world[Feet].planted[row] = standing_feet(world, int(row), tick)
        note_knees(world, int(row), tick)


def stop(world, row: int, tick: int) -> None:
    """Stops a character whose state is no number any more, as it last was; says which field it was, and when."""
    world[Reaction].phase[row], world[Reaction].since[row] = Phase.STOPPED, tick
    component, field = next(
        (
            (component.__name__, field)
            for component in BELONGINGS
            for field in component.columns
            if not np.isfinite(getattr(world[component], field)[row]).all()
        ),
        ("Posture", "rotations"),
    )
    world.emit("stopped", world.entity(row), component=component, field=field)
    world[Ragdoll].active[row] = False
    nothing_left(world[Residual], row)
    for side in range(2):
        foot_plan.let_go(world[Feet], row, side)


def settled_pose(world, row: int, tick: float) -> tuple[np.ndarray, np.ndarray]:
    """(3,) and (J, 4): the pose to show. Also between ticks, in the present phase."""
    r, half_life_s = world[Residual], world.assets.settings.blend.seam_half_life_s
    source = source_pose(world, row, tick)
    phase = world[Reaction].phase[row]
    calm = seams.is_over(world, row, tick, half_life_s)
    if phase == Phase.STOPPED or (calm and phase in (Phase.PLAY, Phase.RESPOND, Phase.DOWN)):
        return source.root_m, source.rotations
    goals = foot_goals(world, row, tick, source)
    elapsed_s, body = seams.elapsed_s(world, row, tick), body_of(world, row)
    in_source_m = legs_to(body, source.root_m, source.rotations, goals.ankle_m)
    own_lengths = lengths_left(body, in_source_m, r.stretch[row], elapsed_s, half_life_s)
    unaltered, unaltered_m = source.rotations.copy(), source.root_m.copy()
    add_remaining(source.root_m, source.rotations, r.root[row], r.joints[row], elapsed_s, half_life_s)
    old_s = OLD_SHARE * half_life_s
    beyond = beyond_left(r.beyond[row], elapsed_s, old_s)
    keep_joints(body, unaltered, beyond, source.rotations)
    keep_arms_out(
        body, capsules_of(world, row), unaltered, r.deeper_m[row], elapsed_s, old_s, source.root_m, source.rotations
    )
    goals_with_residual(goals.ankle_m, goals.turned, r.ankles[row], r.ankle_turns[row], elapsed_s, half_life_s)
    footing = Footing(unaltered_m, unaltered, beyond, goals.ankle_m, goals.turned, goals.bears, own_lengths)
    stand(body, footing, source.root_m, source.rotations)
    keep_swinging_legs(body, unaltered, beyond, goals.bears, source.rotations)
    return source.root_m, source.rotations


def standing_feet(world, row: int, tick: int) -> list[bool]:
    """Left, right: which feet stand now and may not slide."""
    phase = world[Reaction].phase[row]
    if phase == Phase.PLAY:
        return list(planted_in_clip(world, row, clip_time_s(world, row, tick)))
    if phase in (Phase.RESPOND, Phase.DOWN):
        return [False, False]
    half_life_s = world.assets.settings.blend.seam_half_life_s
    stand = [
        foot_plan.stands(world[Feet], row, side, tick) and seams.foot_is_still(world, row, side, tick, half_life_s)
        for side in range(2)
    ]
    if not any(stand):
        return stand
    return [stands and flat for stands, flat in zip(stand, flat_feet(world, row, tick), strict=True)]


def flat_feet(world, row: int, tick: int) -> tuple[bool, bool]:
    """Which feet are shown where they are planned, and not on their toes."""
    p, goals = world[Posture], foot_plan.goals_of(world[Feet], row, tick)
    left_m, right_m = ankles_off_m(body_of(world, row), p.root_m[row], p.rotations[row], goals.ankle_m)
    return left_m < seams.STILL_FOOT_M, right_m < seams.STILL_FOOT_M


@njit(cache=True)
def ankles_off_m(body, root_m, rotations, goals_m):
    """How far a pose's ankles are from their goals (2, 3), metres, left and right."""
    positions, orientations = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 4))
    joints_into(body.offset_m, root_m, rotations, positions, orientations)
    left, right = vector.at(positions, ANKLES[0]), vector.at(positions, ANKLES[1])
    return vector.distance(left, vector.at(goals_m, 0)), vector.distance(right, vector.at(goals_m, 1))
