"""Somebody walks, and balls keep coming: from anywhere, at any speed, at head or chest. `python -m demos.gauntlet`

Change the dice, and see how they cope. `brace` takes the name wherever it takes a scenario:
`brace capture gauntlet -o gauntlet.mp4`, `brace export gauntlet -o gauntlet.html`, `brace react gauntlet`.
"""

import random
import sys
from typing import Any

from demos.cli import main

SEED = 5  # another number, another gauntlet
BALLS = 8
FIRST_S, EVERY_S = 0.6, 2.6  # time enough to protect oneself, take the blow and walk on


def scenario() -> dict[str, Any]:
    """What a scenario file would say, made by dice."""
    dice = random.Random(SEED)
    return {
        "seed": SEED,
        "duration_s": FIRST_S + EVERY_S * BALLS,
        "character": [{"clip": "walk"}],
        "threat": [ball(dice, FIRST_S + EVERY_S * number) for number in range(BALLS)],
    }


def ball(dice: random.Random, perceived_s: float) -> dict[str, Any]:
    """One volleyball, as hard as people spike it, from anywhere but straight behind."""
    return {
        "target": dice.choice(["head", "head", "torso"]),
        "perceived_s": perceived_s,
        "azimuth_deg": dice.uniform(-140.0, 140.0),
        "elevation_deg": dice.uniform(0.0, 25.0),
        "speed_mps": dice.uniform(22.8, 29.7),
        "size": dice.random(),
    }


if __name__ == "__main__":
    sys.exit(main(["demo", "gauntlet", *sys.argv[1:]]))
