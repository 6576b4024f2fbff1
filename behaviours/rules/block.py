"""Block (Hermens 2006, 3.2.5, figs. 3.6 - 3.8): the palms meet the threat on its line of approach, before it meets
the body.

A small threat is reached for, to knock it away; before a large one the arms stay close and the pose is small.
All points and directions are the world's; the line of approach is a point on it and the unit tangent of the threat's
travel.
"""

from __future__ import annotations

import math

from engine.body.skeleton import LEFT
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.kernel import njit

LINE_SOFTNESS_M = 0.05  # over which "the line is just within reach" becomes "it passes farther off"


@njit(cache=True)
def smooth_max(a, b, width):
    """The larger of two numbers; where they lie closer than `width`, a parabola joins them without a kink."""
    d = a - b
    if d >= width:
        return a
    if d <= -width:
        return b
    return b + (d + width) ** 2 / (4.0 * width)


@njit(cache=True)
def reach_m(control, far_m, near_m, arm_m, arm_share):
    """How far a palm goes from its own shoulder: the far reach, but no more than the arm has, at control 0; near at
    1.
    """
    far = min(far_m, arm_share * arm_m)
    return far + (min(near_m, far) - far) * control


@njit(cache=True)
def distance_on_line(shoulder, line_point, tangent, reach):
    """How far before `line_point`, against the travel, the palm stands: the point at its reach, nearer the threat,
    metres.

    Where the line passes farther from the shoulder than the reach, its nearest point; the two cases meet smoothly.
    """
    from_shoulder = vector.subtract(line_point, shoulder)
    nearest = vector.inner(from_shoulder, tangent)
    across2 = vector.inner(from_shoulder, from_shoulder) - nearest * nearest
    spare2 = reach * reach - across2
    spare2 = 0.5 * (spare2 + math.sqrt(spare2 * spare2 + LINE_SOFTNESS_M**4))
    return nearest + math.sqrt(spare2)


@njit(cache=True)
def palm_target(side, shoulder, reach, target, line_point, tangent, across, torso_x, clearance_m, offset_m, soften_m):
    """Where one palm centre goes, in the world.

    target: centre of what is threatened, as it stands now; the palm keeps its clearance from it along the line,
    whatever the reach. across: unit horizontal across the line, to the left shoulder's side; each palm keeps to its
    own side by the offset. torso_x: where the chest faces; no hand goes behind the plane through its shoulder.
    """
    least = vector.inner(vector.subtract(line_point, target), tangent) + clearance_m
    before = smooth_max(distance_on_line(shoulder, line_point, tangent, reach), least, soften_m)
    palm = vector.along(line_point, tangent, -before)
    palm = vector.along(palm, across, offset_m if side == LEFT else -offset_m)
    ahead = vector.inner(vector.subtract(palm, shoulder), torso_x)
    return vector.along(palm, torso_x, smooth_max(ahead, 0.0, soften_m) - ahead)


@njit(cache=True)
def fingers_from_up(arm, up, group):
    """How far a blocking hand's fingers are turned from upright, inwards, radians.

    arm: unit, from shoulder to palm; up: where upright fingers point. A hand held up to the face keeps its fingers up;
    one that hangs before the hips could do so only with its wrist bent back as far as it goes: its fingers point down.
    """
    hanging = -vector.inner(arm, up)
    share = (hanging - group.fingers_up_until) / max(group.fingers_down_from - group.fingers_up_until, 1e-9)
    share = min(1.0, max(0.0, share))
    return group.fingers_down_rad * share * share * (3.0 - 2.0 * share)


@inner_kernel
def fingers_turned(side, up, across, turn_rad):
    """Where the fingers point: unit, `up` turned inwards, away from this hand's own side of the line."""
    inwards = vector.scale(across, -math.sin(turn_rad) if side == LEFT else math.sin(turn_rad))
    return vector.unit(vector.add(vector.scale(up, math.cos(turn_rad)), inwards), up)


@njit(cache=True)
def hand_facing(side, normal, fingers):
    """The orientation of a hand whose palm faces along `normal`, fingers along `fingers`: unit, at right angles.

    In the identity pose fingers point along -Z and the palms face each other: the left one -Y, the right one +Y.
    """
    z = vector.scale(fingers, -1.0)
    y = vector.scale(normal, -1.0 if side == LEFT else 1.0)
    return quaternion.from_columns(vector.cross(y, z), y, z)


@njit(cache=True)
def swivel_rad(control, small_rad, large_rad):
    """The elbow's angle away from down about shoulder - wrist: out for a small threat, close to the body for a large
    one.
    """
    return small_rad + (large_rad - small_rad) * control
