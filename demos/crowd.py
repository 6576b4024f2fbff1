"""A ring of people, each with a motion of their own, each thrown at from somewhere. `python -m demos.crowd`

All of them are rows of the same columns: nothing here or in a tick is written for one or for many.
"""

import math
import random
import sys
from typing import Any

from demos.cli import main

SEED = 3
CLIPS = ("walk", "dance", "stand", "run")  # handed out in turn
PEOPLE = 8
RING_M = 2.2  # they face outwards, so those who walk part


def scenario() -> dict[str, Any]:
    """What a scenario file would say, made by dice."""
    dice = random.Random(SEED)
    return {
        "seed": SEED,
        "duration_s": 4.0,
        "character": [person(dice, number) for number in range(PEOPLE)],
        "threat": [ball(dice, number) for number in range(PEOPLE)],
    }


def person(dice: random.Random, number: int) -> dict[str, Any]:
    """Somebody on the ring, in a clip that they have begun a little while ago; every other one is mirrored."""
    around = 2.0 * math.pi * number / PEOPLE
    return {
        "clip": CLIPS[number % len(CLIPS)],
        "start_s": dice.uniform(0.0, 0.6),
        "position_m": [RING_M * math.cos(around), RING_M * math.sin(around)],
        "heading_deg": math.degrees(around),
        "mirrored": number % 2 == 1,
    }


def ball(dice: random.Random, number: int) -> dict[str, Any]:
    """A volleyball for one of them, from outside the ring."""
    return {
        "at_character": number,
        "target": dice.choice(["head", "torso"]),
        "perceived_s": dice.uniform(0.3, 1.5),
        "azimuth_deg": dice.uniform(-80.0, 80.0),
        "elevation_deg": dice.uniform(5.0, 20.0),
        "speed_mps": dice.uniform(22.8, 29.7),
        "size": dice.random(),
    }


if __name__ == "__main__":
    sys.exit(main(["demo", "crowd", *sys.argv[1:]]))
