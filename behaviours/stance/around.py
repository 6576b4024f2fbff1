"""What a shape set knows of the world: where the object is, seen from the character, and what the hands want (section
6).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.stance import footprints, lower_body
from behaviours.stance.footprints import Footprints
from engine.body.anthropometry import joints_at_identity
from engine.body.skeleton import ANKLES, BACK


class Around(NamedTuple):
    """The surroundings of a stance, in the character's terms."""

    azimuth_rad: float = 0.0  # of the object: 0 ahead, + to the left
    elevation_rad: float = 0.0  # over the chest's height
    reaching: tuple[bool, bool] = (False, False)  # whether the left, the right wrist has a target

    @property
    def ahead(self) -> float:
        """1 for an object in front, -1 for one behind."""
        return math.cos(self.azimuth_rad)

    @property
    def low(self) -> float:
        """0 for an object as high as the chest or higher, 1 for one straight below it."""
        return max(0.0, -math.sin(self.elevation_rad))

    @property
    def left(self) -> float:
        """1 for an object on the left, -1 for one on the right."""
        return math.sin(self.azimuth_rad)

    @property
    def turn(self) -> float:
        """How far to turn towards the object: 1 to the left, and no less for what is behind (a switch straight
        behind).
        """
        return math.copysign(math.sin(min(abs(self.azimuth_rad), 0.5 * math.pi)), self.azimuth_rad)

    @property
    def bow(self) -> float:
        """How far to bow towards the object: 1 ahead, hardly at all backwards."""
        return self.ahead if self.ahead > 0.0 else 0.2 * self.ahead

    @property
    def side(self) -> float:
        """A switch: +1 for an object on the left or straight ahead, -1 for one on the right.

        A reaction that is not the same on both sides has to turn some way even from what is straight ahead.
        """
        return 1.0 if self.left >= -1e-12 else -1.0


def look_around(body, feet: Footprints, object_m, reaching: tuple[bool, bool]) -> Around:
    """The surroundings of a character on these feet. object_m (3,) world, or None: nothing but straight ahead."""
    if object_m is None:
        return Around(reaching=reaching)
    joints = joints_at_identity(body.offset_m)
    chest_m = feet.ankle_m[:, 2].mean() + joints[BACK, 2] - joints[ANKLES[0], 2]
    away = np.asarray(object_m, float)[:2] - footprints.middle_m(body, feet)
    heading = lower_body.facing_rad(feet.ankle_m, feet.foot_turned, 0)
    azimuth = math.atan2(away[1], away[0]) - heading
    return Around(
        azimuth_rad=math.remainder(azimuth, 2.0 * math.pi),
        elevation_rad=math.atan2(object_m[2] - chest_m, math.hypot(*away)),
        reaching=reaching,
    )
