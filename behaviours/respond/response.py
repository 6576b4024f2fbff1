"""The dynamic response (thesis 4.1.2, after Zordan et al. 2005): contact, the blow, and the body under physics.

Contact is a matter of geometry, never of the predicted time: the ball is swept against the body's capsules between
two ticks. From then on a rigid articulated body takes over in the pose and with the velocities it has, pulled towards
the sustained pose.
"""

from __future__ import annotations

import numpy as np

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
from behaviours.phases import enter
from behaviours.playing import body_of, perception_clip_s
from behaviours.recover.search import begin_remembering, remember
from behaviours.respond.arriving import arriving, begin_arriving
from behaviours.respond.falling import held_pose
from behaviours.respond.knocked_down import begin_reeling
from behaviours.settle import feet as foot_plan
from behaviours.settle.inertialise import nothing_left
from behaviours.settle.seams import MOMENT, shown
from behaviours.settle.settling import settled_pose
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.body.skeleton import HEAD, JOINT_COUNT, JOINTS, Pose
from engine.core.schedule import Stage, system
from engine.maths import quaternion, vector
from engine.physics import impact, ragdoll, sunk
from engine.physics.layout import SUB_STEPS

GUARDED = (Phase.STARTLE, Phase.PROTECT, Phase.HOLD)  # in these the sustained pose is what the servos hold
WORTH_SAYING_MPS = 0.5  # a ball that lies on somebody touches anew each tick: no event
NEAR_M = 1.5  # a ball farther from the pelvis than its own size plus this meets nobody


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


def deal_blow(world, row: int) -> tuple[ragdoll.Push, ...]:
    """The body's side of the blow under way, and this tick's share of it to the ball."""
    b = world[Blow]
    b.elapsed_s[row] += TICK_S
    if b.ball[row] == NOBODY:
        return ()
    push = ragdoll.Push(
        int(b.joint[row]),
        b.place_m[row].copy(),
        b.impulse_Ns[row].copy(),
        float(b.elapsed_s[row] - TICK_S),
        float(b.lasts_s[row]),
    )
    if world.alive(int(b.ball[row])):
        share = ragdoll.share_in(push, push.since_s, push.since_s + TICK_S)
        f, ball = world[Flight], world.row(int(b.ball[row]))
        f.velocity_mps[ball] -= share * push.impulse_Ns / f.mass_kg[ball]
        f.spin_radps[ball] += share * b.turning_Nms[row] / (impact.HOLLOW * f.mass_kg[ball] * f.radius_m[ball] ** 2)
    return (push,)


def carry_ball(world, row: int, model) -> None:
    """While it presses, the ball goes no farther than the place it touches, but may slide along; then it is free."""
    b, f = world[Blow], world[Flight]
    if b.ball[row] == NOBODY:
        return
    if world.alive(int(b.ball[row])):
        ball = world.row(int(b.ball[row]))
        positions, orientations = joints_of(body_of(world, row), ragdoll.pose_of(model, world[Ragdoll].state[row]))
        joint = int(b.joint[row])
        touch = vector.add(positions[joint], quaternion.rotate(orientations[joint], b.place_m[row]))
        keep_out(world, ball, touch, b.normal[row])
        f.held[ball] = b.elapsed_s[row] < b.lasts_s[row]
    if b.elapsed_s[row] >= b.lasts_s[row]:
        b.ball[row] = NOBODY


@system(
    Stage.SETTLE,
    reads=(
        Posture,
        Character,
        Flight,
        Reaction,
        Playback,
        Ragdoll,
        Struck,
        Blow,
        Sustained,
        Feet,
        Residual,
        Threat,
        Blend,
    ),
    writes=(Reaction, Ragdoll, Struck, Blow, Sustained, Feet, Residual, Flight, Threat),
)
def meet_balls(world, tick):
    """Every ball against every body, between the last tick and this one."""
    f, p = world[Flight], world[Posture]
    for ball in world.rows(Flight):
        for row in world.rows(Posture, Character):
            reach_m = f.radius_m[ball] + NEAR_M + vector.distance(f.before_m[ball], f.position_m[ball])
            if (
                world[Reaction].phase[row] == Phase.STOPPED
                or vector.distance(f.position_m[ball], p.root_m[row]) > reach_m
            ):
                continue
            presses = f.held[ball] and world[Blow].ball[row] == world.entity(ball)
            now, before = shown(world, row)
            body = body_of(world, row)
            hit = impact.first_hit(
                world.assets.capsules[int(world[Character].body[row])],
                joints_of(body, before),
                joints_of(body, now),
                f.before_m[ball],
                f.position_m[ball],
                float(f.radius_m[ball]),
                int(world[Blow].joint[row]) if presses else NOBODY,
            )
            if hit is not None:
                strike(world, int(row), int(ball), hit, tick)


def strike(world, row: int, ball: int, hit: impact.Hit, tick: int) -> None:
    """A contact: the impulse, what it does to the ball, and, unless it is a mere touch, to the body."""
    response = world.assets.settings.response
    model = world.assets.models[int(world[Character].body[row])]
    if world[Blow].ball[row] == world.entity(ball):
        finish_blow(world, row, ball, model)
    simulated = world[Ragdoll].active[row] and world[Reaction].phase[row] in (Phase.RESPOND, Phase.DOWN)
    state = world[Ragdoll].state[row] if simulated else moving_state(world, row, tick, model)
    touch_m = place_in_world(world, row, hit)
    thrown = ball_at(world, ball, touch_m, hit.normal)
    material = impact.Material(response.restitution, response.friction)
    impulse = impact.exchange(model, state, thrown, hit, material)
    if impulse is None:
        return
    size_Ns = vector.length(impulse.impulse_Ns)
    # whoever walks or gets up into a ball that lies there pushes it: only a ball that comes moves anybody
    comes_mps = -vector.inner(thrown.velocity_mps, hit.normal)
    hard = size_Ns >= response.least_Ns and (simulated or comes_mps >= response.least_mps)
    at_s = (tick - 1 + hit.share) * TICK_S
    if impulse.approach_mps >= WORTH_SAYING_MPS:
        world.emit(
            "contact" if hard else "touch",
            world.entity(row),
            at_s=at_s,
            ball=world.entity(ball),
            part=hit.part,
            joint=JOINTS[hit.joint],
            impulse_Ns=size_Ns,
            approach_mps=impulse.approach_mps,
            late_s=lateness_s(world, row, ball, at_s, hit),
        )
    world[Threat].spent[ball] = True
    keep_out(world, ball, touch_m, hit.normal)
    if not hard:
        turn_ball(world, ball, impact.ball_after(thrown, impulse))
        return
    if not simulated:
        begin_response(world, row, tick, state)
    deal(world, row, ball, model, thrown, impulse, hit)


def moving_state(world, row: int, tick: int, model) -> np.ndarray:
    """The physics' state of a body that is as it is shown, and moves as it does."""
    before = Pose(*settled_pose(world, row, tick - MOMENT))
    return ragdoll.start(model, shown(world, row)[0], before, MOMENT * TICK_S)


def place_in_world(world, row: int, hit: impact.Hit):
    """The place that was hit, on the body as it is shown now."""
    positions, orientations = joints_of(body_of(world, row), shown(world, row)[0])
    return vector.add(positions[hit.joint], quaternion.rotate(orientations[hit.joint], hit.place_m))


def ball_at(world, ball: int, touch_m, normal) -> impact.Ball:
    """The ball touching there."""
    f = world[Flight]
    return impact.Ball(
        float(f.mass_kg[ball]),
        float(f.radius_m[ball]),
        vector.along(touch_m, normal, float(f.radius_m[ball])),
        tuple(f.velocity_mps[ball]),
        tuple(f.spin_radps[ball]),
    )


def keep_out(world, ball: int, touch_m, normal) -> None:
    """Moves a ball straight out to where it just touches a place, if it has come farther; along the skin it is free."""
    f = world[Flight]
    inside_m = f.radius_m[ball] - vector.inner(vector.subtract(f.position_m[ball], touch_m), normal)
    f.position_m[ball] = vector.along(f.position_m[ball], normal, max(0.0, inside_m))


def turn_ball(world, ball: int, after: impact.Ball) -> None:
    """Gives the ball the velocity and spin that the impact has left it."""
    world[Flight].velocity_mps[ball] = after.velocity_mps
    world[Flight].spin_radps[ball] = after.spin_radps


def deal(world, row: int, ball: int, model, thrown: impact.Ball, impulse: impact.Impulse, hit: impact.Hit) -> None:
    """Starts a blow over the contact time; a second one at the same time, or one without duration, is dealt at once."""
    b, response = world[Blow], world.assets.settings.response
    world[Struck].impulse_Ns[row] -= impulse.impulse_Ns
    if b.ball[row] == NOBODY:
        b.elapsed_s[row] = 0.0
    if b.ball[row] != NOBODY or response.contact_s <= 0.0:
        world[Ragdoll].state[row] = impact.body_after(model, world[Ragdoll].state[row], impulse)
        turn_ball(world, ball, impact.ball_after(thrown, impulse))
        return
    b.ball[row] = world.entity(ball)
    b.joint[row], b.place_m[row] = impulse.joint, impulse.place_m
    b.impulse_Ns[row], b.turning_Nms[row] = -impulse.impulse_Ns, impulse.turning_Nms
    b.normal[row] = hit.normal
    b.lasts_s[row] = response.contact_s
    world[Flight].held[ball] = True


def finish_blow(world, row: int, ball: int, model) -> None:
    """What is left of the blow under way is dealt at once: the ball meets another part before it has left the first."""
    b = world[Blow]
    push = ragdoll.Push(int(b.joint[row]), b.place_m[row], b.impulse_Ns[row], 0.0, float(b.lasts_s[row]))
    left = ragdoll.share_in(push, float(b.elapsed_s[row]), push.duration_s)
    rest = impact.Impulse(
        -left * push.impulse_Ns, left * b.turning_Nms[row], push.joint, push.place_m, 0.0, b.normal[row]
    )
    world[Ragdoll].state[row] = impact.body_after(model, world[Ragdoll].state[row], rest)
    turn_ball(world, ball, impact.ball_after(ball_at(world, ball, (0.0, 0.0, 0.0), b.normal[row]), rest))
    b.ball[row] = NOBODY
    world[Flight].held[ball] = False


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


def lateness_s(world, row: int, ball: int, at_s: float, hit: impact.Hit) -> float:
    """Contact time against plan: how much later than planned, once the flight that the surface saved is counted in.

    The plan brings the ball's centre to the target; the surface that it met stands before that, by so many metres of
    flight.
    """
    r, t = world[Reaction], world[Threat]
    if r.threat[row] != world.entity(ball):
        return 0.0
    f = world[Flight]
    centre = vector.along(hit.point_m, hit.normal, float(f.radius_m[ball]))
    saved_m = vector.inner(vector.subtract(t.line_m[ball], centre), t.tangent[ball])
    speed = max(vector.length(f.velocity_mps[ball]), 1e-6)
    return at_s + saved_m / speed - float(t.contact[ball]) * TICK_S
