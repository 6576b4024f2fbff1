"""The simulated body stands, tracks without jelly, falls without making energy, lies still; the same bits always."""

import math

import numpy as np
import pytest

from engine.body import kinematics, limits, support
from engine.body.capsules import capsules_at
from engine.body.skeleton import HEAD, KNEES, SHOULDERS, Pose
from engine.maths import quaternion
from engine.maths.ballistics import GRAVITY_MPS2, fly
from engine.physics import model as models
from engine.physics import ragdoll, tracking
from tests.physics.standing import BODY, MODEL, SHAPES, TICK_S, energy, momentum, moving, standing


def run(state, target, ticks, strength=1.0, damping=1.0, pushes=()):
    states = [state]
    for _ in range(ticks):
        states.append(ragdoll.step(MODEL, states[-1], target, strength, damping, TICK_S, pushes))
    return states


def lowest_m(state):
    """The lowest point of anything of the body."""
    positions, orientations = kinematics.joints_of(BODY, ragdoll.pose_of(MODEL, state))
    ends = capsules_at(SHAPES, positions, orientations)
    return (ends[..., 2] - SHAPES.radius_m[:, None]).min()


def test_it_holds_a_standing_pose():
    pose = standing()
    states = run(ragdoll.start(MODEL, pose, pose, TICK_S), pose, 60)
    coms = np.array([kinematics.com_of(BODY, ragdoll.pose_of(MODEL, s)) for s in states])
    assert np.abs(coms - coms[0]).max() < 0.005
    last = ragdoll.pose_of(MODEL, states[-1])
    assert max(quaternion.angle_between(a, b) for a, b in zip(last.rotations, pose.rotations, strict=True)) < 0.03
    polygon = support.polygon_of(BODY, *kinematics.joints_of(BODY, last), np.array([True, True]))
    assert support.margin_m(polygon, coms[-1][:2]) > 0.02
    assert np.abs(ragdoll.read(MODEL, states[-1])[1]).max() < 0.02


def test_the_same_state_gives_the_same_bits_whatever_was_simulated_between():
    pose, state = moving(np.random.default_rng(1), 1.0)
    target = standing()
    push = ragdoll.Push(HEAD, np.zeros(3), np.array([3.0, 1.0, 0.0]), -0.002, 0.01)
    once = ragdoll.step(MODEL, state, target, 0.7, 1.0, TICK_S, (push,))
    run(ragdoll.start(MODEL, pose, pose, TICK_S), pose, 20)
    again = ragdoll.step(MODEL, state.copy(), target, 0.7, 1.0, TICK_S, (push,))
    assert once.tobytes() == again.tobytes()
    models._MODELS.clear()
    fresh = models.model_for(BODY)
    assert fresh is not MODEL
    assert ragdoll.step(fresh, state, target, 0.7, 1.0, TICK_S, (push,)).tobytes() == once.tobytes()
    # a longer run, rewound to its middle
    states = run(state, target, 30)
    assert run(states[15], target, 15)[-1].tobytes() == states[30].tobytes()


@pytest.mark.parametrize("seed", range(3))
def test_in_the_air_only_gravity_moves_the_centre_of_mass(seed):
    """Servos, ligaments and armature are inner forces: they must not push the body about."""
    _, state = moving(np.random.default_rng(seed))
    p0, _ = momentum(MODEL, state)
    states = run(state, standing(), 30)
    p1, _ = momentum(MODEL, states[-1])
    np.testing.assert_allclose(p1 - p0, MODEL.mass_kg * 0.25 * np.array(GRAVITY_MPS2), atol=1e-9)
    com0, com1 = (kinematics.com_of(BODY, ragdoll.pose_of(MODEL, s)) for s in (states[0], states[-1]))
    np.testing.assert_allclose(com1, fly(com0, p0 / MODEL.mass_kg, GRAVITY_MPS2, 0.0, 0.25)[0], atol=0.01)


@pytest.mark.parametrize("strength", [0.0, 1.0])
def test_a_fall_makes_no_energy(strength):
    pose = standing()
    pose = Pose(pose.root_m + [0.0, 0.0, 0.6], pose.rotations)
    before = Pose(pose.root_m - [0.004, 0.002, 0.0], pose.rotations)
    states = run(ragdoll.start(MODEL, pose, before, TICK_S), pose, 300, strength)
    energies = np.array([energy(MODEL, s) for s in states])
    assert energies.max() < energies[0] * 1.005
    assert energies[-1] < 0.95 * energies[0]


@pytest.mark.parametrize("strength", [0.0, 0.5, 1.0])
def test_a_fallen_body_lies_still_on_the_floor(strength):
    pose = standing()
    rotations = pose.rotations.copy()
    rotations[0] = quaternion.from_rotation_vector((0.3, 0.9, 0.4))
    pose = Pose(np.array([0.0, 0.0, 1.2]), rotations)
    states = run(ragdoll.start(MODEL, pose, pose, TICK_S), standing(), 480, strength)
    speeds = [np.abs(ragdoll.read(MODEL, s)[1]).max() for s in states[-60:]]
    assert max(speeds) < 0.03
    assert lowest_m(states[-1]) > -0.01
    assert min(lowest_m(s) for s in states) > -0.04  # at the moment of the fall itself
    assert kinematics.com_of(BODY, ragdoll.pose_of(MODEL, states[-1]))[2] < 0.4


def test_an_arm_is_raised_without_jelly_and_without_stiffness():
    """Half a radian asked of a shoulder in the air: most of the way in a tenth of a second, no wobble after."""
    pose = standing()
    pose = Pose(pose.root_m + [0, 0, 50.0], pose.rotations)
    asked = pose.rotations.copy()
    asked[SHOULDERS[0]] = quaternion.about_x(0.5)
    states = run(ragdoll.start(MODEL, pose, pose, TICK_S), Pose(pose.root_m, asked), 60)
    angle = np.array([
        quaternion.angle_between(ragdoll.pose_of(MODEL, s).rotations[SHOULDERS[0]], quaternion.IDENTITY) for s in states
    ])  # fmt: skip
    assert 0.04 < np.flatnonzero(angle > 0.3)[0] * TICK_S < 0.16
    assert angle.max() < 0.52
    assert angle[-1] == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("strength", [10.0, 100.0])
def test_no_gain_makes_it_explode(strength):
    pose, state = moving(np.random.default_rng(4), 0.3)
    states = run(state, pose, 240, strength)
    assert np.isfinite(states[-1]).all()
    assert np.abs(ragdoll.read(MODEL, states[-1])[1]).max() < 1.0


def test_a_servo_asks_for_no_more_than_a_persons_strength_and_nothing_of_the_root():
    rng = np.random.default_rng(7)
    _, state = moving(rng)
    nv = MODEL.mujoco_model.nv
    torque, armature = np.zeros(nv), np.zeros(nv)
    wide = np.full((21, 3), 10.0)
    qvel = np.zeros(nv)
    target = standing().rotations
    tracking.drive(
        state[MODEL.positions], qvel, target, np.zeros((21, 3)), -wide, wide, MODEL.inertia_kgm2, MODEL.strength_nm,
        1.0, 1.0, 1 / 480, torque, armature,
    )  # fmt: skip
    asked = np.sqrt((torque[3:].reshape(-1, 3) ** 2).sum(1))
    assert (asked <= MODEL.strength_nm + 1e-9).all()
    assert asked.max() > 50.0
    assert (torque[:6] == 0).all()
    assert (armature[:6] == 0).all()
    assert (armature[6:] > 0).all()


def test_limp_joints_stop_at_their_limits_and_keep_what_the_target_oversteps():
    """Dropped without strength, knees and elbows do not go backwards; an overstretched clip's knee stays so."""
    pose = standing()
    pose = Pose(pose.root_m + [0, 0, 0.3], pose.rotations)
    before = Pose(pose.root_m - [0.02, 0.0, 0.0], pose.rotations)
    states = run(ragdoll.start(MODEL, pose, before, TICK_S), pose, 240, strength=0.0)
    excess = np.array([limits.excess_rad(BODY, ragdoll.pose_of(MODEL, s).rotations) for s in states])
    assert math.degrees(excess.max()) < 25.0
    assert math.degrees(excess[-1].max()) < 8.0
    rotations = pose.rotations.copy()
    rotations[KNEES[0]] = quaternion.about_y(-0.3)
    stretched = Pose(pose.root_m + [0, 0, 50.0], rotations)
    states = run(ragdoll.start(MODEL, stretched, stretched, TICK_S), stretched, 30)
    last = ragdoll.pose_of(MODEL, states[-1]).rotations[KNEES[0]]
    assert quaternion.angle_between(last, rotations[KNEES[0]]) < 0.01


def test_a_state_that_has_left_the_numbers_stays_so_and_leaves_no_log_file(tmp_path, monkeypatch):
    """It must reach the world's check as it is, not come back as MuJoCo's rest pose."""
    monkeypatch.chdir(tmp_path)
    pose = standing()
    state = ragdoll.start(MODEL, pose, pose, TICK_S)
    state[MODEL.velocities.start] = np.nan
    assert not np.isfinite(ragdoll.step(MODEL, state, pose, 1.0, 1.0, TICK_S)).all()
    assert list(tmp_path.iterdir()) == []


def test_feet_are_free_to_slip():
    """A standing body pushed along hard goes along: the feet are held by friction alone."""
    pose = standing()
    before = Pose(pose.root_m - [3.0 * TICK_S, 0.0, 0.0], pose.rotations)
    states = run(ragdoll.start(MODEL, pose, before, TICK_S), pose, 24)
    feet = [kinematics.joints_of(BODY, ragdoll.pose_of(MODEL, s))[0][15, 0] for s in states]
    assert feet[-1] - feet[0] > 0.05
