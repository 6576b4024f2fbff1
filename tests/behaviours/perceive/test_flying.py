"""Balls in the air and on the floor: against the parabola, the bounce of a drop test, and what cannot be gained."""

from __future__ import annotations

import numpy as np
import pytest

from behaviours.components import Flight
from behaviours.perceive.flying import ROLLING, bounce, fly_one_tick
from engine.maths.ballistics import GRAVITY_MPS2
from tests.behaviours.runs import simulation_of

G = -GRAVITY_MPS2[2]
RADIUS_M = 0.105
TICK_S = 1 / 120
HOLLOW = 2.0 / 3.0


class Ball:
    """One ball on its own."""

    def __init__(self, position_m, velocity_mps=(0.0, 0.0, 0.0), spin_radps=(0.0, 0.0, 0.0)):
        self.position, self.velocity = np.array(position_m, float), np.array(velocity_mps, float)
        self.spin, self.turned = np.array(spin_radps, float), np.array([1.0, 0.0, 0.0, 0.0])

    def fly(self, ticks: int, restitution=0.75, friction=0.6) -> np.ndarray:
        """(ticks, 3) where it was."""
        seen = []
        for _ in range(ticks):
            fly_one_tick(
                self.position, self.velocity, self.spin, self.turned, RADIUS_M, 0.0, restitution, friction, TICK_S
            )
            seen.append(self.position.copy())
        return np.array(seen)

    def energy_J_per_kg(self) -> float:
        moving = 0.5 * (self.velocity**2).sum() + 0.5 * HOLLOW * RADIUS_M**2 * (self.spin**2).sum()
        return float(moving + G * self.position[2])


def test_in_the_air_it_follows_the_parabola():
    ball = Ball((0.0, 0.0, 5.0), (3.0, -2.0, 1.0))
    t = np.arange(1, 61)[:, None] * TICK_S
    expected = np.array([0.0, 0.0, 5.0]) + np.array([3.0, -2.0, 1.0]) * t + 0.5 * np.array([0.0, 0.0, -G]) * t * t
    np.testing.assert_allclose(ball.fly(60), expected, atol=1e-10)


def test_dropped_it_comes_back_as_high_as_its_restitution_has_it():
    """A drop test: height back is e squared of the height dropped; the floor is met between two ticks."""
    height_m = 2.0
    ball = Ball((0.0, 0.0, RADIUS_M + height_m))
    falls = int(np.sqrt(2 * height_m / G) / TICK_S)
    seen = ball.fly(2 * falls)
    top_m = seen[falls:, 2].max() - RADIUS_M
    assert top_m == pytest.approx(0.75**2 * height_m, abs=2e-3)
    assert seen[:, 2].min() > RADIUS_M - 1e-9


def test_it_never_gains_energy_nor_sinks():
    chance = np.random.default_rng(4)
    for _ in range(20):
        ball = Ball((0.0, 0.0, 1.0), chance.normal(size=3) * 8.0, chance.normal(size=3) * 40.0)
        energy = ball.energy_J_per_kg()
        for _ in range(300):
            (at,) = ball.fly(1)
            assert at[2] > RADIUS_M - 1e-9
            assert ball.energy_J_per_kg() <= energy + 1e-9
            energy = ball.energy_J_per_kg()


def test_a_bounce_that_grips_leaves_it_rolling():
    """Enough friction: the lowest point stands still afterwards, and momentum about it is kept."""
    velocity, spin = bounce((5.0, 0.0, -4.0), (0.0, 0.0, 0.0), RADIUS_M, 0.75, 10.0)
    assert velocity[2] == pytest.approx(3.0)
    assert velocity[0] - spin[1] * RADIUS_M == pytest.approx(0.0, abs=1e-12)
    # about the place of contact: m v r + I w, before all of it in v
    assert velocity[0] + HOLLOW * spin[1] * RADIUS_M == pytest.approx(5.0)


def test_a_bounce_that_slips_takes_coulomb_s_share():
    velocity, spin = bounce((5.0, 0.0, -4.0), (0.0, 0.0, 0.0), RADIUS_M, 0.75, 0.1)
    assert velocity[0] == pytest.approx(5.0 - 0.1 * 7.0)
    assert spin[1] == pytest.approx(0.1 * 7.0 / (HOLLOW * RADIUS_M))


def test_a_rolling_ball_slows_down_by_its_resistance_and_stops():
    ball = Ball((0.0, 0.0, RADIUS_M), (2.0, 0.0, 0.0), (0.0, 2.0 / RADIUS_M, 0.0))
    ball.fly(120)
    assert ball.velocity[0] == pytest.approx(2.0 - ROLLING * G, rel=0.02)
    ball.fly(120 * 12)
    assert np.linalg.norm(ball.velocity) < 1e-3
    assert ball.position[2] == pytest.approx(RADIUS_M)


def test_spin_turns_the_ball():
    ball = Ball((0.0, 0.0, 50.0), spin_radps=(0.0, 0.0, np.pi))
    ball.fly(120)
    assert abs(ball.turned[0]) == pytest.approx(0.0, abs=1e-9)  # half a turn in a second
    assert abs(ball.turned[3]) == pytest.approx(1.0, abs=1e-9)


def test_a_ball_far_from_everybody_is_taken_away_and_one_in_play_is_not():
    gone = {"free": True, "position_m": [90.0, 0.0, 0.105], "velocity_mps": [0.0, 0.0, 0.0]}
    simulation = simulation_of([gone], duration_s=7.0, observe=False)
    for _ in range(595):
        simulation.step()
    assert len(simulation.world.rows(Flight)) == 1
    for _ in range(10):
        simulation.step()
    assert len(simulation.world.rows(Flight)) == 0
