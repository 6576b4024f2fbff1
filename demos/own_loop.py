"""Brace in a loop of one's own, as a game has it: what the player does comes in, time passes, the skeleton is read.

`python -m demos.own_loop`
"""

import sys

from behaviours.components import Phase, Reaction
from behaviours.launching import place_of, velocity_towards
from behaviours.playing import joint_frames
from behaviours.scenario import check_scenario
from behaviours.simulation import Simulation, apply_command
from demos.cli import guarded
from engine.body.skeleton import HEAD
from engine.core.clock import TICK_RATE_HZ

FPS, LASTS_S = 60, 3.0
THROW_AT_S, REWIND_AT_S = 0.5, 2.0  # when the player throws a ball, and when they want that undone
FROM_M, SPEED_MPS = (4.0, 1.5, 1.6), 14.0


def main() -> None:
    scenario = check_scenario({"character": [{"clip": "sway", "boldness": -0.3}]})
    simulation = Simulation(scenario)
    world = simulation.world
    (row,) = world.assets.character_rows

    before_throw = None
    for frame in range(round(LASTS_S * FPS)):
        time_s = frame / FPS
        if time_s == THROW_AT_S:
            before_throw = world.snapshot()  # all state there is
            velocity = velocity_towards(FROM_M, place_of(world, "head", row), SPEED_MPS)
            apply_command(world, {"do": "throw", "position_m": FROM_M, "velocity_mps": velocity})
        if time_s == REWIND_AT_S and before_throw is not None:
            print("rewound to before the throw")
            world.restore(before_throw)

        for _ in range(TICK_RATE_HZ // FPS):
            simulation.step()

        # what a renderer needs: where every joint is (21, 3) and how it is turned (21, 4), w x y z, in the world
        joints_m, turned = joint_frames(world, row)
        if frame % 15 == 0:
            phase = Phase(int(world[Reaction].phase[row])).name.lower()
            print(f"frame {frame:3}  {phase:15}  head at {joints_m[HEAD].round(2)} m, turned {turned[HEAD].round(2)}")


if __name__ == "__main__":
    sys.exit(guarded(main))
