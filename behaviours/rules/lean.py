"""Lean away (Hermens 2006, 3.2.2, fig. 3.3): the body leans the way the threat travels, which lengthens its way to the target."""

from __future__ import annotations

from numba import njit

from engine.body.skeleton import BACK, NECK, PELVIS, WAIST
from engine.maths import quaternion


@njit(cache=True)
def lean_angles(direction, greatest, lean):
    """Angles about the heading's X and Y, radians, of one joint.

    direction: unit travel of the threat in the heading's frame (X ahead, Y left); greatest: the joint's row of table 3.2.
    From the front it leans back (Y negative), from the left it leans right (X positive).
    """
    return (-direction[1] * greatest[0] * lean, direction[0] * greatest[1] * lean)


@njit(cache=True)
def _lean_joint(rotations, orientations, joint, heading_rad, angles, share):
    """Turns one joint about the heading's horizontal axes, carried into the joint's frame as the clip has it.

    Clip-local axes would lean up to 16 degrees astray. `orientations` are the clip's, before any rule.
    """
    in_world = quaternion.rotate(quaternion.about_z(heading_rad), (angles[0] * share, angles[1] * share, 0.0))
    in_joint = quaternion.unrotate(orientations[joint], in_world)
    rotation = quaternion.multiply(rotations[joint], quaternion.from_rotation_vector(in_joint))
    rotations[joint, 0], rotations[joint, 1], rotations[joint, 2], rotations[joint, 3] = rotation


@njit(cache=True)
def lean_away(rotations, orientations, heading_rad, direction, lean, maxima, head_weight, pelvis_weight, pelvis_sign):
    """Leans neck, back, waist and pelvis in place: rotations (J, 4) local; orientations (J, 4) of the clip, world.

    The two weights mix the responses for a threat to the head and one to the pelvis (3.4, eq. 3.4): the latter
    leans the pelvis alone, towards the threat (`pelvis_sign` negative). `maxima` is the settings' LeanTurn group.
    """
    neck = lean_angles(direction, maxima.neck_rad, lean)
    back = lean_angles(direction, maxima.back_rad, lean)
    waist = lean_angles(direction, maxima.waist_rad, lean)
    pelvis = lean_angles(direction, maxima.pelvis_rad, lean)
    _lean_joint(rotations, orientations, NECK, heading_rad, neck, head_weight)
    _lean_joint(rotations, orientations, BACK, heading_rad, back, head_weight)
    _lean_joint(rotations, orientations, WAIST, heading_rad, waist, head_weight)
    _lean_joint(rotations, orientations, PELVIS, heading_rad, pelvis, head_weight + pelvis_sign * pelvis_weight)
