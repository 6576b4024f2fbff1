"""The weight that muscles carry from the start: MuJoCo's own statics, and a body that does not sag."""

import mujoco
import numpy as np
import pytest

from engine.body import kinematics, limits
from engine.body.skeleton import ANKLES, HEAD, JOINT_COUNT, JOINTS, PARENT, Pose
from engine.maths.ballistics import GRAVITY_MPS2
from engine.physics import ragdoll, weight
from tests.physics.standing import BODY, MODEL, TICK_S, standing

G = -GRAVITY_MPS2[2]
CROUCH = {"hip": -0.9, "knee": 1.5, "ankle": -0.6, "shoulder": -1.2, "waist": 0.5}


def crouching(aside: float = 0.0):
    """Deep in the knees, leaning forwards, arms ahead, the feet flat on the floor."""
    rotations = standing().rotations.copy()
    for j, name in enumerate(JOINTS):
        bent = CROUCH.get(name.removeprefix("left_").removeprefix("right_"), 0.0)
        if bent:
            rotations[j] = limits.from_components(aside if name == "waist" else 0.0, bent, 0.0)
    pose = Pose(standing().root_m, rotations)
    height = kinematics.joints_of(BODY, standing())[0][ANKLES[0], 2] - kinematics.joints_of(BODY, pose)[0][ANKLES[0], 2]
    return Pose(pose.root_m + [0.0, 0.0, height], rotations)


def torques_in(pose, most_nm=1e9):
    nv = MODEL.mujoco_model.nv
    torque, qpos = np.zeros(nv), ragdoll.start(MODEL, pose, pose, TICK_S)[MODEL.positions]
    weight.carry(PARENT, BODY, qpos, G, 1.0, np.full(JOINT_COUNT, most_nm), torque)
    return torque


@pytest.mark.parametrize("aside", [0.0, 0.3])
def test_it_is_what_mujoco_says_of_standing_still(aside):
    pose = crouching(aside)
    torque = torques_in(pose)
    m, d = MODEL.mujoco_model, MODEL.data
    ragdoll._load(MODEL, ragdoll.start(MODEL, pose, pose, TICK_S))
    mujoco.mj_forward(m, d)
    wanted = d.qfrc_bias.copy()
    places, forces_n = weight.ground(
        BODY, *kinematics.joints_of(BODY, pose), kinematics.com_of(BODY, pose), MODEL.mass_kg * G
    )
    for side in range(2):
        jacobian = np.zeros((3, m.nv))
        mujoco.mj_jac(m, d, jacobian, None, places[side], ANKLES[side] + 1)
        wanted -= jacobian.T @ [0.0, 0.0, forces_n[side]]
    np.testing.assert_allclose(torque[6:], wanted[6:], atol=1e-9)
    assert (torque[:6] == 0.0).all()
    assert np.abs(torque).max() > 30.0
    if aside == 0.0:  # the ground is under the centre of mass: nothing is left for the root
        np.testing.assert_allclose(wanted[:6], 0.0, atol=1e-9)
        assert forces_n[0] == pytest.approx(forces_n[1])
    else:
        assert abs(forces_n[0] - forces_n[1]) > 20.0


def test_who_crouches_does_not_sag_when_the_physics_takes_over():
    pose = crouching()

    def sag_m(carries):
        state = ragdoll.start(MODEL, pose, pose, TICK_S)
        for _ in range(24):
            state = ragdoll.step(MODEL, state, pose, 1.0, 1.0, TICK_S, carries=carries)
        at = kinematics.joints_of(BODY, ragdoll.pose_of(MODEL, state))[0][HEAD]
        return np.linalg.norm(at - kinematics.joints_of(BODY, pose)[0][HEAD])

    assert sag_m(1.0) < 0.002
    assert sag_m(0.0) > 0.01


def test_nobody_in_the_air_carries_anything_and_none_more_than_a_joint_can():
    pose = crouching()
    assert (torques_in(Pose(pose.root_m + [0.0, 0.0, 0.5], pose.rotations)) == 0.0).all()
    norms = np.linalg.norm(torques_in(pose, 20.0)[3:].reshape(-1, 3), axis=1)
    assert norms.max() == pytest.approx(20.0)
