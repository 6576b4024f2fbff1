"""Contact: a ball meets a body, and what comes of it (thesis 4.1.2).

A matter of geometry, never of the predicted time: the ball is swept against the body's capsules between two ticks.
"""

from __future__ import annotations

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
from behaviours.playing import body_of
from behaviours.respond.blow import ball_at, deal, finish_blow, keep_out, turn_ball
from behaviours.respond.response import begin_response, moving_state
from behaviours.settle.seams import shown
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.body.skeleton import JOINTS
from engine.core.schedule import Stage, system
from engine.maths import quaternion, vector
from engine.physics import impact

WORTH_SAYING_MPS = 0.5  # a ball that lies on somebody touches anew each tick: no event
NEAR_M = 1.5  # a ball farther from the pelvis than its own size plus this meets nobody


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
    thrown = ball_at(world, ball, vector.along(touch_m, hit.normal, float(world[Flight].radius_m[ball])))
    material = impact.Material(response.restitution, response.friction)
    impulse = impact.exchange(model, state, thrown, hit, material)
    if impulse is None:
        return
    # whoever walks or gets up into a ball that lies there pushes it: only a ball that comes moves anybody
    comes_mps = -vector.inner(thrown.velocity_mps, hit.normal)
    hard = vector.length(impulse.impulse_Ns) >= response.least_Ns and (simulated or comes_mps >= response.least_mps)
    if impulse.approach_mps >= WORTH_SAYING_MPS:
        say_met(world, row, ball, hit, impulse, "contact" if hard else "touch", (tick - 1 + hit.share) * TICK_S)
    world[Threat].spent[ball] = True
    keep_out(world, ball, touch_m, hit.normal)
    if not hard:
        turn_ball(world, ball, impact.ball_after(thrown, impulse))
        return
    if not simulated:
        begin_response(world, row, tick, state)
    deal(world, row, ball, model, thrown, impulse, hit)


def say_met(world, row: int, ball: int, hit: impact.Hit, impulse: impact.Impulse, kind: str, at_s: float) -> None:
    """The event of a contact."""
    world.emit(
        kind,
        world.entity(row),
        at_s=at_s,
        ball=world.entity(ball),
        part=hit.part,
        joint=JOINTS[hit.joint],
        impulse_Ns=vector.length(impulse.impulse_Ns),
        approach_mps=impulse.approach_mps,
        late_s=lateness_s(world, row, ball, at_s, hit),
    )


def place_in_world(world, row: int, hit: impact.Hit):
    """The place that was hit, on the body as it is shown now."""
    positions, orientations = joints_of(body_of(world, row), shown(world, row)[0])
    return vector.add(positions[hit.joint], quaternion.rotate(orientations[hit.joint], hit.place_m))


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
