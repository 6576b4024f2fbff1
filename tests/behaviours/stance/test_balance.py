"""The centre of mass over its place: by search in a pose, by feedback while animating."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from behaviours.stance import balance, footprints
from behaviours.stance.assembly import assemble, new_figure
from behaviours.stance.measures import measures
from behaviours.stance.shape import shape
from behaviours.stance.solve import plan_of, solve_shape
from engine.body import kinematics
from engine.body.skeleton import ANKLES

shares = st.floats(-0.8, 0.8).map(lambda x: round(x, 6))


@settings(max_examples=60)
@given(shares, shares, shares, st.sampled_from(("left", "right")))
def test_the_search_meets_the_place_whichever_foot_is_dominant(body, x, z, twist, dominant):
    result = solve_shape(
        body,
        shape(balance_x=0.8 * x, balance_z=0.7 * z, pelvis_y_rad=0.4 * twist, knee_left_rad=0.3, dominant=dominant),
    )
    com = kinematics.com_of(body, result.pose)
    assert np.hypot(*(com[:2] - result.plan.balance_m)) < 1e-5
    assert result.joints_m[list(ANKLES)] == pytest.approx(result.feet.ankle_m, abs=1e-9)


def test_precarious_balance_is_allowed(body):
    """The wanted place may lie outside the support polygon."""
    feet = footprints.stand(body)
    found = measures(body, solve_shape(body, shape(balance_z=1.15), feet))
    assert found.balance_error_m < 1e-5
    assert found.margin_m < 0.0


def test_a_place_in_the_world_can_be_given(body):
    result = solve_shape(body, shape(), balance_m=(0.09, -0.03))
    assert kinematics.com_of(body, result.pose)[:2] == pytest.approx((0.09, -0.03), abs=1e-5)


def test_one_step_of_settling_comes_close(body):
    """Inside an evaluation only the pelvis is solved anew: shoulders go where a full search takes them, to a
    millimetre.
    """
    plan = plan_of(body, shape(sagittal_class="LargeC"), footprints.stand(body))
    search, figure, unknowns = balance.new_search(plan.lower), new_figure(), np.zeros(6)
    balance.find_balance(body, plan, unknowns, search, figure)
    unknowns[1] = 0.5
    com = assemble(body, plan, unknowns, tuple(search.offset_rad), figure)
    way = balance.settle(body, plan, search, com, figure)
    guess = balance.carried(way, figure.positions[6])
    balance.find_balance(body, plan, unknowns, search, figure)
    assert guess == pytest.approx(figure.positions[6], abs=1e-3)


@pytest.mark.parametrize("root", [0, 1])
def test_feedback_takes_an_error_out_and_keeps_it_out(body, root):
    """Disturbed by 3 cm of wanted place, within a second the error is a hundredth of that; each foot in turn
    dominant.
    """
    dominant = ("left", "right")[root]
    feet = footprints.stand(body)
    plan = plan_of(body, shape(dominant=dominant, knee_left_rad=0.2, knee_right_rad=0.2), feet)
    plan = plan._replace(balance_m=plan.balance_m + [0.03, -0.02])
    search, figure, offsets, errors = balance.new_search(plan.lower), new_figure(), (0.0, 0.0), []
    for _ in range(120):
        com = assemble(body, plan, np.zeros(6), offsets, figure)
        error = (plan.balance_m[0] - com[0], plan.balance_m[1] - com[1])
        errors.append(np.hypot(*error))
        offsets = balance.fed_back(search, offsets, error, 12.0, 1.0 / 120.0)
        assert figure.positions[list(ANKLES)] == pytest.approx(feet.ankle_m, abs=1e-9)
    assert errors[-1] < 0.01 * errors[0]
    assert np.all(np.diff(errors[5:]) <= 1e-9)


def test_the_middle_follows_the_heels(body):
    """On the toes only the balls bear, so the middle of the stance lies over them."""
    flat = footprints.stand(body)
    up = footprints.raised(body, flat, 0.5)
    assert footprints.middle_m(body, up)[0] > footprints.middle_m(body, flat)[0] + 0.05
    risen = solve_shape(body, shape(rise_rad=0.5), flat)
    assert measures(body, risen).margin_m > 0.01
    assert risen.pose.root_m[2] > solve_shape(body, shape(), flat).pose.root_m[2] + 0.03
