"""One evaluation: the start pose, its pelvis moved, lean, turn, feet planted, recoil, block. Hermens 2006, 3.2 and 3.3.

The feet are planted after the turn, which turns the pelvis and would drag them.
"""

from __future__ import annotations

from numba import njit

from behaviours.perceived import target_centre
from behaviours.rules import block, lean, recoil, turn, wrap
from behaviours.rules.controls import LEAN, REACH_LEFT, RECOIL, SWIVEL_LEFT, TURN
from engine.body.limb_ik import DOWN, KEEP, SOFT_REACH_M, arm_onto, leg_onto, place_children
from engine.body.limits import clamp_rotation
from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    ELBOWS,
    HEAD,
    HIPS,
    JOINT_COUNT,
    KNEES,
    PELVIS,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
)
from engine.maths import quaternion, vector

SAME_TURN_RAD = 1e-6  # a hand that got the turn it wanted needs no second look

# These kernels run some hundred times a pose. Joined into one (forceinline), they need not count references to the
# arrays that they hand on, which would cost as much as the arithmetic.
kernel = njit(cache=True, forceinline=True)


@njit(cache=True)
def apply_rules(task, pelvis_shift, controls, soft_m, posed):
    """Writes the pose that seven controls (7,) and a shift of the pelvis (3,) give. soft_m: see limb_ik.soft_reach."""
    place_trunk(task, pelvis_shift, controls, posed)
    for side in range(2):
        plant_leg(task, side, soft_m, posed)
        guard(task, side, controls, posed)


@kernel
def place_trunk(task, pelvis_shift, controls, posed):
    """The pelvis moved, then lean and turn, within the joints' limits; the trunk, neck and head placed in the world."""
    start, threat, rules = task.start, task.threat, task.rules
    for j in range(JOINT_COUNT):
        for k in range(4):
            posed.rotations[j, k] = start.rotations[j, k]
    travel = quaternion.unrotate(quaternion.about_z(start.heading_rad), threat.direction)
    lean.lean_away(
        posed.rotations, start.orientations, start.heading_rad, travel, controls[LEAN], rules.lean_turn,
        threat.head_weight, threat.pelvis_weight, rules.pelvis.lean_sign,
    )  # fmt: skip
    turn.turn_away(posed.rotations, task.choices.turn_rad, controls[TURN], rules.lean_turn)
    for k in range(3):
        posed.positions[PELVIS, k] = start.root_m[k] + pelvis_shift[k]
    for k in range(4):
        posed.orientations[PELVIS, k] = posed.rotations[PELVIS, k]
    for joint in range(WAIST, HEAD + 1):  # each the parent of the next
        if joint != HEAD:
            _clamp(start.low_rad, start.high_rad, posed.rotations, joint)
        _place(task.bones.offset_m, posed, joint - 1, joint)


@kernel
def _clamp(low_rad, high_rad, rotations, joint):
    q = clamp_rotation(low_rad[joint], high_rad[joint], rotations[joint])
    rotations[joint, 0], rotations[joint, 1], rotations[joint, 2], rotations[joint, 3] = q


@kernel
def _place(offset_m, posed, parent, joint):
    place_children(offset_m, posed.rotations, posed.positions, posed.orientations, parent, joint)


@kernel
def plant_leg(task, side, soft_m, posed):
    """A held foot is put where it stands by leg IK; the knee keeps pointing where it did in the world, over the foot."""
    hip, knee, ankle, toe = HIPS[side], KNEES[side], ANKLES[side], TOES[side]
    bones, feet = task.bones, task.feet
    posed.foot_miss_m[side] = 0.0
    if feet.held[side]:
        # the pelvis turns away over a foot that stays: the thigh starts from its own place in the world, not the pelvis's
        thigh = quaternion.multiply(quaternion.conjugate(posed.orientations[PELVIS]), task.start.orientations[hip])
        for k in range(4):
            posed.rotations[hip, k] = thigh[k]
            posed.rotations[toe, k] = feet.toe[side, k]
    _place(bones.offset_m, posed, PELVIS, hip)
    _place(bones.offset_m, posed, hip, knee)
    _place(bones.offset_m, posed, knee, ankle)
    if feet.held[side]:
        posed.foot_miss_m[side] = leg_onto(
            bones.offset_m, bones.knee_rad[side], posed.rotations, posed.positions, posed.orientations, side,
            (feet.ankle_m[side, 0], feet.ankle_m[side, 1], feet.ankle_m[side, 2]), feet.turned[side], KEEP, soft_m,
        )  # fmt: skip
    else:
        _place(bones.offset_m, posed, ankle, toe)


@kernel
def guard(task, side, controls, posed):
    """Recoil and block of one side: the clavicle raised, the palm put where it belongs, the elbow at its swivel."""
    bones, start = task.bones, task.start
    clavicle, shoulder, elbow, wrist = CLAVICLES[side], SHOULDERS[side], ELBOWS[side], WRISTS[side]
    recoil.raise_clavicle(posed.rotations, side, controls[RECOIL], task.rules.recoil)
    _clamp(start.low_rad, start.high_rad, posed.rotations, clavicle)
    _place(bones.offset_m, posed, BACK, clavicle)
    _place(bones.offset_m, posed, clavicle, shoulder)
    _place(bones.offset_m, posed, shoulder, elbow)
    _place(bones.offset_m, posed, elbow, wrist)
    palm, hand, swivel = guard_goal(task, side, controls, posed)
    turned = hand
    for _ in range(2):
        # a hand stopped by its limits holds its palm elsewhere: the arm follows once
        put_palm(bones, start.low_rad, start.high_rad, side, palm, turned, hand, swivel, posed)
        q = posed.orientations[wrist]
        turned = (q[0], q[1], q[2], q[3])
        if quaternion.angle_between(turned, hand) < SAME_TURN_RAD:
            break
    at = vector.add(posed.positions[wrist], quaternion.rotate(posed.orientations[wrist], bones.palm_m[side]))
    posed.palms[side, 0], posed.palms[side, 1], posed.palms[side, 2] = at


@kernel
def guard_goal(task, side, controls, posed):
    """Where one palm is wanted, how the hand is turned (world) and the elbow's swivel: block, wrap, or a mixture."""
    bones, threat, choices = task.bones, task.threat, task.choices
    b, w, p = task.rules.block, task.rules.wrap, task.rules.pelvis
    reach_control, swivel_control = controls[REACH_LEFT + side], controls[SWIVEL_LEFT + side]
    head_reach = block.reach_m(reach_control, b.reach_far_m, b.reach_near_m, bones.arm_m[side], b.arm_share)
    pelvis_reach = block.reach_m(reach_control, p.reach_far_m, p.reach_near_m, bones.arm_m[side], b.arm_share)
    palm = block.palm_target(
        side,
        posed.positions[SHOULDERS[side]],
        threat.head_weight * head_reach + threat.pelvis_weight * pelvis_reach,
        target_centre(threat.target_joint, threat.target_offset_m, posed.positions, posed.orientations),
        threat.line_point_m,
        threat.tangent,
        choices.across,
        quaternion.rotate(posed.orientations[BACK], (1.0, 0.0, 0.0)),
        b.clearance_m + threat.excess_radius_m,
        b.offset_m,
        b.soften_m,
    )
    hand = block.hand_facing(side, vector.scale(threat.tangent, -1.0), choices.fingers)
    swivel = block.swivel_rad(swivel_control, b.swivel_small_rad, b.swivel_large_rad)
    if choices.wrap > 0.0:
        head = posed.orientations[HEAD]
        centre = vector.add(posed.positions[HEAD], quaternion.rotate(head, bones.head_centre_m))
        behind = wrap.wrapped_palm(side, centre, head, bones.head_radius_m, w)
        normal, fingers = wrap.wrapped_hand(side, head, w)
        palm = wrap.around_head(vector.mix(palm, behind, choices.wrap), centre, bones.head_radius_m + w.palm_gap_m)
        hand = quaternion.slerp(hand, block.hand_facing(side, normal, fingers), choices.wrap)
        swivel += (w.swivel_rad - swivel) * choices.wrap
    return palm, hand, swivel


@kernel
def put_palm(bones, low_rad, high_rad, side, palm, turned, hand, swivel, posed):
    """Moves the arm so that a hand turned like `turned` has its palm on the target; then turns it to `hand`, as far as it goes."""
    at = vector.subtract(palm, quaternion.rotate(turned, bones.palm_m[side]))
    arm_onto(
        bones.offset_m, bones.elbow_rad[side], posed.rotations, posed.positions, posed.orientations, side,
        at, swivel, DOWN, SOFT_REACH_M,
    )  # fmt: skip
    turn_hand(bones.offset_m, low_rad, high_rad, side, hand, posed)


@kernel
def turn_hand(offset_m, low_rad, high_rad, side, hand, posed):
    """Gives the hand a world orientation within the limits: what turns about the forearm is the forearm's to do."""
    shoulder, elbow, wrist = SHOULDERS[side], ELBOWS[side], WRISTS[side]
    wanted = quaternion.multiply(quaternion.conjugate(posed.orientations[elbow]), hand)
    # wanted = twist * swing, the forearm turning first: the split of the inverse, inverted
    _, twist = quaternion.swing_twist(quaternion.conjugate(wanted))
    turned = quaternion.multiply(posed.rotations[elbow], quaternion.conjugate(twist))
    posed.rotations[elbow, 0], posed.rotations[elbow, 1], posed.rotations[elbow, 2], posed.rotations[elbow, 3] = turned
    _clamp(low_rad, high_rad, posed.rotations, elbow)
    _place(offset_m, posed, shoulder, elbow)
    swing = quaternion.multiply(quaternion.conjugate(posed.orientations[elbow]), hand)
    posed.rotations[wrist, 0], posed.rotations[wrist, 1], posed.rotations[wrist, 2], posed.rotations[wrist, 3] = swing
    _clamp(low_rad, high_rad, posed.rotations, wrist)
    _place(offset_m, posed, elbow, wrist)
