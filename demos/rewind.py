"""Back to before the blow, and from there into another future. `python -m demos.rewind [SCENARIO]`

All state lives in the world, so a run can be gone back in: to a keyframe, and on from there by simulating again.
Left alone, the same things happen to the last bit; with one more ball thrown, others do.
"""

import sys

from behaviours.launching import place_of, velocity_towards
from behaviours.simulation import apply_command
from demos.cli import guarded
from demos.running import journal_of, open_scenario, start
from engine.core.clock import TICK_RATE_HZ
from engine.core.timeline import Timeline

BACK_S = 0.3  # before the first contact
FROM_M = (-3.0, 4.0, 1.6)  # where the other ball is thrown from: the left, a little behind
SPEED_MPS = 18.0


def main(name: str = "volleyball") -> None:
    scenario, folder = open_scenario(name)
    simulation = start(scenario, folder)
    world = simulation.world
    timeline = Timeline(world, simulation.step, apply_command, journal_of(simulation, folder))

    play_on(timeline, simulation.ticks)
    first = world.digest()
    tell("what happened", world)

    # back: the past is there again, the future still on record
    contact = next((event.tick for event in world.events if event.kind == "contact"), simulation.ticks)
    then = max(contact - round(BACK_S * TICK_RATE_HZ), 0)
    timeline.seek(then)
    play_on(timeline, simulation.ticks)
    print(f"back to {then / TICK_RATE_HZ:.2f} s and on: the same to the last bit: {world.digest() == first}\n")

    # back once more, and this time something else is done: from here on the record is another
    timeline.seek(then)
    target = place_of(world, "torso", world.assets.character_rows[0])
    velocity = velocity_towards(FROM_M, target, SPEED_MPS)
    timeline.command({"do": "throw", "position_m": list(FROM_M), "velocity_mps": list(velocity)})
    play_on(timeline, simulation.ticks)
    tell("with another ball", world)


def play_on(timeline: Timeline, until: int) -> None:
    while timeline.world.tick < until:
        timeline.advance()


def tell(title: str, world) -> None:
    """Who was struck where, and when."""
    print(title)
    for event in world.events:
        if event.kind in ("perceived", "contact"):
            print(f"{event.tick / TICK_RATE_HZ:6.2f} s  {event.kind} {event.data.get('part', '')}".rstrip())
    print()


if __name__ == "__main__":
    sys.exit(guarded(lambda: main(*sys.argv[1:])))
