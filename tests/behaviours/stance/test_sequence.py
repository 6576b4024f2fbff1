"""Poses joined into movement: feet that stay to the last bit, balance by feedback, steps, heels that rise."""

import numpy as np
import pytest

from behaviours.stance import footprints, sequence, stepping
from behaviours.stance.shape import shape
from behaviours.stance.solve import solve_shape, solve_stance
from demos.benchmarks.stance_bars import crouch_twist_shift
from engine.body.skeleton import ANKLES, PELVIS, TOES
from engine.maths import quaternion


def jerk(frames):
    """The farthest that any joint moves in one tick, metres, and how much that changes to the next."""
    joints = np.array([f.joints_m for f in frames])
    moved = np.diff(joints, axis=0)
    return np.abs(moved).max(), np.abs(np.diff(moved, axis=0)).max()


@pytest.mark.parametrize("width_m", [0.12, 0.42])
def test_crouch_twist_and_shift_leave_the_feet_where_they_are(body, width_m):
    start, moves = crouch_twist_shift(body, width_m)
    frames = list(sequence.frames(body, start, moves))
    ankles = np.array([f.joints_m[list(ANKLES)] for f in frames])
    assert np.abs(ankles - start.feet.ankle_m).max() < 1e-7
    turned = [
        quaternion.angle_between(f.orientations[ANKLES[s]], start.feet.foot_turned[s]) for f in frames for s in (0, 1)
    ]
    assert max(turned) < 1e-6
    pelvis = np.array([f.joints_m[PELVIS] for f in frames])
    assert np.ptp(pelvis[:, 2]) > 0.1  # it did crouch
    assert np.ptp(pelvis[:, 1]) > 0.02  # and shift


def test_balance_is_kept_by_feedback(body):
    start, moves = crouch_twist_shift(body, 0.3)
    frames = list(sequence.frames(body, start, moves))
    errors = np.array([np.hypot(*(f.com_m[:2] - f.com_wanted_m)) for f in frames])
    ends = np.cumsum([round((m.move_s + m.hold_s) * 120) for m in moves]) - 1
    assert errors[ends].max() < 0.005
    assert errors.max() < 0.05


def test_a_move_ends_in_the_stance_it_goes_to(body):
    start = solve_stance(body, "posture", 0.0)
    for name, intensity in (("posture", -0.9), ("beauty-line", 0.8), ("beauty-line", -0.8), ("slovenly", 1.0)):
        end = solve_stance(body, name, intensity, feet=start.feet)
        frames = list(sequence.frames(body, start, [sequence.Move(end, 0.6, 0.6)]))
        assert frames[-1].joints_m == pytest.approx(end.joints_m, abs=1e-3)


def test_it_eases_in_and_out_and_never_jerks_even_where_the_dominant_foot_changes(body):
    start = solve_stance(body, "beauty-line", 0.8)
    other = solve_stance(body, "beauty-line", -0.8, feet=start.feet)
    assert start.plan.lower.root != other.plan.lower.root
    frames = list(sequence.frames(body, start, [sequence.Move(other, 0.8, 0.4), sequence.Move(start, 0.8, 0.4)]))
    moved, change = jerk(frames)
    assert moved < 0.02
    assert change < 0.003
    first = np.linalg.norm(frames[0].joints_m - start.joints_m, axis=1).max()
    assert first < 0.001


def test_a_wider_stance_is_stepped_into(body):
    start = solve_stance(body, "posture", 0.2)
    end = solve_stance(body, "posture", 0.2, feet=footprints.stand(body, width_m=0.42))
    frames = list(sequence.frames(body, start, stepping.steps_to(body, start, end)))
    planted = np.array([f.planted for f in frames])
    ankles = np.array([f.joints_m[list(ANKLES)] for f in frames])
    assert planted.any(axis=1).all()  # never both feet in the air
    for side in range(2):
        both = planted[1:, side] & planted[:-1, side]
        assert np.abs(np.diff(ankles[:, side], axis=0))[both].max() < 1e-7
        assert ankles[:, side, 2].max() > start.feet.ankle_m[side, 2] + 0.04
    # no foot is lifted that carries weight: the centre of mass is then nearer to the other one
    for frame in frames:
        if not frame.planted.all():
            down = int(np.flatnonzero(frame.planted)[0])
            away = [np.hypot(*(frame.com_m[:2] - frame.joints_m[a][:2])) for a in ANKLES]
            assert away[down] < away[1 - down]
    assert frames[-1].joints_m == pytest.approx(end.joints_m, abs=2e-3)


def test_heels_rise_about_the_balls(body):
    start = solve_stance(body, "posture", 0.0)
    up = solve_shape(body, shape(rise_rad=0.5), start.feet)
    frames = list(sequence.frames(body, start, [sequence.Move(up, 0.8, 0.4), sequence.Move(start, 0.8, 0.2)]))
    toes = np.array([f.joints_m[list(TOES)] for f in frames])
    assert np.abs(toes - toes[0]).max() < 1e-7
    heights = np.array([f.joints_m[ANKLES[0], 2] for f in frames])
    assert np.ptp(heights) > 0.03


def test_pelvis_angles_are_what_the_lower_body_was_asked_for(body):
    wanted = shape(
        pelvis_x_rad=0.2,
        pelvis_y_rad=-0.3,
        pelvis_z_rad=0.1,
        trade_off="pelvis_exact",
        knee_left_rad=0.5,
        knee_right_rad=0.5,
    )
    result = solve_shape(body, wanted)
    held = sequence.held(body, result)
    assert held.pelvis_rad == pytest.approx([0.2, -0.3, 0.1], abs=1e-6)
    offsets = sequence.offsets_of(
        result.feet, result.plan.lower.root, result.joints_m[(13, 17)[result.plan.lower.root]]
    )
    assert offsets == pytest.approx(result.balance_rad, abs=1e-6)


@pytest.mark.parametrize("side", [0, 1])
def test_the_foot_that_stays_down_is_dominant_whatever_is_asked(body, side):
    """One foot steps aside; the stance it steps into names that very foot. The other carries the balance and stays."""
    name = ("left", "right")[side]
    start = solve_shape(body, shape(knee_left_rad=0.3, knee_right_rad=0.3))
    feet = [np.array(part) for part in start.feet]
    feet[0][side, 1] += 0.12 * (1 - 2 * side)
    end = solve_shape(body, shape(dominant=name, knee_left_rad=0.3, knee_right_rad=0.3), footprints.Footprints(*feet))
    assert end.plan.lower.root == side
    assert sequence.standing_root(body, start.feet, end.feet, side) == 1 - side
    frames = list(sequence.frames(body, start, [sequence.Move(end, 0.6, 0.3)]))
    stays, goes = (np.array([f.joints_m[ANKLES[k]] for f in frames]) for k in (1 - side, side))
    assert np.abs(stays - start.joints_m[ANKLES[1 - side]]).max() < 1e-9
    assert goes[:, 2].max() > start.joints_m[ANKLES[side], 2] + 0.03
    last = frames[-1]
    assert np.hypot(*(last.com_m[:2] - last.com_wanted_m)) < 5e-3
