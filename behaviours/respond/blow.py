"""A blow under way: an impulse that a ball deals to a body over the time that it presses against it.

Body and ball get the same share of it in every tick, so that momentum is kept whatever the physics makes of it.
"""

from __future__ import annotations

from behaviours.components import NOBODY, Blow, Flight, Ragdoll, Struck
from behaviours.playing import body_of
from behaviours.timing import TICK_S
from engine.body.kinematics import joints_of
from engine.maths import quaternion, vector
from engine.physics import impact, ragdoll


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


def under_way(world, row: int) -> impact.Impulse:
    """The blow that is being dealt to a character, all of it."""
    b = world[Blow]
    return impact.Impulse(
        -b.impulse_Ns[row], b.turning_Nms[row].copy(), int(b.joint[row]), b.place_m[row].copy(), 0.0,
        b.normal[row].copy(),
    )  # fmt: skip


def deal_blow(world, row: int) -> tuple[ragdoll.Push, ...]:
    """The body's side of the blow under way, and this tick's share of it to the ball."""
    b = world[Blow]
    b.elapsed_s[row] += TICK_S
    if b.ball[row] == NOBODY:
        return ()
    blow = under_way(world, row)
    push = impact.push_of(blow, float(b.elapsed_s[row] - TICK_S), float(b.lasts_s[row]))
    if world.alive(int(b.ball[row])):
        ball, share = world.row(int(b.ball[row])), ragdoll.share_in(push, push.since_s, push.since_s + TICK_S)
        turn_ball(world, ball, impact.ball_after(ball_at(world, ball, world[Flight].position_m[ball]), blow, share))
    return (push,)


def finish_blow(world, row: int, ball: int, model) -> None:
    """What is left of the blow under way is dealt at once: the ball meets another part before it has left the first."""
    b, blow = world[Blow], under_way(world, row)
    push = impact.push_of(blow, 0.0, float(b.lasts_s[row]))
    left = ragdoll.share_in(push, float(b.elapsed_s[row]), push.duration_s)
    rest = blow._replace(impulse_Ns=left * blow.impulse_Ns, turning_Nms=left * blow.turning_Nms)
    world[Ragdoll].state[row] = impact.body_after(model, world[Ragdoll].state[row], rest)
    turn_ball(world, ball, impact.ball_after(ball_at(world, ball, world[Flight].position_m[ball]), rest))
    b.ball[row] = NOBODY
    world[Flight].held[ball] = False


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


def ball_at(world, ball: int, centre_m) -> impact.Ball:
    """The ball, its centre there."""
    f = world[Flight]
    return impact.Ball(
        float(f.mass_kg[ball]), float(f.radius_m[ball]), tuple(centre_m), tuple(f.velocity_mps[ball]),
        tuple(f.spin_radps[ball]),
    )  # fmt: skip


def keep_out(world, ball: int, touch_m, normal) -> None:
    """Moves a ball straight out to where it just touches a place, if it has come farther; along the skin it is free."""
    f = world[Flight]
    inside_m = f.radius_m[ball] - vector.inner(vector.subtract(f.position_m[ball], touch_m), normal)
    f.position_m[ball] = vector.along(f.position_m[ball], normal, max(0.0, inside_m))


def turn_ball(world, ball: int, after: impact.Ball) -> None:
    """Gives the ball the velocity and spin that the impact has left it."""
    world[Flight].velocity_mps[ball] = after.velocity_mps
    world[Flight].spin_radps[ball] = after.spin_radps
