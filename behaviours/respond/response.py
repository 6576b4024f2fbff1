"""The dynamic response (thesis 4.1.2, after Zordan et al. 2005): the body under physics.

From contact on (`behaviours.respond.contact`) a rigid articulated body takes over in the pose and with the velocities
it has, pulled towards the sustained pose.
"""

from __future__ import annotations

import numpy as np

from behaviours.components import (
    Blow,
    Character,
    Feet,
    Flight,
    Phase,
    Ragdoll,
    Reaction,
    Residual,
    Struck,
    Sustained,
)
from behaviours.phases import enter
from behaviours.playing import perception_clip_s
from behaviours.recover.search import begin_remembering, remember
from behaviours.respond.arriving import arriving, begin_arriving
from behaviours.respond.blow import carry_ball, deal_blow
from behaviours.respond.falling import held_pose
from behaviours.respond.knocked_down import begin_reeling
from behaviours.settle import feet as foot_plan
from behaviours.settle.inertialise import nothing_left
from behaviours.settle.seams import MOMENT, shown
from behaviours.settle.settling import settled_pose
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.body.skeleton import HEAD, JOINT_COUNT, Pose
from engine.core.schedule import Stage, system
from engine.physics import ragdoll, sunk
from engine.physics.layout import SUB_STEPS

GUARDED = (Phase.STARTLE, Phase.PROTECT, Phase.HOLD)  # in these the sustained pose is what the servos hold


@system(
    Stage.SIMULATE,
    reads=(Character, Reaction, Sustained, Ragdoll, Struck, Blow, Flight),
    writes=(Ragdoll, Struck, Blow, Flight),
)
def step_bodies(world, tick):
    """Whoever was struck is stepped by the physics, tracked towards the sustained pose; blows under way are dealt."""
    response = world.assets.settings.response
    doll = world[Ragdoll]
    for row in world.rows(Ragdoll, Character):
        if not doll.active[row]:
            continue
        model = world.assets.models[int(world[Character].body[row])]
        pushes, trace = deal_blow(world, row), np.empty((SUB_STEPS, JOINT_COUNT, 3))
        held, share = held_pose(world, row, ragdoll.pose_of(model, doll.state[row]))
        doll.before[row] = doll.state[row]
        doll.state[row] = ragdoll.step(
            model,
            doll.state[row],
            arriving(world, row, tick, held),
            response.stiffness * share,
            response.damping,
            TICK_S,
            pushes,
            trace,
            target_before=arriving(world, row, tick - 1, held),
            carries=0.0 if world[Reaction].phase[row] == Phase.DOWN else 1.0,
            sunk_m=doll.sunk_m[row],
        )
        doll.sunk_m[row] = sunk.risen(model, doll.state[row], doll.sunk_m[row], TICK_S)
        doll.head_mps[row] = trace[:, HEAD]
        doll.stepped[row] = tick
        remember(world, row, joints_of(model.body, ragdoll.pose_of(model, doll.state[row]))[0])
        carry_ball(world, row, model)


def moving_state(world, row: int, tick: int, model) -> np.ndarray:
    """The physics' state of a body that is as it is shown, and moves as it does."""
    before = Pose(*settled_pose(world, row, tick - MOMENT))
    return ragdoll.start(model, shown(world, row)[0], before, MOMENT * TICK_S)


def begin_response(world, row: int, tick: int, state: np.ndarray) -> None:
    """The physics takes over, as the body is and moves. Unprepared, it tries to keep the pose it was struck in."""
    r, s = world[Reaction], world[Sustained]
    now, _ = shown(world, row)
    if r.phase[row] not in GUARDED:
        r.clip_s[row] = perception_clip_s(world, row, tick)
        s.root_m[row], s.rotations[row] = now
        r.contact[row] = tick
    world[Ragdoll].state[row], world[Ragdoll].before[row] = state, state
    model = world.assets.models[int(world[Character].body[row])]
    begin_arriving(world, row, tick)
    world[Ragdoll].sunk_m[row] = sunk.depths_m(model, state)
    world[Ragdoll].head_mps[row] = ragdoll.part_motion_of(model, state)[HEAD]
    world[Ragdoll].stepped[row], world[Ragdoll].active[row] = tick, True
    begin_remembering(world, row, joints_of(model.body, now)[0])
    begin_reeling(world, row, ragdoll.com_velocity_of(model, state))
    for side in range(2):
        foot_plan.let_go(world[Feet], row, side)
    nothing_left(world[Residual], row)
    r.struck[row] = True
    enter(world, row, tick, Phase.RESPOND)
