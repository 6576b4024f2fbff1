"""Lean away (Hermens 2006, 3.2.2, fig. 3.3): the body leans the way the threat travels, which lengthens its way to
the target.
"""

from __future__ import annotations

from engine.body.skeleton import BACK, NECK, PELVIS, WAIST
from engine.maths import quaternion
from engine.maths.kernel import njit

SPINE = (PELVIS, WAIST, BACK, NECK)


@njit(cache=True)
def lean_angles(direction, greatest, lean):
    """Angles about the heading's X and Y, radians, of one joint.

    direction: unit travel of the threat in the heading's frame (X ahead, Y left); greatest: the joint's row of table
    3.2. From the front it leans back (Y negative), from the left it leans right (X positive).
    """
    return (-direction[1] * greatest[0] * lean, direction[0] * greatest[1] * lean)


@njit(cache=True)
def lean_away(rotations, orientations, heading_rad, direction, lean, maxima, head_weight, pelvis_weight, pelvis_sign):
    """Leans pelvis, waist, back and neck in place: rotations (J, 4) local; orientations (J, 4) of the clip, world.

    Each turns about the heading's horizontal axes, carried into its own frame as the clip has it: clip-local axes would
    lean up to 16 degrees astray. The two weights mix the responses for a threat to the head and one to the pelvis (3.4,
    eq. 3.4): the latter leans the pelvis alone, towards the threat (`pelvis_sign` negative). `maxima` is the settings'
    LeanTurn group.
    """
    greatest = (maxima.pelvis_rad, maxima.waist_rad, maxima.back_rad, maxima.neck_rad)
    from_heading = quaternion.about_z(heading_rad)
    for i in range(len(SPINE)):
        joint = SPINE[i]
        share = head_weight + pelvis_sign * pelvis_weight if joint == PELVIS else head_weight
        x, y = lean_angles(direction, greatest[i], lean)
        in_world = quaternion.rotate(from_heading, (x * share, y * share, 0.0))
        in_joint = quaternion.unrotate(quaternion.at(orientations, joint), in_world)
        turn = quaternion.from_rotation_vector(in_joint)
        quaternion.put(rotations, joint, quaternion.multiply(quaternion.at(rotations, joint), turn))
