"""Stops: limits hold, arms stay out, no energy is made; the impulses are those of another library."""

import math

import mujoco
import numpy as np
import pytest
from scipy.optimize import nnls

from engine.body import kinematics, limits
from engine.body.capsules import CAPSULES, capsules_at
from engine.body.skeleton import ELBOWS, HEAD, JOINT_COUNT, PARENT, SHOULDERS, WRISTS, Pose
from engine.clips.mirror import mirror_pose
from engine.maths import quaternion, vector
from engine.physics import impact, limit_stops, part_stops, ragdoll, stops
from engine.physics.impact import Push
from engine.physics.rows import MOST_ROWS
from tests.physics.standing import (
    BODY,
    CONTACT_S,
    MODEL,
    SHAPES,
    TICK_S,
    VOLLEYBALL_ON_SKIN,
    kinetic_energy,
    momentum,
    standing,
)

NV = MODEL.mujoco_model.nv


@pytest.fixture
def weightless(monkeypatch):
    monkeypatch.setattr(MODEL.mujoco_model.opt, "gravity", np.zeros(3))
    yield
    MODEL.mujoco_model.opt.gravity[:] = (0.0, 0.0, -9.80665)


def depths_m(state):
    """(P,) of all pairs that stop each other."""
    out = np.empty(len(MODEL.pairs))
    part_stops.depths_into(PARENT, BODY.offset_m, ragdoll.pose_of(MODEL, state).rotations, SHAPES, MODEL.pairs, out)
    return out


def inside_limits(rng):
    """A pose in the air with every joint somewhere inside its range, but for a thousandth."""
    low, high = BODY.limit_low_rad[1:], BODY.limit_high_rad[1:]
    asked = np.clip(rng.normal(0.0, 0.5, (JOINT_COUNT - 1, 3)), 0.999 * low, 0.999 * high)
    rotations = np.array([quaternion.IDENTITY, *(limits.from_components(*c) for c in asked)])
    return Pose(np.array([0.0, 0.0, 20.0]), rotations)


def whirling(rng, spin_radps):
    """Such a pose, its joints spinning at random."""
    pose = inside_limits(rng)
    velocities = np.zeros(NV)
    velocities[6:] = rng.normal(size=NV - 6) * spin_radps
    return pose, ragdoll.state_of(MODEL, pose, velocities)


def guarding():
    """Standing, forearms up, hands in front of the face."""
    pose = standing()
    rotations = pose.rotations.copy()
    for side, sign in enumerate((1.0, -1.0)):
        rotations[SHOULDERS[side]] = limits.from_components(-0.35 * sign, -0.9, 0.0)
        rotations[ELBOWS[side]] = limits.from_components(0.0, -1.9, 0.0)
    return Pose(pose.root_m, rotations)


@pytest.mark.parametrize("seed", range(6))
def test_limp_and_whirling_no_joint_passes_its_limits_and_no_arm_goes_in(seed):
    """Spins of 8 rad/s at every joint, nothing that holds: more than any ball does."""
    pose, state = whirling(np.random.default_rng(seed), 8.0)
    began = depths_m(state)
    for _ in range(30):
        state = ragdoll.step(MODEL, state, pose, 0.0, 1.0, TICK_S)
        assert math.degrees(limits.excess_rad(BODY, ragdoll.pose_of(MODEL, state).rotations).max()) < 0.4
        assert (depths_m(state) - began).max() < 0.005


@pytest.mark.parametrize("seed", [1, 12])
def test_a_joint_that_meets_its_limit_throws_no_arm_deeper_than_flesh_gives(seed):
    """Spins of 15 rad/s: what stops one thing hits another that was parting just now."""
    pose, state = whirling(np.random.default_rng(seed), 15.0)
    began = depths_m(state)
    for _ in range(30):
        state = ragdoll.step(MODEL, state, pose, 0.0, 1.0, TICK_S)
        assert (depths_m(state) - began).max() < part_stops.FLESH_M


def hands_thrown_at_the_face():
    """States of 24 ticks, a ball's impulse against both hands from ahead in the first two."""
    pose = guarding()
    states = [ragdoll.start(MODEL, pose, pose, TICK_S)]
    pushes = [
        Push(w, np.array([0.0, 0.0, -0.08]), np.array([-6.0, -4.0 * sign, 2.0]), 0.0, 0.01)
        for w, sign in zip(WRISTS, (1.0, -1.0), strict=True)
    ]
    for k in range(24):
        blow = tuple(push._replace(since_s=k * TICK_S) for push in pushes)
        states.append(ragdoll.step(MODEL, states[-1], pose, 1.0, 1.0, TICK_S, blow))
    return states


def nearest(state, one, other):
    """The gap between two capsules and the way from the second to the first."""
    a, b = CAPSULES.index(one), CAPSULES.index(other)
    ends = capsules_at(SHAPES, *kinematics.joints_of(BODY, ragdoll.pose_of(MODEL, state)))
    on_a, on_b, gap_m = part_stops.nearest(ends[a], ends[b], SHAPES.radius_m[a] + SHAPES.radius_m[b])
    return gap_m, np.array(vector.unit(np.subtract(on_a, on_b), (0.0, 0.0, 1.0)))


def test_a_hand_thrown_at_the_face_stops_at_it():
    """It is pressed against the head, never into it."""
    parts = [f"{side}_{part}" for side in ("left", "right") for part in ("hand", "forearm")]
    gaps = [nearest(state, part, "head")[0] for state in hands_thrown_at_the_face() for part in parts]
    assert -0.005 < min(gaps) < 0.02


@pytest.mark.parametrize("gap_m", [-0.002, 0.0, 0.005, 0.016, 0.05])
@pytest.mark.parametrize("closing_mps", [0.2, 1.0, 5.0, 10.0])
def test_parts_thrown_together_are_braked_over_gap_and_flesh(gap_m, closing_mps):
    """More gently than by a stop alone, and no deeper than flesh gives."""
    h, changes, depths_m = 1.0 / 480.0, [], []
    for rule in (part_stops.may_close_mps, lambda gap, v, ease_s, h: max(gap, 0.0) / ease_s):
        gap, v, worst = gap_m, closing_mps, 0.0
        for _ in range(60):
            slower = min(v, rule(gap, v, stops.EASE_S, h))
            worst, v = max(worst, v - slower), slower
            gap -= v * h
        changes.append(worst)
        depths_m.append(-gap)
    assert changes[0] <= changes[1]
    if closing_mps == 1.0 and abs(gap_m) < 1e-9:  # two millimetres a step, four of flesh
        assert changes[0] < 0.5 * changes[1]
    assert max(depths_m[0], -gap_m) <= part_stops.FLESH_M + 1e-9
    assert depths_m[1] <= max(0.0, -gap_m) + 1e-9


def test_what_lies_deeper_than_flesh_goes_no_deeper():
    assert part_stops.may_close_mps(-0.03, 2.0, stops.EASE_S, 1.0 / 480.0) == 0.0
    assert part_stops.may_close_mps(0.2, 2.0, stops.EASE_S, 1.0 / 480.0) > 2.0  # far off: nothing is bound


def test_a_hand_that_lies_on_the_face_gives_way_no_more_than_the_head(monkeypatch):
    """What a ball meets there is hand and head in one, not a hand that is free to fly."""
    state = min(hands_thrown_at_the_face(), key=lambda state: nearest(state, "left_hand", "head")[0])
    gap_m, outwards = nearest(state, "left_hand", "head")
    assert gap_m < part_stops.TOUCHING_M
    hand = CAPSULES.index("left_hand")
    orientation = kinematics.joints_of(BODY, ragdoll.pose_of(MODEL, state))[1][WRISTS[0]]
    middle = 0.5 * (SHAPES.start_m[hand] + SHAPES.end_m[hand])
    place_m = middle + SHAPES.radius_m[hand] * np.array(quaternion.unrotate(orientation, outwards))

    def mass_met_kg():
        place = impact._locate(MODEL, state, WRISTS[0], place_m)
        return 1.0 / (outwards @ impact._mobility(MODEL, place, WRISTS[0], outwards)[0] @ outwards)

    on_the_face = mass_met_kg()
    monkeypatch.setattr(stops, "braces", lambda *_: (np.empty((0, NV)), np.empty((0, NV))))
    assert on_the_face > 2.0 * mass_met_kg()


def test_what_begins_inside_comes_out_slowly_or_stays_as_the_target_has_it():
    crossed = standing()
    rotations = crossed.rotations.copy()
    rotations[SHOULDERS[0]] = limits.from_components(-0.45, -0.2, 0.0)  # the left arm through the belly
    inside = Pose(crossed.root_m + [0.0, 0.0, 30.0], rotations)
    state = ragdoll.start(MODEL, inside, inside, TICK_S)
    began = depths_m(state).max()
    assert began > 0.05
    kept = state
    for _ in range(24):
        kept = ragdoll.step(MODEL, kept, inside, 1.0, 1.0, TICK_S)
        assert np.abs(kept[MODEL.velocities][3:]).max() < 0.5
    assert depths_m(kept).max() == pytest.approx(began, abs=0.003)
    depths, speeds = [], []
    for _ in range(24):
        state = ragdoll.step(MODEL, state, crossed, 1.0, 1.0, TICK_S)
        depths.append(depths_m(state).max())
        speeds.append(np.abs(ragdoll.read(MODEL, state)[1] - [0.0, 0.0, -9.80665 * len(depths) * TICK_S]).max())
    assert max(depths) < began + 0.001
    assert depths[-1] < began - 0.02
    assert max(speeds) < 4.0


@pytest.mark.parametrize("seed", range(4))
def test_stops_make_no_energy_and_no_momentum(seed, weightless):
    _, state = whirling(np.random.default_rng(seed), 15.0)
    linear, _ = momentum(MODEL, state)
    energies = [kinetic_energy(MODEL, state)]
    for _ in range(20):
        state = ragdoll.step(MODEL, state, ragdoll.pose_of(MODEL, state), 0.0, 1.0, TICK_S)
        energies.append(kinetic_energy(MODEL, state))
        np.testing.assert_allclose(momentum(MODEL, state)[0], linear, atol=1e-9)
    assert np.diff(energies).max() < 3e-3 * energies[0]  # what the integrator leaves open
    assert energies[-1] < 0.7 * energies[0]


def test_a_whole_blow_against_a_hand_on_the_face_keeps_momentum_and_makes_no_energy(weightless):
    """No floor, no gravity, limp: ball and body exchange what they have, over the contact time, stops and all."""
    pose = guarding()
    state = ragdoll.state_of(MODEL, Pose(pose.root_m + [0.0, 0.0, 30.0], pose.rotations), np.zeros(NV))
    frames = kinematics.joints_of(BODY, ragdoll.pose_of(MODEL, state))
    aim = frames[0][WRISTS[0]] + [0.0, -0.03, 0.08]
    hit = impact.first_hit(SHAPES, frames, frames, aim + [0.5, 0.0, 0.0], aim - [0.5, 0.0, 0.0], 0.105)
    assert hit.part == "left_hand"
    ball = impact.Ball(0.27, 0.105, tuple(hit.point_m + 0.105 * hit.normal), (-27.0, 0.0, 0.0))
    given = impact.exchange(MODEL, state, ball, hit, VOLLEYBALL_ON_SKIN)

    def total(state, ball):
        return momentum(MODEL, state)[0] + ball.mass_kg * np.array(ball.velocity_mps)

    def joules(state, ball):
        spin = 0.5 * ball.hollow * ball.mass_kg * ball.radius_m**2 * np.dot(ball.spin_radps, ball.spin_radps)
        return kinetic_energy(MODEL, state) + 0.5 * ball.mass_kg * np.dot(ball.velocity_mps, ball.velocity_mps) + spin

    began, energy_J = total(state, ball), joules(state, ball)
    held = []
    for k in range(12):
        push = impact.push_of(given, k * TICK_S, CONTACT_S)
        state = ragdoll.step(MODEL, state, pose, 0.0, 1.0, TICK_S, (push,))
        ball = impact.ball_after(ball, given, ragdoll.share_in(push, push.since_s, push.since_s + TICK_S))
        np.testing.assert_allclose(total(state, ball), began, atol=1e-10)
        assert joules(state, ball) < energy_J * (1.0 + 1e-6)
        held.append(nearest(state, "left_hand", "head")[0])
    assert min(held) > -0.005
    assert joules(state, ball) < 0.9 * energy_J


def test_the_impulses_are_those_of_non_negative_least_squares():
    """x >= 0 that minimises x A x / 2 - x r is the same as nnls of a root of A: SciPy's active sets, not our sweeps."""
    rng = np.random.default_rng(5)
    for count in (1, 3, 8):
        root = rng.normal(size=(NV, NV))
        inverse = root @ root.T / NV + np.eye(NV)
        rows, least, qvel = rng.normal(size=(count, NV)), rng.normal(size=count), rng.normal(size=NV)
        upper = np.linalg.cholesky(rows @ inverse @ rows.T).T
        impulse, _ = nnls(upper, np.linalg.solve(upper.T, least - rows @ qvel))
        after = qvel.copy()
        stops.meet(rows, rows @ inverse, least, after)
        np.testing.assert_allclose(after, qvel + inverse @ rows.T @ impulse, atol=1e-6)
        assert (rows @ after - least).min() > -1e-6


def test_a_row_is_how_the_gap_or_the_angle_changes_and_pushes_nobody_about():
    """Rows against finite differences through MuJoCo's own way of moving places by velocities; and what an impulse
    along one does to the body's momentum, both kinds: nothing."""
    rng = np.random.default_rng(8)
    pose = inside_limits(rng)
    qpos = ragdoll.state_of(MODEL, pose, np.zeros(NV))[MODEL.positions]
    qvel = rng.normal(size=NV) * 30.0
    rows, least = np.zeros((MOST_ROWS, NV)), np.empty(MOST_ROWS)
    count = stops.find(
        PARENT, BODY.offset_m, BODY.limit_low_rad, BODY.limit_high_rad, pose.rotations, SHAPES, MODEL.pairs,
        qpos, qvel, stops.EASE_S, stops.EASE_S, 0.0, part_stops.FARTHEST_M, limit_stops.NEAR_RAD, rows, least,
    )  # fmt: skip
    assert count > 5
    moved = qpos.copy()
    step_s = 1e-7
    mujoco.mj_integratePos(MODEL.mujoco_model, moved, qvel, step_s)

    def lengths(q):
        ends = capsules_at(SHAPES, *kinematics.joints_of(BODY, Pose(q[:3], q[3:].reshape(-1, 4))))
        gaps = [
            part_stops.nearest(ends[a], ends[b], SHAPES.radius_m[a] + SHAPES.radius_m[b])[2] for a, b in MODEL.pairs
        ]
        angles = [limits.components(r) for r in q[3:].reshape(-1, 4)]
        return np.concatenate([gaps, np.ravel(angles)])

    changes = (lengths(moved) - lengths(qpos)) / step_s
    for row in rows[:count]:
        assert np.abs(np.abs(changes) - abs(row @ qvel)).min() < 1e-3
        answer = np.empty((1, NV))
        ragdoll.state_of(MODEL, pose, qvel)
        MODEL.mujoco_model.dof_armature[:] = 0.0
        mujoco.mj_fwdPosition(MODEL.mujoco_model, MODEL.data)
        mujoco.mj_solveM(MODEL.mujoco_model, MODEL.data, answer, row[None])
        for kind in momentum(MODEL, ragdoll.state_of(MODEL, pose, answer[0])):
            np.testing.assert_allclose(kind, 0.0, atol=1e-8)


def test_a_response_mirrored_is_the_response_to_the_mirrored_blow():
    pose = guarding()
    rotations = pose.rotations.copy()
    rotations[HEAD] = quaternion.from_rotation_vector((0.1, 0.2, 0.3))
    pose = Pose(pose.root_m, rotations)
    push = Push(WRISTS[0], np.array([0.01, 0.02, -0.08]), np.array([-6.0, -3.0, 1.0]), 0.0, 0.01)
    other = Push(WRISTS[1], push.place_m * [1, -1, 1], push.impulse_Ns * [1, -1, 1], 0.0, 0.01)
    state, mirrored = (ragdoll.start(MODEL, p, p, TICK_S) for p in (pose, mirror_pose(pose)))
    for k in range(10):
        since_s = k * TICK_S
        state = ragdoll.step(MODEL, state, pose, 1.0, 1.0, TICK_S, (push._replace(since_s=since_s),))
        blow = (other._replace(since_s=since_s),)
        mirrored = ragdoll.step(MODEL, mirrored, mirror_pose(pose), 1.0, 1.0, TICK_S, blow)
    ours = kinematics.joints_of(BODY, ragdoll.pose_of(MODEL, state))[0]
    theirs = kinematics.joints_of(BODY, mirror_pose(ragdoll.pose_of(MODEL, mirrored)))[0]
    assert np.abs(ours - kinematics.joints_of(BODY, pose)[0]).max() > 0.05
    np.testing.assert_allclose(ours, theirs, atol=1e-6)
