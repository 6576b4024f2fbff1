"""Our kinematics, masses and velocities against MuJoCo's own, and the other way round."""

import mujoco
import numpy as np
import pytest

from engine.body import kinematics
from engine.body.anthropometry import standard_body
from engine.body.skeleton import JOINT_COUNT, Pose
from engine.maths.rotations import to_matrix
from engine.physics import ragdoll
from engine.physics.model import body_key, model_for, xml_of
from tests.body.poses import random_pose
from tests.physics.standing import BODY, MODEL, moving

BODIES = [BODY, standard_body(1.6, "female", 55.0)]


@pytest.mark.parametrize("body", BODIES)
def test_masses_centres_and_inertias_are_ours(body):
    m = model_for(body).mujoco_model
    np.testing.assert_array_equal(m.body_mass[1:], body.part_mass_kg)
    np.testing.assert_array_equal(m.body_ipos[1:], body.part_com_m)
    frames = to_matrix(m.body_iquat[1:])
    inertia = np.einsum("jab,jb,jcb->jac", frames, m.body_inertia[1:], frames)
    np.testing.assert_allclose(inertia, body.part_inertia_kgm2, atol=1e-12)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("seed", range(5))
def test_kinematics_and_centre_of_mass_are_mujocos(body, seed):
    model, pose = model_for(body), random_pose(np.random.default_rng(seed), 1.0)
    ragdoll.state_of(model, pose, np.zeros(model.mujoco_model.nv))
    mujoco.mj_forward(model.mujoco_model, model.data)
    positions, orientations = kinematics.joints_of(body, pose)
    np.testing.assert_allclose(model.data.xpos[1:], positions, atol=1e-9)
    np.testing.assert_allclose(np.abs((model.data.xquat[1:] * orientations).sum(1)), 1.0, atol=1e-12)
    np.testing.assert_allclose(model.data.subtree_com[0], kinematics.com_of(body, pose), atol=1e-9)


def test_joint_velocities_are_mujocos_and_the_difference_of_two_poses():
    _, state = moving(np.random.default_rng(2))
    d = MODEL.data
    mujoco.mj_forward(MODEL.mujoco_model, d)
    linear, angular = ragdoll.motion_of(MODEL, state)
    theirs = np.empty(6)
    for j in range(JOINT_COUNT):
        mujoco.mj_objectVelocity(MODEL.mujoco_model, d, mujoco.mjtObj.mjOBJ_XBODY, j + 1, theirs, 0)
        np.testing.assert_allclose(angular[j], theirs[:3], atol=1e-12)
        np.testing.assert_allclose(linear[j], theirs[3:], atol=1e-12)
    # and a small step along them is where a body started from two poses goes
    rng, dt = np.random.default_rng(3), 1e-6
    before, pose = random_pose(rng), None
    pose = Pose(before.root_m + 1e-6, before.rotations)
    state = ragdoll.start(MODEL, pose, before, dt)
    p0, p1 = (kinematics.joints_of(BODY, p)[0] for p in (before, pose))
    np.testing.assert_allclose(ragdoll.motion_of(MODEL, state)[0], (p1 - p0) / dt, atol=1e-4)


def test_a_body_started_from_two_successive_poses_moves_as_they_did():
    rng = np.random.default_rng(6)
    dt = 1e-5
    one, state = moving(rng)
    d = MODEL.data
    mujoco.mj_integratePos(MODEL.mujoco_model, d.qpos, state[MODEL.velocities].copy(), dt)
    other = Pose(d.qpos[:3].copy(), d.qpos[3:].reshape(JOINT_COUNT, 4).copy())
    again = ragdoll.start(MODEL, other, one, dt)
    np.testing.assert_allclose(again[MODEL.velocities], state[MODEL.velocities], atol=1e-6)
    pose, velocities = ragdoll.read(MODEL, again)
    np.testing.assert_allclose(pose.rotations, other.rotations, atol=1e-12)
    moved = kinematics.joints_of(BODY, other)[0] - kinematics.joints_of(BODY, one)[0]
    np.testing.assert_allclose(velocities, moved / dt, atol=1e-3)


def test_one_body_has_one_model_and_its_text_never_changes():
    again = standard_body()
    assert model_for(again) is MODEL
    assert body_key(again) == body_key(BODY)
    assert xml_of(again) == xml_of(BODY)
    assert model_for(BODIES[1]) is not MODEL


def test_the_state_holds_positions_and_velocities_where_it_says():
    pose, state = moving(np.random.default_rng(9))
    assert state.shape == (MODEL.state_size,)
    np.testing.assert_array_equal(state[MODEL.positions][:3], pose.root_m)
    np.testing.assert_array_equal(state[MODEL.positions][3:], pose.rotations.reshape(-1))
    np.testing.assert_array_equal(state[MODEL.velocities], MODEL.data.qvel)
