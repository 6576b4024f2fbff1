"""The appendix's algorithm: feet exact, knees exact, the pelvis as near as the circle lets it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from behaviours.stance import footprints, lower_body
from engine.body import kinematics
from engine.body.skeleton import ANKLES, HIPS, JOINT_COUNT, KNEES, PELVIS, TOES
from engine.maths import quaternion

angles = st.floats(-0.5, 0.5).map(lambda x: round(x, 6))
knees = st.floats(0.05, 1.4).map(lambda x: round(x, 6))


@st.composite
def asks(draw, exact_pelvis=False):
    """(LowerBody of a body still to come as keyword arguments, balance offsets)"""
    feet = {
        "width_m": 0.3 + 0.4 * draw(angles),
        "ahead_m": 0.5 * draw(angles),
        "heading_rad": 6.0 * draw(angles),
        "place_m": (draw(angles), draw(angles)),
    }
    wanted = {
        "root": draw(st.integers(0, 1)),
        "knee_rad": np.array([draw(knees), draw(knees)]),
        "pelvis_rad": np.array([draw(angles), draw(angles), 0.4 * draw(angles)]),
        "pelvis_exact": exact_pelvis,
    }
    return feet, wanted, (0.3 * draw(angles), 0.3 * draw(angles))


def solved(body, case):
    feet, wanted, offsets = case
    stand = footprints.stand(body, **feet)
    asked = lower_body.ask(body, *stand, *wanted.values())
    root_m, rotations = np.zeros(3), np.tile([1.0, 0.0, 0.0, 0.0], (JOINT_COUNT, 1))
    lower_body.solve_lower_body(body, asked, offsets, root_m, rotations)
    positions, orientations = np.zeros((JOINT_COUNT, 3)), np.zeros((JOINT_COUNT, 4))
    kinematics.joints_into(body.offset_m, root_m, rotations, positions, orientations)
    return asked, rotations, positions, orientations


def reachable(asked, positions):
    """Whether hips and foot could be brought together at all with these knees."""
    free = 1 - asked.root
    a = np.linalg.norm(positions[HIPS[asked.root]] - asked.ankle_m[free])
    return abs(a - asked.hip_width_m) < asked.leg_m[free] < a + asked.hip_width_m


@given(asks())
def test_feet_stay_and_knees_are_as_asked(body, case):
    asked, rotations, positions, orientations = solved(body, case)
    if not reachable(asked, positions):
        return
    for side in range(2):
        assert positions[ANKLES[side]] == pytest.approx(asked.ankle_m[side], abs=1e-9)
        assert quaternion.angle_between(orientations[ANKLES[side]], asked.foot_turned[side]) < 1e-7
        flexion = 2.0 * np.arctan2(rotations[KNEES[side], 2], rotations[KNEES[side], 0])
        assert flexion == pytest.approx(asked.knee_rad[side], abs=1e-6)


@given(asks())
def test_the_root_hip_hangs_on_knee_and_offsets_alone(body, case):
    asked, _, positions, _ = solved(body, case)
    leg = positions[HIPS[asked.root]] - asked.ankle_m[asked.root]
    assert np.linalg.norm(leg) == pytest.approx(asked.leg_m[asked.root], abs=1e-9)
    # +X swings ahead, +Z to the right, in the frame of the line through the ankles
    ahead, left = (quaternion.rotate(asked.facing, axis) for axis in ((1, 0, 0), (0, 1, 0)))
    x, z = case[2]
    assert np.sign(leg @ ahead) == np.sign(x) or abs(x) < 1e-3
    assert np.sign(leg @ left) == -np.sign(z) or abs(z) < 1e-3


@given(asks())
def test_the_free_hip_is_the_circles_nearest_point(body, case):
    """Against a thousand points of the circle: none lies nearer to the end of the wanted hip vector."""
    asked, _, positions, _ = solved(body, case)
    if not reachable(asked, positions):
        return
    root_hip, foot = positions[HIPS[asked.root]], asked.ankle_m[1 - asked.root]
    a = np.linalg.norm(foot - root_hip)
    axis = (foot - root_hip) / a
    w, c = asked.hip_width_m, asked.leg_m[1 - asked.root]
    along = (a * a + w * w - c * c) / (2 * a)
    radius = np.sqrt(w * w - along * along)
    u = np.cross(axis, [0.3, 0.5, 0.8])
    u /= np.linalg.norm(u)
    turn = np.linspace(0, 2 * np.pi, 1000)[:, None]
    circle = root_hip + along * axis + radius * (np.cos(turn) * u + np.sin(turn) * np.cross(axis, u))
    wanted = root_hip + w * asked.hip_vector
    found = positions[HIPS[1 - asked.root]]
    assert np.linalg.norm(found - wanted) <= np.linalg.norm(circle - wanted, axis=1).min() + 1e-9


@given(asks())
def test_extending_the_hip_vector_to_the_plane_leads_to_the_same_point(body, case):
    """The paper's first way: intersect, then move to the nearest point of the circle. Where the vector meets the
    plane at all.
    """
    asked, _, positions, _ = solved(body, case)
    root_hip, foot = positions[HIPS[asked.root]], asked.ankle_m[1 - asked.root]
    if not reachable(asked, positions):
        return
    a = np.linalg.norm(foot - root_hip)
    axis = (foot - root_hip) / a
    w, c = asked.hip_width_m, asked.leg_m[1 - asked.root]
    along = (a * a + w * w - c * c) / (2 * a)
    towards = asked.hip_vector @ axis
    if abs(towards) < 0.02 or along / towards <= 0.0:
        return
    hit = root_hip + asked.hip_vector * (along / towards)
    centre = root_hip + along * axis
    out = (hit - centre) / np.linalg.norm(hit - centre)
    assert positions[HIPS[1 - asked.root]] == pytest.approx(centre + np.sqrt(w * w - along * along) * out, abs=1e-7)


@given(asks(exact_pelvis=True))
def test_the_other_trade_off_keeps_the_pelvis_and_lets_the_free_knee_give(body, case):
    asked, _, positions, _ = solved(body, case)
    free = 1 - asked.root
    wanted = positions[HIPS[asked.root]] + asked.hip_width_m * asked.hip_vector
    if np.linalg.norm(wanted - asked.ankle_m[free]) <= asked.leg_m[free]:
        assert positions[HIPS[free]] == pytest.approx(wanted, abs=1e-9)
    elif reachable(asked, positions):
        # the leg is too short for it: it is straight, and the pelvis goes as far as it lets it
        assert np.linalg.norm(positions[HIPS[free]] - asked.ankle_m[free]) == pytest.approx(asked.leg_m[free], abs=1e-7)
    else:
        return
    assert positions[ANKLES[free]] == pytest.approx(asked.ankle_m[free], abs=1e-9)


@given(asks())
def test_knees_point_over_the_toes(body, case):
    """Hip, knee, ankle and the foot's direction lie in one plane, the knee on the side of the toes."""
    _, _, positions, orientations = solved(body, case)
    for side in range(2):
        hip, knee, ankle = (positions[j[side]] for j in (HIPS, KNEES, ANKLES))
        toes = np.array(quaternion.rotate(orientations[ANKLES[side]], (1.0, 0.0, 0.0)))
        leg = (hip - ankle) / np.linalg.norm(hip - ankle)
        bent = (knee - ankle) - ((knee - ankle) @ leg) * leg
        if np.linalg.norm(bent) < 1e-3:
            continue
        assert bent @ toes > 0.0
        assert abs(np.cross(leg, toes) @ bent) < 1e-9


def test_pelvis_x_tips_forward_about_the_hips(body):
    def with_x(x):
        wanted = {"root": 0, "knee_rad": np.full(2, 0.3), "pelvis_rad": np.array([x, 0.0, 0.0]), "pelvis_exact": False}
        return solved(body, ({}, wanted, (0.0, 0.0)))

    still, tipped = with_x(0.0), with_x(0.2)
    assert quaternion.angle_between(still[3][PELVIS], tipped[3][PELVIS]) == pytest.approx(0.2)
    up = quaternion.rotate(tipped[3][PELVIS], (0.0, 0.0, 1.0))
    assert up[0] == pytest.approx(np.sin(0.2), abs=1e-9)
    assert tipped[2][list(HIPS)] == pytest.approx(still[2][list(HIPS)], abs=1e-12)


def test_a_foot_out_of_reach_is_reached_for(body):
    """Unreachable input: nothing breaks, the leg is straight towards the foot, and kinematics shows by how much it
    misses.
    """
    feet = footprints.stand(body, width_m=2.4)
    asked = lower_body.ask(body, *feet, 0, np.full(2, 0.1), np.zeros(3), False)
    root_m, rotations = np.zeros(3), np.tile([1.0, 0.0, 0.0, 0.0], (JOINT_COUNT, 1))
    lower_body.solve_lower_body(body, asked, (0.0, 0.0), root_m, rotations)
    assert np.isfinite(rotations).all()
    positions, orientations = np.zeros((JOINT_COUNT, 3)), np.zeros((JOINT_COUNT, 4))
    kinematics.joints_into(body.offset_m, root_m, rotations, positions, orientations)
    leg, to_foot = positions[ANKLES[1]] - positions[HIPS[1]], feet.ankle_m[1] - positions[HIPS[1]]
    straight = np.linalg.norm(body.offset_m[KNEES[1]]) + np.linalg.norm(body.offset_m[ANKLES[1]])
    assert np.linalg.norm(leg) == pytest.approx(straight, abs=1e-3)
    assert leg @ to_foot / np.linalg.norm(leg) / np.linalg.norm(to_foot) == pytest.approx(1.0, abs=1e-6)


def test_rising_on_the_toes_leaves_ball_and_toes_where_they_are(body):
    feet = footprints.stand(body, heading_rad=0.4)
    up = footprints.raised(body, feet, np.array([0.5, 0.2]))
    for before, after in ((feet, up),):
        for side in range(2):
            toe = body.offset_m[TOES[side]]
            balls = [f.ankle_m[side] + quaternion.rotate(f.foot_turned[side], toe) for f in (before, after)]
            assert balls[0] == pytest.approx(balls[1], abs=1e-12)
            toes = [
                quaternion.multiply(f.foot_turned[side], quaternion.about_y(-f.toe_rad[side])) for f in (before, after)
            ]
            assert quaternion.angle_between(*toes) < 1e-7
            assert after.ankle_m[side, 2] > before.ankle_m[side, 2] + 0.01
