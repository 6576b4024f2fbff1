"""The solver: eq. 5, coordinate-wise Brent against SciPy's, and shapes that give way to a reach."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from behaviours.stance import penalty, solver, torso, yielding
from behaviours.stance.footprints import stand
from behaviours.stance.measures import measures, penalties
from behaviours.stance.penalty import Side
from behaviours.stance.shape import WISHES, evenly, shape
from behaviours.stance.solve import Place, plan_of, solve_shape, solve_stance, wishes_of
from demos.benchmarks import plain_stance
from engine.body.skeleton import HEAD, SHOULDERS, WRISTS

FAR = (0.62, 0.25, 1.1)  # out of an arm's reach, not out of a torso's


def test_without_targets_the_wanted_amplitudes_are_the_answer(body):
    result = solve_shape(body, shape(sagittal_class="SmallC", sagittal=1.1, transverse_rad=-0.3))
    assert result.unknowns == pytest.approx([0, 1.1, -0.3, 0, 0, 0])
    assert (result.outcome.cycles, result.outcome.evaluations) == (0, 1)


CASES = {
    "posture": (0.6, {}),
    "recoil-strong": (0.9, {"object_m": (1.2, 0.4, 1.3)}),
    "interest": (0.7, {"object_m": (0.8, -0.6, 0.9)}),
    "beauty-line": (-0.8, {"reach_left_m": (0.35, 0.2, 1.2)}),
}


@pytest.mark.parametrize("name", CASES)
def test_the_same_pose_comes_out_of_plain_numpy_and_scipy(body, name):
    """Every equation written down twice: for the same unknowns the joints agree to a hundredth of a millimetre."""
    intensity, points = CASES[name]
    result = solve_stance(body, name, intensity, **points)
    joints, offsets = plain_stance.balanced(body, result.plan, result.unknowns, np.zeros(2))
    assert joints == pytest.approx(result.joints_m, abs=1e-5)
    assert offsets == pytest.approx(result.balance_rad, abs=1e-5)


def test_the_search_ends_where_scipys_brent_ends(body):
    result = solve_stance(body, "recoil-mild", 0.4, object_m=(1.2, -0.3, 1.2), reach_right_m=(0.5, -0.3, 1.25))
    assert result.outcome.cycles > 0
    bounds = torso.amplitude_bounds(body, result.plan.classes, result.plan.opposed)
    joints, unknowns = plain_stance.solve(body, result.plan, result.wishes, bounds, solver.STOPS_IMPROVING)
    assert unknowns == pytest.approx(result.unknowns, abs=0.06)
    assert joints == pytest.approx(result.joints_m, abs=0.005)


def test_the_objective_is_the_weighted_sum_of_its_terms(body):
    result = solve_shape(body, shape(sagittal_class="LargeC", coronal_class="LargeC"), reach_m=(FAR, None))
    terms = penalties(result)
    wishes = result.wishes
    away = np.linalg.norm(result.joints_m[SHOULDERS[0]] - FAR)
    by_hand = [
        w * penalty.penalty_of(row, u) for w, row, u in zip(wishes.weight, wishes.wanted, result.unknowns, strict=True)
    ]
    assert list(terms.values())[:6] == pytest.approx(by_hand)
    assert terms["reach_left"] == pytest.approx(penalty.penalty_of(wishes.reach[0], away))


def test_a_firm_wish_moves_less_than_a_loose_one(body):
    """The same hard reach: what is wanted firmly stays, and others make up for it."""
    base = {"sagittal_class": "LargeC", "collar_y": "opposed"}
    firm = {"transverse": evenly(0.02, 0.1), "sagittal": evenly(1.0, 4.0)}
    loose = {"transverse": evenly(0.4, 1.2), "sagittal": evenly(0.1, 0.3)}
    twists, bows = [], []
    for wishes in (firm, loose):
        result = solve_shape(body, shape(**base, wishes=wishes), reach_m=(FAR, None))
        assert result.wrist_error_m[0] < 1e-3
        twists.append(abs(result.unknowns[torso.TRANSVERSE]))
        bows.append(abs(result.unknowns[torso.SAGITTAL]))
    assert twists[0] < 0.5 * twists[1]
    assert bows[1] < 0.5 * bows[0]


def test_a_hard_reach_needs_no_weights_tuned(body):
    """A set that leans back, its abdomen held: it gives way, by itself, and still meets the target."""
    away = solve_shape(body, shape(sagittal_class="SmallC", sagittal=0.8, abdomen_x_rad=-0.2), reach_m=(FAR, None))
    assert away.outcome.yields > 0
    assert away.wrist_error_m[0] < 1e-3
    assert np.linalg.norm(away.joints_m[WRISTS[0]] - FAR) < 1e-3


def test_what_no_torso_reaches_is_pointed_at(body):
    """The straight arm ends on the line to the target, and the miss is what is left of it."""
    target = np.array((2.5, 0.4, 1.3))
    result = solve_stance(body, "reach", 1.0, reach_left_m=tuple(target))
    shoulder, wrist = result.joints_m[SHOULDERS[0]], result.joints_m[WRISTS[0]]
    way = (target - shoulder) / np.linalg.norm(target - shoulder)
    arm = np.linalg.norm(wrist - shoulder)
    assert wrist == pytest.approx(shoulder + arm * way, abs=1e-6)
    assert result.wrist_error_m[0] == pytest.approx(np.linalg.norm(target - wrist), abs=1e-9)
    assert measures(body, result).limit_excess_rad < 1e-9


def test_both_hands_at_once(body):
    left, right = (0.6, 0.15, 1.15), (0.6, -0.2, 1.0)
    result = solve_stance(body, "reach", 1.0, reach_left_m=left, reach_right_m=right)
    assert result.joints_m[WRISTS[0]] == pytest.approx(left, abs=1e-3)
    assert result.joints_m[WRISTS[1]] == pytest.approx(right, abs=1e-3)


def test_a_further_place_in_the_world_draws_the_head(body):
    """Additional penalties (5.2): a wish that the head be near a point bends the body towards it."""
    point = (0.5, 0.0, 1.5)
    wish = Place(HEAD, point, penalty.row(0.0, Side(0.1, 0.0, 0.5, 1.0)), weight=5.0)
    plain, drawn = (solve_shape(body, shape(sagittal_class="LargeC"), places=p) for p in ((), (wish,)))
    far = [np.linalg.norm(r.joints_m[HEAD] - point) for r in (plain, drawn)]
    assert far[1] < far[0] - 0.1
    assert drawn.outcome.cycles > 0


@settings(max_examples=30)
@given(st.lists(st.floats(-1.5, 1.5).map(lambda x: round(x, 6)), min_size=6, max_size=6), st.integers(0, 2))
def test_every_solve_ends_in_balance_and_within_limits(body, at, hands):
    targets = [
        (0.4 + 0.3 * at[0], 0.3 + 0.4 * at[1], 1.2 + 0.5 * at[2]),
        (0.4 + 0.3 * at[3], -0.3 + 0.4 * at[4], 1.2 + 0.5 * at[5]),
    ]
    reach = (targets[0] if hands != 1 else None, targets[1] if hands != 0 else None)
    result = solve_shape(body, shape(sagittal_class="LargeS", coronal_class="SmallC", sagittal=0.5), reach_m=reach)
    found = measures(body, result)
    assert result.outcome.cycles <= solver.MOST_CYCLES
    assert found.limit_excess_rad < 1e-9
    assert found.balance_error_m < 1e-4
    assert found.foot_error_m.max() < 1e-6


@settings(max_examples=100)
@given(st.integers(0, 10_000))
def test_the_step_of_giving_way_is_bounded_least_squares(seed):
    """Against SciPy's bounded linear least squares, both wrists lacking. Bounds that let it through or hold it."""
    chance = np.random.default_rng(seed)
    minimum, start = chance.normal(size=(2, 6))
    stiffness, lacks = chance.uniform(0.2, 5.0, 6), chance.uniform(0.02, 0.2, 2)
    slopes = chance.normal(size=(2, 6)) * 0.1
    bounds = np.column_stack([start - chance.uniform(0.5, 20.0, 6), start + chance.uniform(0.5, 20.0, 6)])
    step = np.empty(6)
    yielding.least_squares_step(minimum, start, stiffness, lacks, slopes, bounds, step)
    weight = np.sqrt(yielding.LACK_WEIGHT)
    matrix = np.vstack([np.diag(np.sqrt(stiffness)), weight * slopes])
    wanted = np.concatenate([np.sqrt(stiffness) * (minimum - start), -weight * lacks])
    best = lsq_linear(matrix, wanted, bounds=(bounds[:, 0] - start, bounds[:, 1] - start), tol=1e-12)

    def cost(s):
        return float(np.sum((matrix @ s - wanted) ** 2))

    assert np.all(start + step >= bounds[:, 0] - 1e-9)
    assert np.all(start + step <= bounds[:, 1] + 1e-9)
    if np.all(best.active_mask == 0):
        assert step == pytest.approx(best.x, abs=1e-5)
    assert cost(step) <= 1.5 * cost(best.x) + 1e-6


def test_wishes_take_their_place_in_the_objective(body):
    wanted = shape(sagittal=0.4, wishes={"coronal": evenly(0.3, 1.0, weight=2.5)})
    wishes = wishes_of(body, wanted)
    assert wishes.weight[torso.CORONAL] == 2.5
    assert wishes.wanted[torso.SAGITTAL, penalty.WANTED] == 0.4
    assert wishes.wanted[torso.TRANSVERSE, 1] == WISHES["transverse"].low.basin
    assert not plan_of(body, wanted, stand(body)).reaching.any()
