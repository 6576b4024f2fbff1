"""A movement that a blow cuts short: half-lives by a numeric search, no brake at the hand-over, limits kept."""

import numpy as np
import pytest

from behaviours.respond import arriving
from engine.body import limits
from engine.body.skeleton import HEAD, JOINT_COUNT, JOINTS, KNEES, Pose
from engine.maths import quaternion, springs
from engine.physics import ragdoll
from tests.physics.standing import BODY, MODEL, TICK_S, standing

MOMENT_S = 1e-5
MOST_S = 0.2
WAIST, NECK = JOINTS.index("waist"), JOINTS.index("neck")


def farthest(offset, velocity, half_life_s):
    """The greatest value of the dying offset, looked for on a fine grid."""
    return max(springs.decaying(offset, velocity, half_life_s, t)[0] for t in np.linspace(0.0, 1.0, 4001))


@pytest.mark.parametrize("offset", [-0.2, -0.05, 0.0, 0.03])
@pytest.mark.parametrize("velocity", [0.5, 3.0, 8.0])
@pytest.mark.parametrize("room", [0.01, 0.05, 0.3])
def test_it_swings_no_farther_than_there_is_room(offset, velocity, room):
    half_life_s = arriving.half_life_within(offset, velocity, room, MOST_S)
    assert arriving.SOONEST_S <= half_life_s <= MOST_S
    if half_life_s > arriving.SOONEST_S:
        assert farthest(offset, velocity, half_life_s) <= max(room, offset) + 1e-6
    if half_life_s < MOST_S:  # and no sooner than need be
        assert farthest(offset, velocity, half_life_s + 0.002) > max(room, offset)


def bent(waist, neck=0.0):
    """(J, 4) standing, bent forwards at waist and neck, radians."""
    rotations = standing().rotations.copy()
    rotations[WAIST] = limits.from_components(0.0, waist, 0.0)
    rotations[NECK] = limits.from_components(0.0, neck, 0.0)
    return rotations


def measured(held, now, ahead, stands=(True, True)):
    turns, half_life_s = np.empty((2, JOINT_COUNT, 3)), np.empty(JOINT_COUNT)
    arriving.measure(BODY, held, now, ahead, MOMENT_S, MOST_S, np.array(stands), turns, half_life_s)
    return turns, half_life_s


def test_at_first_it_is_the_movement_itself_and_in_the_end_the_held_pose():
    held, now, ahead = bent(0.6, 0.2), bent(0.5, 0.1), bent(0.5 + 3.0 * MOMENT_S, 0.1 + 2.0 * MOMENT_S)
    turns, half_life_s = measured(held, now, ahead)
    for elapsed_s, like in ((0.0, now), (MOMENT_S, ahead), (5.0, held)):
        rotations = held.copy()
        arriving.add(BODY, turns, half_life_s, elapsed_s, rotations)
        angles = [quaternion.angle_between(a, b) for a, b in zip(rotations, like, strict=True)]
        assert max(angles) < 2e-8


def test_no_limit_is_passed_on_the_way():
    high = float(BODY.limit_high_rad[NECK, 1])
    held, now = bent(0.3, high - 0.02), bent(0.2, high - 0.1)
    turns, half_life_s = measured(held, now, bent(0.2, high - 0.1 + 8.0 * MOMENT_S))
    assert half_life_s[NECK] < MOST_S
    assert half_life_s[WAIST] == MOST_S
    for elapsed_s in np.linspace(0.0, 0.5, 120):
        rotations = held.copy()
        arriving.add(BODY, turns, half_life_s, float(elapsed_s), rotations)
        assert limits.excess_rad(BODY, rotations).max() < 1e-9


def test_a_leg_in_the_air_swings_no_farther_than_its_pose():
    """What is beyond that may be the floor. The other, which stands, may."""
    held, now, ahead = bent(0.0), bent(0.0), bent(0.0)
    for side in range(2):
        now[KNEES[side]] = limits.from_components(0.0, 0.6, 0.0)
        ahead[KNEES[side]] = limits.from_components(0.0, 0.6 - 5.0 * MOMENT_S, 0.0)
        held[KNEES[side]] = limits.from_components(0.0, 0.5, 0.0)
    turns, half_life_s = measured(held, now, ahead, (True, False))
    least = np.full(2, 1.0)
    for elapsed_s in np.linspace(0.0, 0.5, 120):
        rotations = held.copy()
        arriving.add(BODY, turns, half_life_s, float(elapsed_s), rotations)
        for side in range(2):
            least[side] = min(least[side], limits.components(rotations[KNEES[side]])[1])
    assert least[0] < 0.48
    assert least[1] > 0.49


def test_no_brake_is_pulled_at_the_hand_over():
    """A trunk on its way down is slowed gently where the target goes on with it, and at once where that stands still:
    servo damping times speed, twice two pi times its frequency."""
    rate = 4.0
    held, now, before = bent(0.52), bent(0.5), bent(0.5 - rate * TICK_S)
    pose = Pose(standing().root_m, now)
    start = ragdoll.start(MODEL, pose, Pose(pose.root_m, before), TICK_S)
    turns, half_life_s = measured(held, now, bent(0.5 + rate * MOMENT_S))

    def target(tick):
        rotations = held.copy()
        arriving.add(BODY, turns, half_life_s, tick * TICK_S, rotations)
        return Pose(pose.root_m, rotations)

    def peak_mps2(follows):
        state, velocity = start, [ragdoll.part_motion_of(MODEL, start)[HEAD]]
        for tick in range(1, 13):
            trace = np.empty((ragdoll.sub_steps_in(TICK_S), JOINT_COUNT, 3))
            goes, came = (target(tick), target(tick - 1)) if follows else (Pose(pose.root_m, held), None)
            state = ragdoll.step(MODEL, state, goes, 1.0, 1.0, TICK_S, trace=trace, target_before=came, carries=1.0)
            velocity.extend(trace[:, HEAD])
        return np.linalg.norm(np.diff(velocity, axis=0), axis=1).max() * 480.0

    assert peak_mps2(False) > 25.0
    assert peak_mps2(True) < 0.6 * peak_mps2(False)
