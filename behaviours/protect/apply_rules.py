"""One evaluation: the start pose, its pelvis moved, lean, turn, feet planted, recoil, block. Hermens 2006, 3.2 and 3.3.

The feet are planted after the turn, which turns the pelvis and would drag them.

These kernels run some hundred times a pose. They hand each other plain arrays, numbers and tuples of numbers: a tuple
with arrays in it has each of them counted at every call, which costs as much as the arithmetic.
"""

from __future__ import annotations

import numpy as np

from behaviours.protect.guard import clamp, guard, reset
from behaviours.rules import lean, turn
from behaviours.rules.controls import LEAN, REACH_LEFT, RECOIL, SWIVEL_LEFT, TURN
from engine.body.limb_freedom import free_leg
from engine.body.limb_ik import KEEP, leg_onto, place_children
from engine.body.skeleton import HEAD, HIPS, PELVIS, TOES
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit


@njit(cache=True)
def apply_rules(task, pelvis_shift, controls, soft_m, posed):
    """Writes the pose that seven controls (7,) and a shift of the pelvis (3,) give. soft_m: see
    two_bones.soft_reach.
    """
    posed.made_from[:] = np.nan
    update_pose(task, pelvis_shift, controls, soft_m, posed)
    posed.made_from[:] = np.nan


@njit(cache=True, forceinline=True)
def update_pose(task, pelvis_shift, controls, soft_m, posed):
    """apply_rules for a search: what is made from the same numbers as last time is not made again.

    Trunk and legs are made from the pelvis's shift, lean and turn; an arm from those, the recoil and its own reach
    and swivel. So a difference in one arm's control costs one arm. `posed` remembers, and so belongs to one task.
    """
    bones, start, feet, build = task.bones, task.start, task.feet, task.build
    low_rad, high_rad, margin_rad = start.low_rad, start.high_rad, task.rules.limit_margin_rad
    rotations, positions, orientations = posed.rotations, posed.positions, posed.orientations
    made_from = posed.made_from
    x, y, z = pelvis_shift[0], pelvis_shift[1], pelvis_shift[2]
    same_trunk = _remember(made_from, 0, (x, y, z, controls[LEAN], controls[TURN], soft_m))
    if not same_trunk:
        root = (start.root_m[0] + x, start.root_m[1] + y, start.root_m[2] + z)
        place_trunk(
            root, controls[LEAN], controls[TURN], start.heading_rad, task.threat, task.choices, task.rules,
            bones.offset_m, start.rotations, start.orientations, low_rad, high_rad, rotations, positions, orientations,
        )  # fmt: skip
    for side in range(2):
        if not same_trunk:
            if feet.held[side]:
                posed.foot_miss_m[side], posed.trouble[side] = plant_leg(
                    side, vector.at(feet.ankle_m, side), quaternion.at(feet.turned, side),
                    quaternion.at(feet.toe, side), build.knee_rad[side], soft_m, bones.offset_m,
                    start.rotations, start.orientations, low_rad, high_rad, margin_rad,
                    rotations, positions, orientations,
                )  # fmt: skip
            else:
                posed.foot_miss_m[side] = posed.trouble[side] = 0.0
                hang_leg(side, bones.offset_m, start.rotations, rotations, positions, orientations)
        reach, swivel = controls[REACH_LEFT + side], controls[SWIVEL_LEFT + side]
        same_arm = _remember(made_from, 1 + side, (controls[RECOIL], reach, swivel, 0.0, 0.0, 0.0))
        if not (same_trunk and same_arm):
            palm = guard(
                side, controls[RECOIL], reach, swivel, build, task.threat, task.choices, task.rules, bones.offset_m,
                start.rotations, low_rad, high_rad, rotations, positions, orientations,
            )  # fmt: skip
            vector.put(posed.palms, side, palm)


@inner_kernel
def _remember(made_from, row, numbers):
    """Whether these are the numbers that were remembered last; they are from now on."""
    same = True
    for k in range(len(numbers)):
        same = same and made_from[row, k] == numbers[k]
        made_from[row, k] = numbers[k]
    return same


@inner_kernel
def place_trunk(
    root_m, lean_control, turn_control, heading_rad, threat, choices, rules,
    offset_m, start_rotations, start_orientations, low_rad, high_rad, rotations, positions, orientations,
):  # fmt: skip
    """The pelvis moved, then lean and turn, within the joints' limits; trunk, neck and head placed in the world."""
    reset(start_rotations, rotations, PELVIS, HEAD)
    travel = quaternion.unrotate(quaternion.about_z(heading_rad), threat.direction)
    lean.lean_away(
        rotations, start_orientations, heading_rad, travel, lean_control, rules.lean_turn,
        threat.head_weight, threat.pelvis_weight, rules.pelvis.lean_sign,
    )  # fmt: skip
    turn.turn_away(rotations, choices.turn_rad, turn_control, rules.lean_turn)
    for joint in range(PELVIS, HEAD + 1):  # each the parent of the next
        if joint == PELVIS:
            vector.put(positions, joint, root_m)
            quaternion.put(orientations, joint, quaternion.at(rotations, joint))
        else:
            if joint != HEAD:
                clamp(low_rad, high_rad, rotations, joint)
            place_children(offset_m, rotations, positions, orientations, joint - 1, joint)


@inner_kernel
def hang_leg(side, offset_m, start_rotations, rotations, positions, orientations):
    """A leg whose foot is not on the ground goes with the pelvis as it is."""
    hip = HIPS[side]
    reset(start_rotations, rotations, hip, TOES[side])
    for joint in range(hip, TOES[side] + 1):
        parent = PELVIS if joint == hip else joint - 1
        place_children(offset_m, rotations, positions, orientations, parent, joint)


@inner_kernel
def plant_leg(
    side, ankle_m, foot, toe, knee_rad, soft_m, offset_m, start_rotations, start_orientations, low_rad, high_rad,
    margin_rad, rotations, positions, orientations,
):  # fmt: skip
    """A foot is put where it stands by leg IK. Returns (how far it misses, metres; what limits still forbid, radians).

    The pelvis turns away over a foot that stays, and the knee keeps pointing where it did, over the foot: the thigh
    starts from its own place in the world, not from the pelvis's.
    """
    hip = HIPS[side]
    reset(start_rotations, rotations, hip, TOES[side])
    pelvis = quaternion.at(orientations, PELVIS + 0 * side)
    thigh = quaternion.multiply(quaternion.conjugate(pelvis), quaternion.at(start_orientations, hip))
    quaternion.put(rotations, hip, thigh)
    quaternion.put(rotations, TOES[side], toe)
    for joint in range(hip, TOES[side]):
        parent = PELVIS if joint == hip else joint - 1
        place_children(offset_m, rotations, positions, orientations, parent, joint)
    miss_m = leg_onto(offset_m, knee_rad, rotations, positions, orientations, side, ankle_m, foot, KEEP, soft_m)
    wrong = free_leg(side, offset_m, low_rad, high_rad, margin_rad, rotations, positions, orientations)
    return miss_m, wrong
