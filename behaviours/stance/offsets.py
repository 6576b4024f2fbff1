"""A stance as something under everything else: the local turns that it adds to any pose of a clip.

A character has a stance, its personality and mood, while it does other things. What the stance does to the spine, the
collars and the pelvis is taken as turns against the neutral stance, joint by joint, and put under the clip's own
rotations; what it does to the legs comes as a change of height, a shift of the weight and knees, which footing and
leg IK turn into feet that stay.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.stance import footprints
from behaviours.stance.shape import Shape, changed, shape
from behaviours.stance.solve import solve_shape
from engine.body.skeleton import BACK, CLAVICLES, ELBOWS, HEAD, KNEES, NECK, PELVIS, SHOULDERS, WAIST, Body
from engine.maths import rotations

# the joints that a stance lends its turns to; arms follow their own motion, legs the feet
COLOURED = np.array([PELVIS, WAIST, BACK, NECK, HEAD, *CLAVICLES])
ARMS = np.array([*SHOULDERS, *ELBOWS])


class StanceOffsets(NamedTuple):
    """What a stance adds to a pose. Identity and zeros where it adds nothing."""

    rotations: np.ndarray  # (J, 4) local turns, applied after the clip's own: clip * turn
    arms: np.ndarray  # (J, 4) the same for shoulders and elbows, for a motion that leaves the arms idle
    pelvis_drop_m: float  # how much lower the pelvis is
    pelvis_shift_m: np.ndarray  # (2,) ahead, left, against the feet
    com_shift_m: np.ndarray  # (2,) ahead, left: how much the wanted place of the centre of mass is shifted
    knee_rad: np.ndarray  # (2,) how much more the knees are bent


def offsets_of(body: Body, coloured: Shape) -> StanceOffsets:
    """The offsets of a shape, both it and the neutral stance solved on the same feet, facing +X, without targets or
    gaze.
    """
    feet = footprints.stand(body)
    neutral = solve_shape(body, shape(), feet)
    stance = solve_shape(body, changed(coloured, gaze=0.0, rise_rad=0.0), feet)
    turns = rotations.multiply(rotations.conjugate(neutral.pose.rotations), stance.pose.rotations)
    none = np.tile([1.0, 0.0, 0.0, 0.0], (len(turns), 1))
    spine, arms = none.copy(), none
    spine[COLOURED], arms[ARMS] = turns[COLOURED], turns[ARMS]
    moved = stance.pose.root_m - neutral.pose.root_m
    q, q0 = stance.pose.rotations[list(KNEES)], neutral.pose.rotations[list(KNEES)]
    return StanceOffsets(
        rotations=spine,
        arms=arms,
        pelvis_drop_m=float(-moved[2]),
        pelvis_shift_m=moved[:2].copy(),
        com_shift_m=stance.plan.balance_m - neutral.plan.balance_m,
        knee_rad=2.0 * (np.arctan2(q[:, 2], q[:, 0]) - np.arctan2(q0[:, 2], q0[:, 0])),
    )
