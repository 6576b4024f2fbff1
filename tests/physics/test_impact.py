"""The impulse law: momentum to rounding, restitution exact, friction in its cone, no energy made, no tunnelling."""

import itertools
import math

import mujoco
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.body import kinematics
from engine.body.skeleton import HEAD, WRISTS, Pose
from engine.maths import ballistics, quaternion
from engine.physics import impact, ragdoll, stops
from engine.physics.impact import Ball, Material
from tests.physics.standing import (
    BODY,
    CONTACT_S,
    MODEL,
    SHAPES,
    TICK_S,
    VOLLEYBALL_ON_SKIN,
    kinetic_energy,
    momentum,
    moving,
    standing,
)

seeds = st.integers(0, 2**32 - 1)


def ball_momentum(ball, about=(0.0, 0.0, 0.0)):
    p = ball.mass_kg * np.array(ball.velocity_mps)
    spin = ball.hollow * ball.mass_kg * ball.radius_m**2 * np.array(ball.spin_radps)
    return p, np.cross(np.subtract(ball.centre_m, about), p) + spin


def ball_energy(ball):
    spin = ball.hollow * ball.mass_kg * ball.radius_m**2 * np.dot(ball.spin_radps, ball.spin_radps)
    return 0.5 * ball.mass_kg * np.dot(ball.velocity_mps, ball.velocity_mps) + 0.5 * spin


def random_contact(seed, mass_kg):
    """A ball just touching some capsule of a whirling body, on its way in, spinning; and the contact."""
    rng = np.random.default_rng(seed)
    pose, state = moving(rng)
    frames = kinematics.joints_of(BODY, pose)
    aim = frames[0][rng.integers(21)]
    way = rng.normal(size=3)
    way *= 0.6 / np.linalg.norm(way)
    hit = impact.first_hit(SHAPES, frames, frames, aim - 2 * way, aim + way, 0.105)
    centre = hit.point_m + 0.105 * hit.normal
    velocity = 40.0 * way + rng.normal(size=3) * 5.0
    return state, hit, Ball(mass_kg, 0.105, tuple(centre), tuple(velocity), tuple(rng.normal(size=3) * 30.0))


def gap_velocity(state, hit, ball):
    """Velocity of the ball's surface against the body's at the contact, by hand."""
    linear, angular = ragdoll.motion_of(MODEL, state)
    joint, _ = kinematics.joints_of(BODY, ragdoll.pose_of(MODEL, state))
    body = linear[hit.joint] + np.cross(angular[hit.joint], hit.point_m - joint[hit.joint])
    return np.array(ball.velocity_mps) + np.cross(ball.spin_radps, -ball.radius_m * hit.normal) - body


@settings(max_examples=60)
@given(seeds, st.sampled_from([0.27, 5.0]), st.integers(0, 10), st.integers(0, 12))
def test_momentum_restitution_friction_and_energy(seed, mass_kg, restitution, friction):
    material = Material(restitution / 10, friction / 10)
    state, hit, ball = random_contact(seed, mass_kg)
    given_ = impact.exchange(MODEL, state, ball, hit, material)
    before = gap_velocity(state, hit, ball)
    if given_ is None:
        assert before @ hit.normal >= 0.0
        return
    after_state, after = impact.body_after(MODEL, state, given_), impact.ball_after(ball, given_)
    # momentum of ball and body together, linear and angular, to rounding
    for was, now, ball_was, ball_now in zip(
        momentum(MODEL, state), momentum(MODEL, after_state), ball_momentum(ball), ball_momentum(after), strict=True
    ):
        np.testing.assert_allclose(now + ball_now, was + ball_was, atol=1e-9, rtol=1e-10)
    # Newton, exactly
    rebound = gap_velocity(after_state, hit, after)
    assert given_.approach_mps == pytest.approx(-(before @ hit.normal), rel=1e-9)
    assert rebound @ hit.normal == pytest.approx(material.restitution * given_.approach_mps, abs=1e-8)
    # Coulomb
    j_n = given_.impulse_Ns @ hit.normal
    j_t = given_.impulse_Ns - j_n * hit.normal
    assert j_n > 0.0
    assert np.linalg.norm(j_t) <= material.friction * j_n * (1 + 1e-9) + 1e-12
    gained = kinetic_energy(MODEL, after_state) + ball_energy(after) - kinetic_energy(MODEL, state) - ball_energy(ball)
    scale = kinetic_energy(MODEL, state) + ball_energy(ball)
    assert gained < 1e-10 * scale
    # what holds does not slip, unless holding any better would have made energy
    if np.linalg.norm(j_t) < material.friction * j_n * (1 - 1e-6) and gained < -1e-9 * scale:
        slip = rebound - (rebound @ hit.normal) * hit.normal
        assert np.linalg.norm(slip) < 1e-7


@pytest.mark.parametrize("seed", range(8))
def test_mobility_is_that_of_the_dense_matrix(seed):
    """With whatever touches, and holds against the push, as equations: the KKT system's Schur complement."""
    state, hit, _ = random_contact(seed, 0.27)
    place = impact._locate(MODEL, state, hit.joint, hit.place_m)
    np.testing.assert_allclose(place, hit.point_m, atol=1e-9)
    gives, _ = impact._mobility(MODEL, place, hit.joint, hit.normal)
    dense = np.empty((MODEL.mujoco_model.nv,) * 2)
    mujoco.mj_fullM(MODEL.mujoco_model, MODEL.data, dense)
    inverse = np.linalg.inv(dense)
    jacobian = impact._jacobian(MODEL, place, hit.joint)
    rows, _ = stops.braces(MODEL, MODEL.data.qpos, -inverse @ jacobian.T @ hit.normal)
    inverse -= inverse @ rows.T @ np.linalg.pinv(rows @ inverse @ rows.T) @ rows @ inverse
    np.testing.assert_allclose(gives, jacobian @ inverse @ jacobian.T, rtol=1e-7, atol=1e-9)


def test_joints_transmit_the_blow():
    """A jointed body gives way more easily than a rigid piece of its mass, and less easily than the part alone."""
    pose = standing()
    state = ragdoll.start(MODEL, pose, pose, TICK_S)
    frames = kinematics.joints_of(BODY, pose)
    centre = frames[0][HEAD] + [0.5, 0.0, 0.1]
    hit = impact.first_hit(SHAPES, frames, frames, centre, centre - [0.6, 0, 0], 0.105)
    assert hit.part == "head"
    place = impact._locate(MODEL, state, hit.joint, hit.place_m)
    gives, _ = impact._mobility(MODEL, place, hit.joint, hit.normal)
    weight = 1.0 / (hit.normal @ gives @ hit.normal)
    assert 0.5 * BODY.part_mass_kg[HEAD] < weight < 0.25 * BODY.part_mass_kg.sum()


def test_a_ball_on_the_floor_bounces_by_the_book():
    ball = Ball(0.27, 0.105, (0.0, 0.0, 0.105), (6.0, 0.0, -8.0))
    gripped = impact.bounce(ball, (0.0, 0.0, 1.0), Material(0.75, 5.0))
    # a thin shell that grips keeps 3/5 of its speed along the floor and rolls
    np.testing.assert_allclose(gripped.velocity_mps, (3.6, 0.0, 6.0), atol=1e-12)
    np.testing.assert_allclose(gripped.spin_radps, (0.0, 3.6 / 0.105, 0.0), atol=1e-9)
    sliding = impact.bounce(ball, (0.0, 0.0, 1.0), Material(0.75, 0.1))
    np.testing.assert_allclose(sliding.velocity_mps, (6.0 - 0.1 * 14.0, 0.0, 6.0), atol=1e-12)
    smooth = impact.bounce(ball, (0.0, 0.0, 1.0), Material(1.0, 0.0))
    np.testing.assert_allclose(smooth.velocity_mps, (6.0, 0.0, 8.0), atol=1e-12)
    assert smooth.spin_radps == (0.0, 0.0, 0.0)
    leaving = ball._replace(velocity_mps=(1.0, 0.0, 2.0))
    assert impact.bounce(leaving, (0.0, 0.0, 1.0), Material(0.75, 0.5)) is leaving


def test_what_the_body_is_given_in_shares_the_ball_loses_in_the_same_shares():
    state, hit, ball = random_contact(11, 0.27)
    given_ = impact.exchange(MODEL, state, ball, hit, VOLLEYBALL_ON_SKIN)
    push = impact.push_of(given_, -0.003, CONTACT_S)
    h = TICK_S / 4
    times = -0.003 + h * np.arange(9)
    shares = np.array([ragdoll.share_in(push, a, b) for a, b in itertools.pairwise(times)])
    assert shares.sum() == pytest.approx(1.0, abs=1e-15)
    flown, taken = ball, np.zeros(3)
    for share in shares:
        flown = impact.ball_after(flown, given_, share)
        taken += share * np.asarray(push.impulse_Ns)
        lost = ball.mass_kg * np.subtract(flown.velocity_mps, ball.velocity_mps)
        np.testing.assert_allclose(lost + taken, 0.0, atol=1e-13)
    np.testing.assert_allclose(flown.velocity_mps, impact.ball_after(ball, given_).velocity_mps, atol=1e-12)


@pytest.mark.parametrize("duration_s", [0.0, 0.010])
def test_momentum_of_ball_body_and_earth_balances_at_every_sub_step(duration_s):
    """In the air, servos straining: the body changes by gravity and by exactly what the ball loses."""
    _, state = moving(np.random.default_rng(5))
    impulse = np.array([-9.0, 2.0, 1.0])
    turning = np.zeros(3)
    given_ = impact.Impulse(-impulse, turning, HEAD, np.array([0.09, 0.0, 0.06]), 25.0, -impulse / 9.0)
    ball = Ball(0.27, 0.105, (1.0, 0.0, 21.5), (-25.0, 0.0, 0.0))
    h = TICK_S / 4
    total = momentum(MODEL, state)[0] + ball_momentum(ball)[0]
    for k in range(12):
        since = (k - 2) * h
        push = impact.push_of(given_, since, duration_s)
        state = ragdoll.step(MODEL, state, standing(), 1.0, 1.0, h, (push,))
        ball = impact.ball_after(ball, given_, ragdoll.share_in(push, since, since + h))
        total = total + h * MODEL.mass_kg * np.array(ballistics.GRAVITY_MPS2)
        np.testing.assert_allclose(momentum(MODEL, state)[0] + ball_momentum(ball)[0], total, atol=1e-11)
    np.testing.assert_allclose(ball_momentum(ball)[0], [-6.75 + 9.0, -2.0, -1.0], atol=1e-12)


def test_a_spiked_volleyball_in_the_face_shakes_the_head_as_measured_and_moves_the_body_little():
    """Heading and ball-to-face accelerations are measured at 4.5 to 63 g; 10 N s do not throw 74 kg."""
    pose = standing()
    state = ragdoll.start(MODEL, pose, pose, TICK_S)
    given_ = spike(0.27, state, pose)
    trace = np.empty((8 * ragdoll.sub_steps_in(TICK_S), 21, 3))
    for k in range(8):
        push = (impact.push_of(given_, k * TICK_S, CONTACT_S),)
        part = trace[4 * k : 4 * k + 4]
        state = ragdoll.step(MODEL, state, pose, 1.0, 1.0, TICK_S, push, trace=part)
    speeds = np.concatenate([np.zeros((1, 3)), trace[:, HEAD]])
    peak_g = np.linalg.norm(np.diff(speeds, axis=0), axis=1).max() * 480 / 9.81
    assert 10.0 < peak_g < 63.0
    for _ in range(22):
        state = ragdoll.step(MODEL, state, pose, 1.0, 1.0, TICK_S)
    com = kinematics.com_of(BODY, ragdoll.pose_of(MODEL, state))
    assert np.linalg.norm(com - kinematics.com_of(BODY, pose)) < 0.06
    assert com[2] > 0.95 * kinematics.com_of(BODY, pose)[2]


def spike(mass_kg, state, pose, height_m=1.62):
    frames = kinematics.joints_of(BODY, pose)
    start = (0.5, 0.0, height_m)
    hit = impact.first_hit(SHAPES, frames, frames, start, (-0.5, 0.0, height_m), 0.105)
    ball = Ball(mass_kg, 0.105, start, (-25.0, 0.0, 0.0))
    return impact.exchange(MODEL, state, ball, hit, VOLLEYBALL_ON_SKIN)


def test_a_five_kilogram_ball_at_that_speed_knocks_the_body_down():
    pose = standing()
    state = ragdoll.start(MODEL, pose, pose, TICK_S)
    given_ = spike(5.0, state, pose, 1.3)
    for k in range(240):
        pushes = (impact.push_of(given_, k * TICK_S, CONTACT_S),) if k < 3 else ()
        state = ragdoll.step(MODEL, state, pose, 1.0, 1.0, TICK_S, pushes)
    com = kinematics.com_of(BODY, ragdoll.pose_of(MODEL, state))
    assert com[2] < 0.3
    assert com[0] < -0.3


def test_the_hand_in_front_of_the_face_is_met_first_and_the_hit_says_so():
    pose = standing()
    rotations = pose.rotations.copy()
    rotations[6] = quaternion.about_y(-1.6)  # left arm forward
    rotations[7] = quaternion.about_y(-1.2)
    pose = Pose(pose.root_m, rotations)
    frames = kinematics.joints_of(BODY, pose)
    aim = frames[0][WRISTS[0]] + [0.0, 0.0, 0.08]
    before = (frames[0] - [0.02, 0.0, 0.0], frames[1])  # the body comes a little towards the ball
    hit = impact.first_hit(SHAPES, before, frames, aim + [0.4, 0, 0], aim - [0.4, 0, 0], 0.105)
    assert hit.part in ("left_hand", "left_forearm")
    assert hit.normal[0] > 0.9
    assert np.linalg.norm(hit.normal) == pytest.approx(1.0)
    # place and point are the same contact, seen from the part and from the world at that moment
    q, p = frames[1][hit.joint], before[0][hit.joint] + hit.share * (frames[0][hit.joint] - before[0][hit.joint])
    np.testing.assert_allclose(p + quaternion.rotate(q, hit.place_m), hit.point_m, atol=1e-9)
    centre = aim + [0.4 - 0.8 * hit.share, 0, 0]
    np.testing.assert_allclose(hit.point_m + 0.105 * hit.normal, centre, atol=1e-6)


@given(seeds)
@settings(max_examples=30)
def test_nothing_is_tunnelled_at_any_speed_within_a_tick(seed):
    """A ball on its way straight through the trunk is stopped, whether it takes one tick or a hundred for it."""
    rng = np.random.default_rng(seed)
    pose = standing()
    frames = kinematics.joints_of(BODY, pose)
    angle = rng.uniform(0, 2 * math.pi)
    way = np.array([math.cos(angle), math.sin(angle), 0.2])
    through = frames[0][rng.integers(5)]
    fast = impact.first_hit(SHAPES, frames, frames, through - way, through + way, 0.105)
    assert fast is not None
    for k in range(100):
        a, b = through + (k / 50 - 1) * way, through + ((k + 1) / 50 - 1) * way
        slow = impact.first_hit(SHAPES, frames, frames, a, b, 0.105)
        if slow:
            assert (k + slow.share) / 100 == pytest.approx(fast.share, abs=1e-6)
            assert slow.part == fast.part
            break
    else:
        pytest.fail("the slow ball passed")
    assert impact.first_hit(SHAPES, frames, frames, through + [3, 0, 0], through + [3, 1, 0], 0.105) is None
