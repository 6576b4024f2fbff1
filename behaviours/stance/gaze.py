"""The head (section 5.4): turned to look at a point, weighted between its rest position and full alignment."""

from __future__ import annotations

import math

from behaviours import timing
from engine.body import limits
from engine.body.skeleton import BACK, HEAD, NECK
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

# the neck's share of a turn of the head; the rest is the head's own (limits: 3 to 1)
NECK_SHARE = 0.7
# the eyes, as shares of the height of the crown over the head's joint: ahead and up
EYES = (0.6, 0.0, 0.45)
STEEP = 0.7  # a direction whose level part is shorter than this loses its yaw bit by bit ...
BEHIND = math.radians(50.0)  # ... and so does one that is as near as this to straight behind


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
    """Turns neck and head towards a target (3,), in place: rotations (J, 4), positions (J, 3), orientations (J, 4) of
    one pose.

    Seen from the chest the face turns sideways, then up or down, as people do; a turn by the shortest way would tilt
    the head. The neck takes its share, the head the rest from where that has brought it, both inside their limits.
    """
    chest = orientations[BACK]
    rest = direction_angles(quaternion.unrotate(chest, quaternion.rotate(orientations[HEAD], (1.0, 0.0, 0.0))))
    _look_with(body, rotations, positions, orientations, NECK, BACK, target_m, rest, weight * NECK_SHARE)
    _look_with(body, rotations, positions, orientations, HEAD, NECK, target_m, rest, weight)


@inner_kernel
def direction_angles(direction):
    """(yaw, pitch) of a unit direction: to the left, and up.

    Yaw fades out where it has no meaning, straight up and down, and straight behind, where no head turns and either
    way is as far.
    """
    level = math.hypot(direction[0], direction[1])
    yaw = math.atan2(direction[1], direction[0])
    clear = timing.ease(level / STEEP) * timing.ease((math.pi - abs(yaw)) / BEHIND)
    return (clear * yaw, math.atan2(direction[2], level))


@inner_kernel
def _look_with(body, rotations, positions, orientations, joint, parent, target_m, rest, weight):
    """Turns one joint until the face points as far from its rest angles towards the target as the weight says."""
    chest = orientations[BACK]
    line = vector.subtract(target_m, eyes_m(body, positions, orientations))
    wanted = direction_angles(quaternion.unrotate(chest, vector.unit(line, (1.0, 0.0, 0.0))))
    face = direction_angles(quaternion.unrotate(chest, quaternion.rotate(orientations[HEAD], (1.0, 0.0, 0.0))))
    yaw = rest[0] + weight * (wanted[0] - rest[0])
    pitch = rest[1] + weight * (wanted[1] - rest[1])
    # in the chest's frame: level the face, turn it, lift it again
    level = quaternion.multiply(quaternion.about_y(face[1]), quaternion.about_z(-face[0]))
    turn = quaternion.multiply(quaternion.multiply(quaternion.about_z(yaw), quaternion.about_y(-pitch)), level)
    turn = quaternion.multiply(quaternion.multiply(chest, turn), quaternion.conjugate(chest))
    _turn(body, rotations, orientations, joint, parent, turn)
    _place(body, rotations, positions, orientations, HEAD, NECK)


@njit(cache=True)
def _turn(body, rotations, orientations, joint, parent, world_turn):
    """Turns a joint by a world rotation as far as its limits let it, and writes its orientation."""
    turned = quaternion.multiply(world_turn, orientations[joint])
    local = quaternion.multiply(quaternion.conjugate(orientations[parent]), turned)
    local = limits.clamp_rotation(body.limit_low_rad[joint], body.limit_high_rad[joint], quaternion.normalise(local))
    quaternion.put(rotations, joint, local)
    quaternion.put(orientations, joint, quaternion.multiply(orientations[parent], local))


@njit(cache=True)
def _place(body, rotations, positions, orientations, joint, parent):
    """A joint's position and orientation from its parent's."""
    p = vector.add(positions[parent], quaternion.rotate(orientations[parent], body.offset_m[joint]))
    positions[joint, 0], positions[joint, 1], positions[joint, 2] = p
    quaternion.put(orientations, joint, quaternion.multiply(orientations[parent], rotations[joint]))
