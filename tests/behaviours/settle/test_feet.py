"""What each foot is about: held to the last bit, or one step, lifted."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.components import Feet
from behaviours.settings import Settings
from behaviours.settle.feet import (
    FREE,
    HELD,
    STEPPING,
    Footing,
    footing_of,
    goals_of,
    hold,
    hold_or_step,
    land_finished_steps,
    let_go,
    planned,
    stands,
    step,
)
from engine.body.skeleton import ANKLES
from engine.core.world import World
from engine.maths import quaternion
from tests.behaviours.people import BODY, standing

BALANCE = Settings().balance
HERE = footing_of(BODY, standing(), 0)
THERE = Footing(HERE.ankle_m + [0.4, 0.05, 0.0], np.array(quaternion.about_z(0.5)), HERE.toe)


@pytest.fixture
def feet():
    """The feet of somebody who has done nothing yet."""
    world = World((Feet,), 1, None)
    world.spawn(Feet(ticks=(1.0, 1.0)))
    return world[Feet]


def path_m(feet, ticks) -> np.ndarray:
    return np.array([goals_of(feet, 0, tick).ankle_m[0] for tick in ticks])


def test_a_held_foot_is_to_the_last_bit_where_it_was(feet):
    hold(feet, 0, 0, HERE)
    for tick in (0, 7.5, 1e6):
        goals = goals_of(feet, 0, tick)
        np.testing.assert_array_equal(goals.ankle_m[0], HERE.ankle_m)
        np.testing.assert_array_equal(goals.turned[0], HERE.turned)
        assert goals.bound[0]
        assert goals.bears[0] == 1.0


def test_a_step_leads_from_here_to_there_and_is_lifted_on_the_way(feet):
    feet.planted[0, 0] = True
    step(feet, 0, 0, HERE, THERE, 10, 40.0, BALANCE)
    way = path_m(feet, np.linspace(10, 50, 81))
    np.testing.assert_array_equal(way[0], HERE.ankle_m)
    np.testing.assert_array_equal(way[-1], THERE.ankle_m)
    assert way[40, 2] - HERE.ankle_m[2] == pytest.approx(BALANCE.lift_height_m)
    assert (way[1:-1, 2] > HERE.ankle_m[2]).all()
    assert (np.diff(way[:, 0]) > 0.0).all()
    # no velocity at either end
    assert np.linalg.norm(way[1] - way[0]) < 0.01 * np.linalg.norm(THERE.ankle_m - HERE.ankle_m)
    assert np.linalg.norm(way[-1] - way[-2]) < 0.01 * np.linalg.norm(THERE.ankle_m - HERE.ankle_m)
    assert quaternion.angle_between(goals_of(feet, 0, 50).turned[0], THERE.turned) == pytest.approx(0.0, abs=1e-9)


def test_a_foot_gives_up_its_load_and_takes_it_again(feet):
    feet.planted[0, 0] = True
    step(feet, 0, 0, HERE, THERE, 0, 40.0, BALANCE)
    bears = np.array([goals_of(feet, 0, tick).bears[0] for tick in range(41)])
    assert bears[0] == 1.0
    assert bears[-1] == 1.0
    assert bears[18] == 0.0
    feet.planted[0, 0] = False
    step(feet, 0, 0, HERE, THERE, 0, 40.0, BALANCE)
    assert goals_of(feet, 0, 0).bears[0] == 0.0  # it was in the air: nobody has to go down for it


def test_a_small_correction_is_lifted_a_little(feet):
    near = HERE._replace(ankle_m=HERE.ankle_m + [0.006, 0.0, 0.0])
    step(feet, 0, 0, HERE, near, 0, 20.0, BALANCE)
    assert 0.0 < feet.lift_m[0, 0] < 0.2 * BALANCE.lift_height_m


@pytest.mark.parametrize(
    ("moved_m", "turned_rad", "mode"),
    [(0.0, 0.0, HELD), (0.0005, 0.005, HELD), (0.01, 0.0, STEPPING), (0.0, 0.05, STEPPING)],
)
def test_a_foot_that_is_there_already_is_held(feet, moved_m, turned_rad, mode):
    turned = quaternion.normalise(quaternion.multiply(quaternion.about_z(turned_rad), tuple(HERE.turned)))
    end = Footing(HERE.ankle_m + [moved_m, 0.0, 0.0], np.array(turned), HERE.toe)
    hold_or_step(feet, 0, 0, HERE, end, 0, 20.0, BALANCE)
    assert feet.mode[0, 0] == mode


def test_a_step_that_is_over_stands(feet):
    step(feet, 0, 0, HERE, THERE, 5, 20.0, BALANCE)
    assert stands(feet, 0, 0, 5)  # yet to begin
    assert not stands(feet, 0, 0, 6)
    land_finished_steps(feet, [0], 24)
    assert not stands(feet, 0, 0, 24)
    land_finished_steps(feet, [0], 25)
    assert stands(feet, 0, 0, 25)
    np.testing.assert_array_equal(planned(feet, 0, 0).ankle_m, THERE.ankle_m)


def test_a_foot_that_is_let_go_is_bound_no_more(feet):
    hold(feet, 0, 0, HERE)
    let_go(feet, 0, 0)
    assert feet.mode[0, 0] == FREE
    assert not goals_of(feet, 0, 0).bound[0]


def test_the_footing_of_a_pose_is_its_ankle():
    from engine.body.kinematics import joints_of

    at, turned = joints_of(BODY, standing())
    for side, ankle in enumerate(ANKLES):
        found = footing_of(BODY, standing(), side)
        np.testing.assert_array_equal(found.ankle_m, at[ankle])
        np.testing.assert_array_equal(found.turned, turned[ankle])
