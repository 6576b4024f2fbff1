"""How far two arms are from what is wished of them, and what is wrong with that: residuals for least squares.

Seven numbers an arm say how far it departs from its wish: the palm's shift (3, metres, in the chest's frame), the
elbow's swing aside (radians), the hand's turn (3, about its own axes, radians). Departing costs; so do a joint beyond
its limits, a forearm or hand inside trunk, head or the other arm, and a wrist bent hard. A blocking palm moves more
readily along the line of approach than off it.
"""

from __future__ import annotations

from behaviours.protect.guard import put_palm
from engine.body.limits import components
from engine.body.skeleton import BACK, ELBOWS, SHOULDERS, WRISTS
from engine.maths import quaternion, vector
from engine.maths.inner_kernel import inner_kernel
from engine.maths.shapes import boxes_apart, nearest_between

ARM_VARIABLES, SWING, TURN = 7, 3, 4
VARIABLES = 2 * ARM_VARIABLES

# one unit of trouble is: a palm that far off its line, or farther along it;
OFF_LINE_M, ALONG_LINE_M = 0.06, 0.20
# an elbow swung that far aside, a hand turned that far about its palm's normal, a palm tilted that far;
SWING_RAD, ROLL_RAD, TILT_RAD = 1.2, 1.0, 0.6
# a wrist flexed or extended that far, bent aside that far, a forearm turned that far
FLEX_RAD, ASIDE_RAD, FOREARM_RAD = 1.2, 0.5, 2.0
LIMIT_PER_RAD = 40.0  # how dear a joint beyond its limits is
DEPTH_PER_M = 400.0  # how dear an arm inside something is
SKIN_M = 0.004  # skins that come nearer than this already begin to push

# rows of the residuals: those of one arm, those of the other, those of both against each other
SHIFT_ROW, SWING_ROW, TURN_ROW, WRIST_ROW, SHOULDER_ROW, TWIST_ROW, BENT_ROW, DEPTH_ROW = 0, 3, 4, 7, 10, 13, 14, 17
OBSTACLE_COUNT = 6
ARM_ROWS = DEPTH_ROW + 2 * OBSTACLE_COUNT
ROWS = 2 * ARM_ROWS + 4


@inner_kernel
def place_obstacles(joints, ends_m, positions, orientations, obstacles):
    """Writes where the capsules that arms must clear are in the world: (C, 6), both ends of each."""
    for c in range(len(joints)):
        at, turned = vector.at(positions, joints[c]), quaternion.at(orientations, joints[c])
        for end in range(2):
            p = vector.add(at, quaternion.rotate(turned, (ends_m[c, end, 0], ends_m[c, end, 1], ends_m[c, end, 2])))
            for k in range(3):
                obstacles[c, 3 * end + k] = p[k]


@inner_kernel
def put_arm(task, wishes, point, side, posed):
    """One arm as far from its wish as its numbers in `point` say, in place; returns the palm's centre."""
    p = side * ARM_VARIABLES
    chest = quaternion.at(posed.orientations, side - side + BACK)
    palm = vector.add(vector.at(wishes, side), quaternion.rotate(chest, (point[p], point[p + 1], point[p + 2])))
    turn = quaternion.from_rotation_vector((point[p + TURN], point[p + TURN + 1], point[p + TURN + 2]))
    wished = (wishes[side, 3], wishes[side, 4], wishes[side, 5], wishes[side, 6])
    hand, elbow_way = quaternion.multiply(wished, turn), (wishes[side, 7], wishes[side, 8], wishes[side, 9])
    return put_palm(
        side, palm, hand, elbow_way, point[p + SWING], task.build.palm_m[side],
        task.build.elbow_rad[side], task.bones.offset_m, posed.rotations, posed.positions, posed.orientations,
    )  # fmt: skip


@inner_kernel
def arm_trouble(task, wishes, line, along, hard, point, side, posed, segments, residuals):
    """Poses one arm and writes its residuals; segments (2, 12): its elbow, wrist and both ends of its hand, world."""
    build, p, row = task.build, side * ARM_VARIABLES, side * ARM_ROWS
    put_arm(task, wishes, point, side, posed)
    shift = (point[p], point[p + 1], point[p + 2])
    eased = along * vector.inner(shift, line)
    for k in range(3):
        residuals[row + SHIFT_ROW + k] = shift[k] / OFF_LINE_M + eased * line[k]
    residuals[row + SWING_ROW] = point[p + SWING] / SWING_RAD
    residuals[row + TURN_ROW] = point[p + TURN] / TILT_RAD
    residuals[row + TURN_ROW + 1] = point[p + TURN + 1] / ROLL_RAD
    residuals[row + TURN_ROW + 2] = point[p + TURN + 2] / TILT_RAD
    _joint_trouble(task.start, task.rules.limit_margin_rad, hard, side, posed.rotations, row, residuals)
    wrist = vector.at(posed.positions, WRISTS[side])
    turned = quaternion.at(posed.orientations, WRISTS[side])
    _put_axis(segments, side, 0, vector.at(posed.positions, ELBOWS[side]), wrist)
    first = vector.add(wrist, quaternion.rotate(turned, build.hand_start_m[side]))
    last = vector.add(wrist, quaternion.rotate(turned, build.hand_end_m[side]))
    _put_axis(segments, side, 6, first, last)
    for part in range(2):
        radius_m = build.arm_radius_m[side] if part == 0 else build.hand_radius_m
        for c in range(OBSTACLE_COUNT):
            residuals[row + DEPTH_ROW + OBSTACLE_COUNT * part + c] = hard * _pressed(
                _axis(segments, side, 6 * part), _axis(posed.obstacles, c, 0), radius_m + build.obstacle_radius_m[c]
            )


@inner_kernel
def _joint_trouble(start, margin_rad, hard, side, rotations, row, residuals):
    """The residuals of one arm's joints: a wrist that is bent hard, and whatever is beyond a limit."""
    shoulder, elbow, wrist = SHOULDERS[side], ELBOWS[side], WRISTS[side]
    bent = components(quaternion.at(rotations, wrist))
    forearm = components(quaternion.at(rotations, elbow))[2]
    residuals[row + WRIST_ROW] = bent[0] / FLEX_RAD
    residuals[row + WRIST_ROW + 1] = bent[1] / ASIDE_RAD
    residuals[row + WRIST_ROW + 2] = forearm / FOREARM_RAD
    raised = components(quaternion.at(rotations, shoulder))
    for k in range(3):
        residuals[row + SHOULDER_ROW + k] = hard * _beyond(
            start.low_rad, start.high_rad, margin_rad, shoulder, k, raised[k]
        )
        residuals[row + BENT_ROW + k] = hard * _beyond(start.low_rad, start.high_rad, margin_rad, wrist, k, bent[k])
    residuals[row + TWIST_ROW] = hard * _beyond(start.low_rad, start.high_rad, margin_rad, elbow, 2, forearm)


@inner_kernel
def _beyond(low_rad, high_rad, margin_rad, joint, axis, angle_rad):
    """How dear it is that one component of a joint is beyond its limits, drawn in by a margin."""
    over = max(angle_rad - high_rad[joint, axis] + margin_rad, 0.0)
    under = max(low_rad[joint, axis] + margin_rad - angle_rad, 0.0)
    return LIMIT_PER_RAD * (over - under)


@inner_kernel
def _put_axis(rows, row, first, start, end):
    """Writes both ends of a capsule's axis into six numbers of a row (N, 6 and more), from `first` on."""
    for k in range(3):
        rows[row, first + k], rows[row, first + 3 + k] = start[k], end[k]


@inner_kernel
def _axis(rows, row, first):
    """Both ends of a capsule's axis out of there, as tuples."""
    return (
        (rows[row, first], rows[row, first + 1], rows[row, first + 2]),
        (rows[row, first + 3], rows[row, first + 4], rows[row, first + 5]),
    )


@inner_kernel
def _pressed(axis, other, radii_m):
    """How dear it is that two capsules, whose radii add up to this, are in each other, or nearly."""
    if boxes_apart(axis[0], axis[1], other[0], other[1], radii_m + SKIN_M):
        return 0.0
    s, t = nearest_between(axis[0], axis[1], other[0], other[1])
    apart_m = vector.distance(vector.mix(axis[0], axis[1], s), vector.mix(other[0], other[1], t))
    return DEPTH_PER_M * max(radii_m - apart_m + SKIN_M, 0.0)


@inner_kernel
def crossing(build, hard, segments, residuals):
    """The residuals of forearms and hands against each other."""
    for left in range(2):
        for right in range(2):
            radius_m = build.arm_radius_m[0] if left == 0 else build.hand_radius_m
            radius_m += build.arm_radius_m[1] if right == 0 else build.hand_radius_m
            residuals[2 * ARM_ROWS + 2 * left + right] = hard * _pressed(
                _axis(segments, 0, 6 * left), _axis(segments, 1, 6 * right), radius_m
            )
