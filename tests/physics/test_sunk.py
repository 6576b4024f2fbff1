"""Feet that begin in the floor: let out gently, and held up like any other once they are out."""

import numpy as np

from engine.body import kinematics, limits, support
from engine.body.skeleton import ANKLES, Pose
from engine.physics import ragdoll, sunk
from engine.physics.layout import SHAPES
from tests.physics.standing import BODY, MODEL, TICK_S, standing

ROLLED = 0.6  # of the left foot about its own length: an edge some centimetres under ground


def on_a_rolled_foot():
    """A pose whose left foot is rolled over its edge, into the floor."""
    pose = standing()
    rotations = pose.rotations.copy()
    rotations[ANKLES[0]] = limits.from_components(ROLLED, 0.0, 0.0)
    return Pose(pose.root_m, rotations)


def fastest_mps(lets_lie: bool):
    """Of all joints in the first two ticks, and what is left under ground after that, tick by tick."""
    pose = on_a_rolled_foot()
    state = ragdoll.start(MODEL, pose, pose, TICK_S)
    deep_m = sunk.depths_m(MODEL, state)
    fastest, depths = 0.0, [deep_m.max()]
    for tick in range(60):
        state = ragdoll.step(MODEL, state, pose, 1.0, 1.0, TICK_S, carries=1.0, sunk_m=deep_m if lets_lie else None)
        deep_m = sunk.risen(MODEL, state, deep_m, TICK_S)
        depths.append(sunk.depths_m(MODEL, state).max())
        if tick < 2:
            fastest = max(fastest, np.linalg.norm(ragdoll.motion_of(MODEL, state)[0], axis=1).max())
    return fastest, np.array(depths)


def test_depths_are_those_of_the_soles():
    pose = on_a_rolled_foot()
    depths_m = sunk.depths_m(MODEL, ragdoll.start(MODEL, pose, pose, TICK_S))
    lowest_m = support.sole_points(BODY, *kinematics.joints_of(BODY, pose))[..., 2].min()
    assert depths_m.shape == (SHAPES,)
    assert 0.005 < -lowest_m <= depths_m.max() + 1e-12
    assert depths_m.max() < -lowest_m + 0.01


def test_a_foot_that_begins_in_the_floor_throws_nobody():
    thrown, _ = fastest_mps(lets_lie=False)
    gentle, depths_m = fastest_mps(lets_lie=True)
    assert thrown > 0.6
    assert gentle < 0.06
    assert depths_m[-1] < 0.002
    assert np.diff(depths_m).min() > -1.2 * sunk.RISES_MPS * TICK_S


def test_a_shape_that_is_out_stays_out():
    pose = standing()
    high = Pose(pose.root_m + [0.0, 0.0, 0.5], pose.rotations)
    state = ragdoll.start(MODEL, high, high, TICK_S)
    assert (sunk.risen(MODEL, state, np.full(SHAPES, 0.03), TICK_S) == 0.0).all()


def test_on_even_ground_nothing_changes():
    pose = standing()
    state = ragdoll.start(MODEL, pose, pose, TICK_S)
    none = np.zeros(SHAPES)
    assert (
        ragdoll.step(MODEL, state, pose, 1.0, 1.0, TICK_S, sunk_m=none).tobytes()
        == ragdoll.step(MODEL, state, pose, 1.0, 1.0, TICK_S).tobytes()
    )
