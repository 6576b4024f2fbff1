"""Left and right exchanged in everything that a protective pose is made from and of.

A character that turns left is worked out as its mirror image that turns right, and mirrored back: so the mirrored
clip with the mirrored threat gives the mirrored pose to the last bit. Without it, rounding that differs between left
and right would be a search's choice between two nearly equal ways. World mirror at Y = 0; mirroring twice changes
nothing.
"""

from __future__ import annotations

import numpy as np

from behaviours.perceive.perceived import PerceivedThreat
from behaviours.protect.task import Bones, Build, Choices, FeetPlan, Start, Task
from behaviours.protect.total_error import Reference
from engine.body.skeleton import MIRRORED, Pose
from engine.clips.mirror import FLIP_POINT, FLIP_ROTATION, FLIPPED_LIMITS, mirror_pose
from engine.maths import vector

__all__ = [
    "mirror_choices",
    "mirror_controls",
    "mirror_feet",
    "mirror_pose",
    "mirror_reference",
    "mirror_task",
    "mirror_threat",
    "rounded_pose",
    "rounded_threat",
]

GRID = 2.0**26  # steps of a metre, or of a unit: 15 nanometres
CONTROLS_SWAPPED = np.array([0, 1, 2, 4, 3, 6, 5])
SWAPPED = np.array([1, 0])


def _flip(v) -> tuple[float, float, float]:
    return (float(v[0]), -float(v[1]), float(v[2]))


def rounded_pose(pose: Pose) -> Pose:
    """The pose on a grid far too fine to be seen: what differs in its last bits between left and right becomes equal.

    A search and a fit stop where rounding lets them; from the same bits they stop at the same place.
    """
    turned = np.round(np.asarray(pose.rotations) * GRID) / GRID
    turned /= np.sqrt(np.sum(turned * turned, axis=-1, keepdims=True))
    return Pose(np.round(np.asarray(pose.root_m) * GRID) / GRID, np.ascontiguousarray(turned))


def rounded_threat(threat: PerceivedThreat) -> PerceivedThreat:
    """The same for a threat."""
    return threat._replace(
        direction=vector.unit(_on_grid(threat.direction), threat.direction),
        tangent=vector.unit(_on_grid(threat.tangent), threat.tangent),
        line_point_m=_on_grid(threat.line_point_m),
        head_weight=round(threat.head_weight * GRID) / GRID,
        pelvis_weight=round(threat.pelvis_weight * GRID) / GRID,
    )


def _on_grid(v) -> tuple[float, float, float]:
    x, y, z = (np.round(np.asarray(v, float) * GRID) / GRID).tolist()
    return (x, y, z)


def mirror_controls(controls: np.ndarray) -> np.ndarray:
    """(7,) reach and swivel change sides."""
    return controls[CONTROLS_SWAPPED]


def mirror_threat(threat: PerceivedThreat) -> PerceivedThreat:
    """The threat from the other side, at the other hand or foot if it was one."""
    joint = threat.target_joint
    return threat._replace(
        direction=_flip(threat.direction),
        tangent=_flip(threat.tangent),
        line_point_m=_flip(threat.line_point_m),
        target_joint=int(MIRRORED[joint]) if joint >= 0 else joint,
        target_offset_m=_flip(threat.target_offset_m),
    )


def mirror_choices(choices: Choices) -> Choices:
    """Turned to the other side. `across` points to the left hand's side, which in the mirror is the other way round."""
    x, y, z = choices.across
    return choices._replace(
        turn_side=-choices.turn_side,
        turn_rad=-choices.turn_rad,
        across=(-x, y, -z),
        fingers=_flip(choices.fingers),
    )


def mirror_feet(feet: FeetPlan) -> FeetPlan:
    """Each foot where the other stood, in the mirror."""
    return FeetPlan(
        feet.ankle_m[SWAPPED] * FLIP_POINT,
        feet.turned[SWAPPED] * FLIP_ROTATION,
        feet.toe[SWAPPED] * FLIP_ROTATION,
        feet.held[SWAPPED],
        feet.step_m[SWAPPED],
    )


def mirror_start(start: Start) -> Start:
    """The mirrored start pose and limits."""
    low, high = start.low_rad[MIRRORED], start.high_rad[MIRRORED]
    return Start(
        start.root_m * FLIP_POINT,
        start.rotations[MIRRORED] * FLIP_ROTATION,
        start.orientations[MIRRORED] * FLIP_ROTATION,
        -start.heading_rad,
        np.where(FLIPPED_LIMITS, -high, low),
        np.where(FLIPPED_LIMITS, -low, high),
    )


def mirror_bones(bones: Bones, build: Build) -> tuple[Bones, Build]:
    """The mirrored subject's."""
    order = np.argsort(MIRRORED[bones.part_joint], kind="stable")
    left, right = build.palm_m
    return (
        Bones(
            bones.offset_m[MIRRORED] * FLIP_POINT,
            MIRRORED[bones.part_joint][order],
            bones.part_mass_kg[order],
            bones.part_com_m[order] * FLIP_POINT,
            bones.obstacle_joint,
            bones.obstacle_m * FLIP_POINT,
        ),
        build._replace(
            palm_m=(_flip(right), _flip(left)),
            arm_m=build.arm_m[::-1],
            leg_m=build.leg_m[::-1],
            elbow_rad=build.elbow_rad[::-1],
            knee_rad=build.knee_rad[::-1],
            head_centre_m=_flip(build.head_centre_m),
            arm_radius_m=build.arm_radius_m[::-1],
            hand_start_m=(_flip(build.hand_start_m[1]), _flip(build.hand_start_m[0])),
            hand_end_m=(_flip(build.hand_end_m[1]), _flip(build.hand_end_m[0])),
        ),
    )


def mirror_task(task: Task) -> Task:
    """The mirrored task."""
    return Task(
        *mirror_bones(task.bones, task.build),
        mirror_start(task.start),
        mirror_feet(task.feet),
        mirror_threat(task.threat),
        mirror_choices(task.choices),
        task.rules,
    )


def mirror_reference(reference: Reference) -> Reference:
    """The mirrored reference of the total error."""
    rules, wanted = reference.com_rules_m, reference.com_wanted_m
    return reference._replace(
        com_rules_m=(rules[0], -rules[1]),
        com_wanted_m=(wanted[0], -wanted[1]),
        palms=reference.palms[SWAPPED] * FLIP_POINT,
        trunk=reference.trunk * FLIP_ROTATION,
        controls=mirror_controls(reference.controls),
    )
