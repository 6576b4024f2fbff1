"""The lower body, analytic (section 5.1 and appendix): both feet stay where they are, whatever pelvis and knees are
asked for.

Four points decide it: the two ankles (given) and the two hips. The root knee's angle gives the length from root ankle
to root hip; the balance offsets turn that line about the ankle; the free hip lies on a circle about the line from the
free foot to the root hip. The skeleton is then fitted to the four points.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.stance import frame
from engine.body.skeleton import ANKLES, HIPS, KNEES, PELVIS, TOES
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

# what gives where pelvis and knees cannot both be had
TRADE_OFFS = ("knees_exact", "pelvis_exact")
KNEES_EXACT, PELVIS_EXACT = TRADE_OFFS

# a leg bends at least this much: at dead straight its length no longer changes with the knee
LEAST_KNEE_RAD = 0.02


class LowerBody(NamedTuple):
    """What is asked of the lower body, and what follows from that alone; see `ask`."""

    ankle_m: np.ndarray  # (2, 3) world
    foot_turned: np.ndarray  # (2, 4) world orientation of each foot
    toe_rad: np.ndarray  # (2,) how far the toes are bent up against the foot
    root: int  # the dominant side: its ankle carries the balance offsets, its knee is exact
    knee_rad: np.ndarray  # (2,) wanted flexion
    pelvis_rad: np.ndarray  # (3,) the paper's X, Y, Z; Y from the line through the ankle centres
    pelvis_exact: bool  # the other trade-off: the pelvis exact, the free knee gives
    facing: np.ndarray  # (4,) orientation of the stance: square to the line through the ankle centres
    leg_m: np.ndarray  # (2,) from ankle to hip with the knees as wanted, or as straight as they go where they give
    hip_vector: np.ndarray  # (3,) world unit vector from root hip to free hip as the pelvis's Y and Z ask for it
    hip_width_m: float


@njit(cache=True)
def ask(body, ankle_m, foot_turned, toe_rad, root, knee_rad, pelvis_rad, pelvis_exact):
    """A LowerBody from its first seven fields."""
    facing = quaternion.about_z(facing_rad(ankle_m, foot_turned, root))
    leg_m = np.empty(2)
    for side in range(2):
        knee = LEAST_KNEE_RAD if pelvis_exact and side != root else max(knee_rad[side], LEAST_KNEE_RAD)
        leg_m[side] = leg_length(_bone(body, KNEES[side]), _bone(body, ANKLES[side]), knee)
    width = vector.subtract(body.offset_m[HIPS[1 - root]], body.offset_m[HIPS[root]])
    width_m = vector.length(width)
    turned = quaternion.multiply(facing, quaternion.about_z(pelvis_rad[1]))
    turned = quaternion.multiply(turned, quaternion.about_x(pelvis_rad[2]))
    hip_vector = vector.scale(quaternion.rotate(turned, width), 1.0 / width_m)
    return LowerBody(
        ankle_m, foot_turned, toe_rad, root, knee_rad, pelvis_rad, pelvis_exact,
        np.array(facing), leg_m, np.array(hip_vector), width_m,
    )  # fmt: skip


@njit(cache=True)
def facing_rad(ankle_m, foot_turned, root):
    """The heading of the stance: square to the line through the ankle centres; with the ankles together, the root
    foot's.
    """
    x, y = ankle_m[0, 0] - ankle_m[1, 0], ankle_m[0, 1] - ankle_m[1, 1]
    if x * x + y * y < 1e-8:
        return quaternion.heading(foot_turned[root])
    return math.atan2(-x, y)


@njit(cache=True)
def leg_length(thigh_m, shin_m, knee_rad):
    """Hip to ankle with the knee at an angle (cosine law)."""
    return math.sqrt(thigh_m * thigh_m + shin_m * shin_m + 2.0 * thigh_m * shin_m * math.cos(knee_rad))


@njit(cache=True)
def free_hip(root_hip, free_ankle, hip_vector, width_m, leg_m):
    """The place nearest to the wanted hip vector's on the circle of all that the free leg's length allows (figure 8).

    hip_vector: unit, from root hip to free hip, as the pelvis's Y and Z ask for it; width_m between the hips; leg_m
    from free ankle to free hip. The paper extends the vector to the circle's plane, or projects its end on the plane
    where the two are near parallel. The root hip lies on the circle's axis, so both lead to the same ray from the
    circle's centre, and to the same nearest point; the projection never runs away, so it is the one taken.
    """
    down = vector.subtract(free_ankle, root_hip)
    side_a = max(vector.length(down), 1e-9)
    axis = vector.scale(down, 1.0 / side_a)
    c = min(max(leg_m, abs(side_a - width_m)), side_a + width_m)
    to_centre = (side_a * side_a + width_m * width_m - c * c) / (2.0 * side_a)
    radius = math.sqrt(max(width_m * width_m - to_centre * to_centre, 0.0))
    outward = vector.unit(vector.reject(hip_vector, axis), vector.reject((0.0, 0.0, 1.0), axis))
    return vector.along(vector.along(root_hip, axis, to_centre), outward, radius)


@njit(cache=True)
def hips_of(asked, balance_rad):
    """Where both hips go: (left, right), world. balance_rad: the root ankle's offsets about the paper's X and Z."""
    root, free = asked.root, 1 - asked.root
    leaning = quaternion.multiply(asked.facing, frame.rotation(balance_rad[0], 0.0, balance_rad[1]))
    up = quaternion.rotate(leaning, (0.0, 0.0, 1.0))
    root_hip = vector.along(asked.ankle_m[root], up, asked.leg_m[root])
    other = vector.along(root_hip, asked.hip_vector, asked.hip_width_m)
    # with the pelvis exact the free knee gives, until the leg is straight; from there on the pelvis has to
    if not asked.pelvis_exact or vector.distance(other, asked.ankle_m[free]) > asked.leg_m[free]:
        other = free_hip(root_hip, asked.ankle_m[free], asked.hip_vector, asked.hip_width_m, asked.leg_m[free])
    if root == 0:
        return root_hip, other
    return other, root_hip


@inner_kernel
def _bone(body, joint):
    return vector.length(body.offset_m[joint])


@inner_kernel
def pelvis_turned(body, left_hip, right_hip, pelvis_x_rad):
    """The pelvis's orientation: along the hip vector, its up as near to the world's as that allows, then tipped by
    pelvis X.
    """
    line = vector.subtract(body.offset_m[HIPS[0]], body.offset_m[HIPS[1]])
    y = vector.unit(vector.subtract(left_hip, right_hip), (0.0, 1.0, 0.0))
    up = vector.unit(vector.reject((0.0, 0.0, 1.0), y), (1.0, 0.0, 0.0))
    z = quaternion.rotate(quaternion.from_axis_angle(y, pelvis_x_rad), up)
    level = quaternion.from_columns(vector.cross(y, z), y, z)
    # a subject's own hips need not lie exactly on the pelvis's Y axis
    return quaternion.multiply(level, quaternion.between(vector.unit(line, (0.0, 1.0, 0.0)), (0.0, 1.0, 0.0)))


@inner_kernel
def fit_leg(body, side, pelvis, hip, ankle, foot, toe_rad, rotations):
    """Hip, knee, ankle and toe rotations of one leg between two points, written to rotations (J, 4).

    The knee's hinge is square to the leg and to the foot: the knee points over the toes, and the ankle needs no third
    degree of freedom (shin to foot is a turn about Y, then one about X).
    """
    thigh, shin = _bone(body, KNEES[side]), _bone(body, ANKLES[side])
    leg = vector.subtract(hip, ankle)
    n = vector.unit(leg, (0.0, 0.0, 1.0))
    length = min(max(vector.length(leg), abs(thigh - shin)), thigh + shin)
    y = vector.unit(vector.cross(n, quaternion.rotate(foot, (1.0, 0.0, 0.0))), quaternion.rotate(foot, (0.0, 1.0, 0.0)))
    x = vector.cross(y, n)
    straight = quaternion.from_columns(x, y, n)
    flexed = _about_y(-_cosine(thigh, shin, length))  # by pi less the triangle's angle at the knee
    upper = quaternion.multiply(straight, quaternion.conjugate(_about_y(_cosine(thigh, length, shin))))
    lower = quaternion.multiply(upper, flexed)
    quaternion.put(rotations, HIPS[side], quaternion.multiply(quaternion.conjugate(pelvis), upper))
    quaternion.put(rotations, KNEES[side], flexed)
    quaternion.put(rotations, ANKLES[side], quaternion.multiply(quaternion.conjugate(lower), foot))
    quaternion.put(rotations, TOES[side], quaternion.about_y(-toe_rad))


@inner_kernel
def _cosine(a, b, opposite):
    """The cosine of the angle between the sides a and b of a triangle."""
    return min(max((a * a + b * b - opposite * opposite) / (2.0 * a * b), -1.0), 1.0)


@inner_kernel
def _about_y(cosine):
    """The turn about Y by the angle in [0, pi] of a cosine, without the angle."""
    return (math.sqrt(0.5 * (1.0 + cosine)), 0.0, math.sqrt(0.5 * (1.0 - cosine)), 0.0)


@inner_kernel
def place_pelvis(body, asked, balance_rad):
    """Where the pelvis is for what is asked (LowerBody): its place (3,), its orientation, both hips (left, right);
    world.
    """
    left, right = hips_of(asked, balance_rad)
    pelvis = pelvis_turned(body, left, right, asked.pelvis_rad[0])
    return vector.subtract(left, quaternion.rotate(pelvis, body.offset_m[HIPS[0]])), pelvis, left, right


@njit(cache=True)
def solve_lower_body(body, asked, balance_rad, root_m, rotations):
    """Writes the pelvis (root_m (3,), rotations row) and both legs (rotations (J, 4)) for what is asked
    (LowerBody).
    """
    place, pelvis, left, right = place_pelvis(body, asked, balance_rad)
    root_m[0], root_m[1], root_m[2] = place
    quaternion.put(rotations, PELVIS, pelvis)
    for side in range(2):
        hip = left if side == 0 else right
        fit_leg(body, side, pelvis, hip, asked.ankle_m[side], asked.foot_turned[side], asked.toe_rad[side], rotations)
