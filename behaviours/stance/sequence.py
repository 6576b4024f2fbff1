"""Poses joined into movement with ease-in, ease-out (section 7), on feet that never slide (section 4).

Between two solved stances everything that decides a pose goes over from one to the other: the feet (a foot that
changes its place is lifted), knees and pelvis, the wanted place of the centre of mass, the joints above. Tick by tick
the pose is put together from that, the root ankle fed with the balance error of the tick before; the lower body is
solved anew each time.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from behaviours.stance import balance, footprints, lower_body
from behaviours.stance.assembly import Figure, new_figure
from behaviours.stance.footprints import Footprints
from behaviours.stance.lower_body import LowerBody
from behaviours.stance.solve import StanceResult
from behaviours.timing import arc, ease
from engine.body import kinematics
from engine.body.skeleton import HIPS, KNEES, PELVIS, WRISTS, Body, Pose
from engine.maths import quaternion, rotations, vector

TICK_RATE_HZ = 120
FEEDBACK_PER_S = 18.0  # the rate at which a balance error dies away
UPPER = slice(PELVIS + 1, WRISTS[1] + 1)  # the joints above the pelvis
STEP_LIFT_M = 0.06


class Move(NamedTuple):
    """One movement of a sequence."""

    to: StanceResult
    move_s: float = 1.0
    hold_s: float = 0.5
    lift_m: float = STEP_LIFT_M  # how high a foot goes that changes its place


class Frame(NamedTuple):
    """One tick of a sequence."""

    pose: Pose
    joints_m: np.ndarray  # (J, 3)
    orientations: np.ndarray  # (J, 4)
    planted: np.ndarray  # (2,) feet on the ground
    com_m: np.ndarray  # (3,)
    com_wanted_m: np.ndarray  # (2,)


class Held(NamedTuple):
    """What a solved stance holds, measured on its finished pose."""

    feet: Footprints
    knee_rad: np.ndarray  # (2,)
    pelvis_rad: np.ndarray  # (3,) the paper's X, Y, Z
    upper: np.ndarray  # (12, 4) local rotations of the joints above the pelvis
    com_m: np.ndarray  # (2,) over which the centre of mass is
    root: int


def frames(body: Body, start: StanceResult, moves: list[Move], rate_hz: int = TICK_RATE_HZ) -> Iterator[Frame]:
    """All ticks of a sequence, from the start on."""
    here, figure = held(body, start), new_figure()
    positions, error = start.joints_m, (0.0, 0.0)
    for move in moves:
        there = held(body, move.to)
        there = there._replace(root=standing_root(body, here.feet, there.feet, there.root))
        # the dominant foot may change at any time: its offsets are those of the hip over it, wherever that is now
        offsets = offsets_of(here.feet, there.root, positions[HIPS[there.root]])
        moving, ticks = round(move.move_s * rate_hz), round((move.move_s + move.hold_s) * rate_hz)
        for tick in range(1, ticks + 1):
            progress = min(tick / moving, 1.0) if moving else 1.0
            asked, wanted = between(body, here, there, progress, move.lift_m, figure.rotations)
            search = balance.new_search(asked)
            offsets = balance.fed_back(search, offsets, error, FEEDBACK_PER_S, 1.0 / rate_hz)
            com = _assemble(body, asked, offsets, figure)
            error = (wanted[0] - com[0], wanted[1] - com[1])
            positions = figure.positions.copy()
            yield Frame(
                Pose(figure.root_m.copy(), figure.rotations.copy()), positions, figure.orientations.copy(),
                _planted(here.feet, there.feet, progress), com, wanted,
            )  # fmt: skip
        here = there


def standing_root(body: Body, start: Footprints, end: Footprints, root: int) -> int:
    """The dominant foot of a move: the one that is asked for, but never one that lifts while the other stays down
    (section 4).
    """
    flat_start, flat_end = (footprints.raised(body, feet, -feet.toe_rad) for feet in (start, end))
    moves = [_moves(flat_start, flat_end, side) for side in range(2)]
    return 1 - root if moves[root] and not moves[1 - root] else root


def held(body: Body, result: StanceResult) -> Held:
    """What a stance holds. Knees and pelvis as they are, not as they were asked for: they agree, whichever foot is
    the root.
    """
    lower, q = result.plan.lower, result.pose.rotations
    return Held(
        feet=result.feet,
        knee_rad=np.array([2.0 * math.atan2(q[k, 2], q[k, 0]) for k in KNEES]),
        pelvis_rad=pelvis_angles(body, lower.facing, q[PELVIS]),
        upper=q[UPPER].copy(),
        com_m=result.com_m[:2].copy(),
        root=lower.root,
    )


def pelvis_angles(body: Body, facing, pelvis) -> np.ndarray:
    """The paper's X, Y, Z (3,) of a pelvis orientation: what `lower_body` would have to be asked for to get it."""
    line = vector.unit(vector.subtract(body.offset_m[HIPS[0]], body.offset_m[HIPS[1]]), (0.0, 1.0, 0.0))
    turned = quaternion.multiply(quaternion.conjugate(facing), tuple(pelvis))
    hips = quaternion.rotate(turned, line)
    up = vector.unit(vector.reject((0.0, 0.0, 1.0), hips), (1.0, 0.0, 0.0))
    square = quaternion.rotate(quaternion.between((0.0, 1.0, 0.0), line), (0.0, 0.0, 1.0))
    tip = quaternion.rotate(turned, square)
    x = math.atan2(vector.inner(hips, vector.cross(up, tip)), vector.inner(up, tip))
    return np.array([x, math.atan2(-hips[0], hips[1]), math.asin(min(max(hips[2], -1.0), 1.0))])


def between(body: Body, start: Held, end: Held, progress: float, lift_m: float, out) -> tuple[LowerBody, np.ndarray]:
    """The lower body and the wanted place (2,) a share of the way from one stance to the next; writes the upper
    joints.

    The pelvis is kept exact: the free knee gives, as it must when its foot is in the air. At both ends it agrees
    anyway.
    """
    weight = ease(progress)
    feet = mixed_feet(body, start.feet, end.feet, weight, lift_m * arc(progress))
    out[UPPER] = rotations.slerp(start.upper, end.upper, weight)
    asked = lower_body.ask(
        body, *feet, end.root,
        start.knee_rad + weight * (end.knee_rad - start.knee_rad),
        start.pelvis_rad + weight * (end.pelvis_rad - start.pelvis_rad),
        True,
    )  # fmt: skip
    return asked, start.com_m + weight * (end.com_m - start.com_m)


def mixed_feet(body: Body, start: Footprints, end: Footprints, weight: float, lift_m: float) -> Footprints:
    """Feet on their way: each goes over with its ball, so that a heel that rises or sinks turns about it, exactly.

    A foot that changes its place is lifted; one that does not stays to the last bit.
    """
    flat_start, flat_end = footprints.raised(body, start, -start.toe_rad), footprints.raised(body, end, -end.toe_rad)
    ankle_m, turned = flat_start.ankle_m.copy(), flat_start.foot_turned.copy()
    for side in range(2):
        if _moves(flat_start, flat_end, side):
            ankle_m[side] = vector.mix(flat_start.ankle_m[side], flat_end.ankle_m[side], weight)
            ankle_m[side, 2] += lift_m
            turned[side] = quaternion.slerp(flat_start.foot_turned[side], flat_end.foot_turned[side], weight)
    rise = start.toe_rad + weight * (end.toe_rad - start.toe_rad)
    return footprints.raised(body, Footprints(ankle_m, turned, np.zeros(2)), rise)


def _moves(start, end, side):
    return (
        vector.distance(start.ankle_m[side], end.ankle_m[side]) > 1e-9
        or quaternion.angle_between(start.foot_turned[side], end.foot_turned[side]) > 1e-9
    )


def _planted(start, end, progress):
    """Which feet stand: those that do not move, and all when the movement is over. A heel may rise meanwhile."""
    flat = np.array([_moves(start, end, side) and start.toe_rad[side] == end.toe_rad[side] for side in range(2)])
    return ~flat | (progress >= 1.0)


def offsets_of(feet: Footprints, root: int, hip_m) -> tuple[float, float]:
    """The root ankle's balance offsets (the paper's X, Z) for which the hip over it is where it is."""
    facing = quaternion.about_z(lower_body.facing_rad(feet.ankle_m, feet.foot_turned, root))
    leg = quaternion.unrotate(facing, vector.subtract(hip_m, feet.ankle_m[root]))
    swing = quaternion.to_rotation_vector(quaternion.between((0.0, 0.0, 1.0), vector.unit(leg, (0.0, 0.0, 1.0))))
    return (swing[1], swing[0])


def _assemble(body, asked, offsets, figure: Figure) -> np.ndarray:
    lower_body.solve_lower_body(body, asked, offsets, figure.root_m, figure.rotations)
    kinematics.joints_into(body.offset_m, figure.root_m, figure.rotations, figure.positions, figure.orientations)
    return np.array(kinematics.centre_of_mass(body, figure.positions, figure.orientations))
