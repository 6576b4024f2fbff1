"""A person who stands, and one who flies: what the physics tests start from, and momentum and energy summed by hand."""

from __future__ import annotations

import numpy as np

from engine.body import footing, kinematics
from engine.body.anthropometry import standard_body
from engine.body.capsules import body_capsules
from engine.body.skeleton import PARENT, Pose
from engine.maths.rotations import rotate, to_matrix
from engine.physics import ragdoll, tracking
from engine.physics.impact import Material
from engine.physics.model import model_for
from tests.body.poses import identity_pose, random_pose

TICK_S = 1.0 / 120.0
VOLLEYBALL_ON_SKIN, CONTACT_S = Material(0.65, 0.6), 0.010
BODY = standard_body()
MODEL = model_for(BODY)
SHAPES = body_capsules(BODY)


def standing(body=BODY) -> Pose:
    """The identity pose with its soles on the floor."""
    pose = identity_pose(0.0)
    height = -footing.lowest_sole_m(body, *kinematics.joints_of(body, pose))
    return Pose(np.array([0.0, 0.0, height]), pose.rotations)


def moving(rng: np.random.Generator, height_m: float = 5.0):
    """A random pose high in the air, every joint turning, and its state."""
    pose = random_pose(rng)
    pose = Pose(pose.root_m + [0, 0, height_m], pose.rotations)
    return pose, ragdoll.state_of(MODEL, pose, rng.normal(size=MODEL.mujoco_model.nv))


def parts(model, state):
    """Of each part: mass (J,), COM (J, 3), its velocity (J, 3), inertia (J, 3, 3) and spin (J, 3), all in the world."""
    body, qpos, qvel = model.body, state[model.positions], state[model.velocities]
    positions, orientations = tracking.world_frames(PARENT, body.offset_m, qpos)
    _, spin = tracking.joint_velocities(PARENT, body.offset_m, qpos, qvel)
    velocity = tracking.part_velocities(PARENT, body.offset_m, body.part_com_m, qpos, qvel)
    frames = to_matrix(orientations)
    inertia = frames @ body.part_inertia_kgm2 @ frames.swapaxes(1, 2)
    return body.part_mass_kg, positions + rotate(orientations, body.part_com_m), velocity, inertia, spin


def momentum(model, state):
    """Linear (3,) and angular (3,) momentum about the world's origin."""
    mass, com, velocity, inertia, spin = parts(model, state)
    p = mass[:, None] * velocity
    return p.sum(0), (np.cross(com, p) + np.einsum("jab,jb->ja", inertia, spin)).sum(0)


def kinetic_energy(model, state):
    """Joules."""
    mass, _, velocity, inertia, spin = parts(model, state)
    return 0.5 * (mass * (velocity**2).sum(1)).sum() + 0.5 * np.einsum("ja,jab,jb->", spin, inertia, spin)


def energy(model, state):
    """Kinetic and potential, joules."""
    mass, com, *_ = parts(model, state)
    return kinetic_energy(model, state) + 9.80665 * (mass * com[:, 2]).sum()
