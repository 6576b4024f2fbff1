"""The head (section 5.4): turned to look at a point, weighted between its rest position and full alignment."""

from __future__ import annotations

from numba import njit

from engine.body import limits
from engine.body.skeleton import BACK, HEAD, NECK
from engine.maths import quaternion, vector

# the neck's share of a turn of the head; the rest is the head's own (limits: 3 to 1)
NECK_SHARE = 0.7
# the eyes, as shares of the height of the crown over the head's joint: ahead and up
EYES = (0.6, 0.0, 0.45)


@njit(cache=True)
def eyes_m(body, positions, orientations):
    """Between the eyes, world."""
    height = body.head_top_m[2]
    local = (EYES[0] * height, 0.0, EYES[2] * height)
    return vector.add(positions[HEAD], quaternion.rotate(orientations[HEAD], local))


@njit(cache=True)
def gaze_error_rad(body, positions, orientations, target_m):
    """The angle between where the face points and the line from the eyes to the target."""
    face = quaternion.rotate(orientations[HEAD], (1.0, 0.0, 0.0))
    line = vector.unit(vector.subtract(target_m, eyes_m(body, positions, orientations)), face)
    return quaternion.angle_between(quaternion.IDENTITY, quaternion.between(face, line))


@njit(cache=True)
def look(body, rotations, positions, orientations, target_m, weight):
    """Turns neck and head towards a target (3,), in place: rotations (J, 4), positions (J, 3), orientations (J, 4) of one pose.

    The turn is the least one, so the head keeps its own tilt; the neck takes its share, the head the rest, both inside
    their limits; then once more for what moving the eyes has changed.
    """
    face = quaternion.rotate(orientations[HEAD], (1.0, 0.0, 0.0))
    rest_m = eyes_m(body, positions, orientations)
    line = vector.unit(vector.subtract(target_m, rest_m), face)
    turn = quaternion.to_rotation_vector(quaternion.between(face, line))
    part = weight * NECK_SHARE
    _turn(body, rotations, orientations, NECK, BACK, quaternion.from_rotation_vector(vector.scale(turn, part)))
    _place(body, rotations, positions, orientations, HEAD, NECK)
    # where the face is to point: from rest towards the target by the weight
    line = vector.unit(vector.subtract(target_m, eyes_m(body, positions, orientations)), face)
    turn = quaternion.to_rotation_vector(quaternion.between(face, line))
    wanted = quaternion.rotate(quaternion.from_rotation_vector(vector.scale(turn, weight)), face)
    now = quaternion.rotate(orientations[HEAD], (1.0, 0.0, 0.0))
    _turn(body, rotations, orientations, HEAD, NECK, quaternion.between(now, wanted))
    _place(body, rotations, positions, orientations, HEAD, NECK)


@njit(cache=True)
def _turn(body, rotations, orientations, joint, parent, world_turn):
    """Turns a joint by a world rotation as far as its limits let it, and writes its orientation."""
    turned = quaternion.multiply(world_turn, orientations[joint])
    local = quaternion.multiply(quaternion.conjugate(orientations[parent]), turned)
    local = limits.clamp_rotation(body.limit_low_rad[joint], body.limit_high_rad[joint], quaternion.normalise(local))
    _put(rotations, joint, local)
    _put(orientations, joint, quaternion.multiply(orientations[parent], local))


@njit(cache=True)
def _place(body, rotations, positions, orientations, joint, parent):
    """A joint's position and orientation from its parent's."""
    p = vector.add(positions[parent], quaternion.rotate(orientations[parent], body.offset_m[joint]))
    positions[joint, 0], positions[joint, 1], positions[joint, 2] = p
    _put(orientations, joint, quaternion.multiply(orientations[parent], rotations[joint]))


@njit(cache=True)
def _put(rows, joint, q):
    rows[joint, 0], rows[joint, 1], rows[joint, 2], rows[joint, 3] = q
