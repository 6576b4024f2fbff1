"""Parts that lie in the floor when the physics takes a body over: they are let out gently, not thrown out.

A clip's foot rolls, and what is held where a clip has it may have an edge some centimetres under ground. A floor that
is stiff would answer with ten times the body's weight at once. So each shape keeps the depth that it begins with,
which shrinks at a walker's slowest pace; once it is out, it stays out.
"""

from __future__ import annotations

import mujoco
import numpy as np

from engine.physics.model import RagdollModel

RISES_MPS = 0.1


def depths_m(model: RagdollModel, state: np.ndarray) -> np.ndarray:
    """(S,) how far the lowest place of each shape is under the floor, metres, 0 above; in MuJoCo's order, floor left
    out.
    """
    m, d = model.mujoco_model, model.data
    mujoco.mj_setState(m, d, np.ascontiguousarray(state, dtype=float), mujoco.mjtState.mjSTATE_INTEGRATION)
    mujoco.mj_kinematics(m, d)
    half_m = np.where(m.geom_type == mujoco.mjtGeom.mjGEOM_CAPSULE, m.geom_size[:, 1], 0.0)
    lowest_m = d.geom_xpos[:, 2] - np.abs(d.geom_xmat[:, 8]) * half_m - m.geom_size[:, 0]
    return np.maximum(0.0, -lowest_m[1:])


def risen(model: RagdollModel, state: np.ndarray, sunk_m: np.ndarray, dt_s: float) -> np.ndarray:
    """(S,) how deep each shape may still lie after dt_s that ended in this state."""
    if not sunk_m.any():
        return sunk_m
    return np.minimum(np.maximum(0.0, sunk_m - RISES_MPS * dt_s), depths_m(model, state))
