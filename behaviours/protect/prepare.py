"""Everything that is settled before a protective pose is worked out: the start pose, the feet, what is chosen once."""

from __future__ import annotations

from typing import Any

import numpy as np

from behaviours.perceive.perceived import PerceivedThreat, target_centre
from behaviours.protect import plant
from behaviours.protect.apply_rules import hang_leg, place_trunk
from behaviours.protect.look_ahead import PelvisWay, go_ahead
from behaviours.protect.mirroring import mirror_pose, mirror_task, mirror_threat
from behaviours.protect.task import AtPerception, Choices, FeetPlan, Posed, Rules, Start, Task, bones_of, new_posed
from behaviours.rules.controls import LEAN, TURN, controls_from_threat
from behaviours.rules.turn import TURN_RIGHT, turn_side, wanted_turn
from behaviours.rules.wrap import wrap_share
from behaviours.settings import Settings
from engine.body.kinematics import joints_of
from engine.body.limits import components
from engine.body.skeleton import (
    BACK,
    HEAD,
    HIPS,
    JOINT_COUNT,
    LEFT_SHOULDER,
    PELVIS,
    RIGHT_SHOULDER,
    Body,
    Pose,
)
from engine.clips.mirror import mirror_body
from engine.maths import quaternion, vector
from engine.maths.kernel import njit

LEG_JOINTS = 4  # hip, knee, ankle, toe, one after the other
UP = (0.0, 0.0, 1.0)


def prepare(body: Body, at: AtPerception, threat: PerceivedThreat, settings: Settings) -> Task:
    """The task of protecting against a threat, before any rule has acted."""
    if _side(at, threat, settings) == TURN_RIGHT:
        return _prepare(body, at, threat, settings)
    # who turns left is worked out in the mirror, see behaviours.protect.mirroring
    mirrored = AtPerception(
        _contiguous(mirror_pose(at.now)), _contiguous(mirror_pose(at.ahead)), np.array(at.planted, bool)[::-1],
        at.landing, -at.turn_side,
    )  # fmt: skip
    return mirror_task(_prepare(mirror_body(body), mirrored, mirror_threat(threat), settings))


def _side(at: AtPerception, threat: PerceivedThreat, settings: Settings) -> float:
    """Which way this threat turns the character."""
    heading = quaternion.heading(at.now.rotations[PELVIS])
    travel = quaternion.unrotate(quaternion.about_z(heading), threat.direction)
    return turn_side(travel, settings.lean_turn.dead_ahead_rad, float(at.turn_side))


def _contiguous(pose: Pose) -> Pose:
    return Pose(np.ascontiguousarray(pose.root_m), np.ascontiguousarray(pose.rotations))


def _prepare(body: Body, at: AtPerception, threat: PerceivedThreat, settings: Settings) -> Task:
    """The same for a threat that turns the character right."""
    stands_in = at.ahead if at.landing else at.now
    positions, orientations = joints_of(body, stands_in)
    feet = plant.stand_where_planted(at.planted, positions, orientations, stands_in.rotations)
    legs_ahead = [at.landing or not stands for stands in feet.held]
    start = start_pose(body, at.now, at.ahead, legs_ahead)
    task = Task(*bones_of(body), start, feet, threat, _no_choices(), rules_of(settings))
    task = task._replace(choices=choose_turn(task, settings, at.turn_side))

    # the pelvis goes as far ahead as the planted legs allow, then the foot in the air is set down
    controls = controls_from_threat(threat.speed_norm, threat.size_norm)
    balance, posed = settings.balance, new_posed()
    way = PelvisWay(*_pelvis_of(stands_in), *_pelvis_of(at.ahead), orientations[list(HIPS)])
    go_ahead(task, controls, way, balance.leg_share, balance.brace_m, posed)
    place_hips(task, controls, posed)
    if feet.held.any():
        feet = _set_down(body, task, controls, joints_of(body, at.ahead), posed, settings)
    feet = feet._replace(step_m=plant.steps_m(feet, joints_of(body, at.now)[0]))
    task = task._replace(feet=feet)
    return task._replace(choices=choose_guard(task, posed))


def _set_down(
    body: Body, task: Task, controls, ahead: tuple[np.ndarray, np.ndarray], posed: Posed, settings: Settings
) -> FeetPlan:
    """The feet with one that is in the air set down, the start pose's pelvis lowered for it. `ahead`: see joints_of."""
    balance, hips = settings.balance, list(HIPS)
    task.start.root_m[2] -= plant.lowering_m(
        body, task.feet, posed.positions[hips], balance.leg_share, balance.lower_for_foot_m
    )
    place_hips(task, controls, posed)
    return plant.set_down(body, task.feet, posed.positions[hips], *ahead, balance.leg_share)


def _pelvis_of(pose: Pose) -> tuple[Any, Any]:
    """Place and orientation of the pelvis, as tuples for kernels."""
    return tuple(float(v) for v in pose.root_m), tuple(float(v) for v in pose.rotations[PELVIS])


def start_pose(body: Body, pose_now: Pose, pose_ahead: Pose, legs_ahead) -> Start:
    """The pelvis, and the legs asked for, from the clip ahead; everything else from the pose at perception."""
    rotations = np.array(pose_now.rotations, float)
    rotations[PELVIS] = pose_ahead.rotations[PELVIS]
    for side in range(2):
        if legs_ahead[side]:
            leg = slice(HIPS[side], HIPS[side] + LEG_JOINTS)
            rotations[leg] = pose_ahead.rotations[leg]
    root_m = np.array(pose_ahead.root_m, float)
    _, orientations = joints_of(body, Pose(root_m, rotations))
    low, high = np.empty((JOINT_COUNT, 3)), np.empty((JOINT_COUNT, 3))
    _widened_limits(body.limit_low_rad, body.limit_high_rad, rotations, low, high)
    return Start(
        root_m,
        rotations,
        orientations,
        float(quaternion.heading(pose_now.rotations[PELVIS])),
        low,
        high,
    )


@njit(cache=True)
def _widened_limits(low, high, rotations, out_low, out_high):
    """A clip's own excess is kept: each limit it oversteps is moved out to where the clip stands."""
    for j in range(JOINT_COUNT):
        own = components(quaternion.at(rotations, j))
        for k in range(3):
            out_low[j, k] = min(low[j, k], own[k])
            out_high[j, k] = max(high[j, k], own[k])


def rules_of(settings: Settings) -> Rules:
    return Rules(
        settings.lean_turn, settings.recoil, settings.block, settings.wrap, settings.pelvis,
        settings.balance.limit_margin_rad,
    )  # fmt: skip


def _no_choices() -> Choices:
    return Choices(-1.0, 0.0, (0.0, 1.0, 0.0), UP, 0.0)


@njit(cache=True)
def place_hips(task, controls, posed):
    """Trunk and hips of the rules pose with the pelvis where the start pose has it."""
    start, offset_m = task.start, task.bones.offset_m
    place_trunk(
        vector.at(start.root_m.reshape(1, 3), 0), controls[LEAN], controls[TURN], start.heading_rad,
        task.threat, task.choices, task.rules, offset_m, start.rotations, start.orientations,
        start.low_rad, start.high_rad, posed.rotations, posed.positions, posed.orientations,
    )  # fmt: skip
    for side in range(2):
        hang_leg(side, offset_m, start.rotations, posed.rotations, posed.positions, posed.orientations)


def choose_turn(task: Task, settings: Settings, previous_turn_side: float) -> Choices:
    """Which way to turn, and how far it would have to be, from where the face points in the start pose."""
    heading = task.start.heading_rad
    travel = quaternion.unrotate(quaternion.about_z(heading), task.threat.direction)
    side = turn_side(travel, settings.lean_turn.dead_ahead_rad, float(previous_turn_side))
    head_yaw = quaternion.heading(task.start.orientations[HEAD]) - heading
    return _no_choices()._replace(turn_side=side, turn_rad=wanted_turn(head_yaw, travel, side))


def choose_guard(task: Task, posed: Posed) -> Choices:
    """How the hands stand to the line, from the rules pose before block: sides, fingers, and how far the arms wrap."""
    tangent = task.threat.tangent
    torso_x = quaternion.rotate(posed.orientations[BACK], (1.0, 0.0, 0.0))
    shoulders = vector.subtract(
        *(shoulder_before_recoil(task, posed, joint) for joint in (LEFT_SHOULDER, RIGHT_SHOULDER))
    )
    shoulders = vector.unit((shoulders[0], shoulders[1], 0.0), (0.0, 1.0, 0.0))
    across = vector.unit(vector.cross(tangent, UP), shoulders)
    # a line that comes along the shoulders has no left hand's side: there the offset goes smoothly through zero
    agree = vector.inner(across, shoulders) / max(task.rules.block.offset_fade, 1e-9)
    agree = min(1.0, max(-1.0, agree))
    upright = vector.reject(UP, tangent)
    steep = max(0.0, 0.3 - vector.length(upright))
    fingers = vector.unit(vector.add(upright, vector.scale(vector.reject(torso_x, tangent), steep)), UP)
    towards = vector.scale(task.threat.direction, -1.0)
    return task.choices._replace(
        across=vector.scale(across, agree * (1.5 - 0.5 * agree * agree)),
        fingers=fingers,
        wrap=float(wrap_share(torso_x, towards, task.rules.wrap)),
    )


def shoulder_before_recoil(task: Task, posed: Posed, shoulder: int):
    """Where a shoulder is on the turned trunk with the clavicle as the clip has it."""
    offset_m, clavicle = task.bones.offset_m, shoulder - 1
    at = vector.add(posed.positions[BACK], quaternion.rotate(posed.orientations[BACK], offset_m[clavicle]))
    turned = quaternion.multiply(posed.orientations[BACK], task.start.rotations[clavicle])
    return vector.add(at, quaternion.rotate(turned, offset_m[shoulder]))


def aim_point(task: Task) -> tuple[float, float, float]:
    """The target's centre in the rules pose before block: where a scripted threat goes. World metres."""
    posed = new_posed()
    controls = controls_from_threat(task.threat.speed_norm, task.threat.size_norm)
    place_hips(task, controls, posed)
    return target_centre(task.threat.target_joint, task.threat.target_offset_m, posed.positions, posed.orientations)
