"""A stance in plain numpy and SciPy: the paper's method written down again, one equation after the other, for
comparison.

Nothing of `behaviours.stance` is called here but its tables and the wishes of the case; rotations are SciPy's, the
centre of mass is brought over its place by SciPy's root finder, the lines are searched by SciPy's Brent. It knows no
limits of joints.
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import minimize_scalar, root
from scipy.spatial.transform import Rotation

from behaviours.stance import arms, gaze
from behaviours.stance.torso import WEIGHTS
from engine.body.skeleton import (
    ANKLES,
    BACK,
    CLAVICLES,
    ELBOWS,
    HEAD,
    HIPS,
    KNEES,
    NECK,
    PARENT,
    PELVIS,
    SHOULDERS,
    TOES,
    WAIST,
    WRISTS,
)

UP, AHEAD, LEFTWARDS = np.eye(3)[2], np.eye(3)[0], np.eye(3)[1]
CYCLES = 20


def turn(axis, angle_rad):
    return Rotation.from_rotvec(np.asarray(axis) * angle_rad)


def unit(vector):
    return vector / np.linalg.norm(vector)


def away_from(vector, axis):
    return vector - (vector @ axis) * axis


def from_axes(x, y, z):
    return Rotation.from_matrix(np.column_stack([x, y, z]))


def least(a, b):
    """The least rotation from unit a to unit b."""
    axis = np.cross(a, b)
    sine = np.linalg.norm(axis)
    return turn(axis / sine, np.arctan2(sine, a @ b)) if sine > 1e-12 else Rotation.identity()


def paper(x, y, z):
    """A joint's turn from the paper's angles: swing about X (our Y) and Z (our X) after the twist about Y (our Z)."""
    return Rotation.from_rotvec([z, x, 0.0]) * turn(UP, y)


def legs(body, lower, offsets):
    """Appendix: pelvis place, local rotations of pelvis and legs, by joint."""
    o, root_side, free = body.offset_m, lower.root, 1 - lower.root
    line = lower.ankle_m[0] - lower.ankle_m[1]
    facing = turn(UP, np.arctan2(-line[0], line[1]))
    bones = [(np.linalg.norm(o[KNEES[s]]), np.linalg.norm(o[ANKLES[s]])) for s in (0, 1)]
    lengths = [np.sqrt(a * a + b * b + 2 * a * b * np.cos(k)) for (a, b), k in zip(bones, lower.knee_rad, strict=True)]
    hips = [np.zeros(3), np.zeros(3)]
    hips[root_side] = (
        lower.ankle_m[root_side] + (facing * paper(offsets[0], 0.0, offsets[1])).apply(UP) * lengths[root_side]
    )
    width = o[HIPS[free]] - o[HIPS[root_side]]
    wanted = (facing * turn(UP, lower.pelvis_rad[1]) * turn(AHEAD, lower.pelvis_rad[2])).apply(unit(width))
    to_foot = lower.ankle_m[free] - hips[root_side]
    a, b, c = np.linalg.norm(to_foot), np.linalg.norm(width), lengths[free]
    along = (a * a + b * b - c * c) / (2 * a)
    axis = to_foot / a
    hips[free] = hips[root_side] + along * axis + np.sqrt(b * b - along * along) * unit(away_from(wanted, axis))
    y = unit(hips[0] - hips[1])
    z = turn(y, lower.pelvis_rad[0]).apply(unit(away_from(UP, y)))
    pelvis = from_axes(np.cross(y, z), y, z) * least(unit(o[HIPS[0]] - o[HIPS[1]]), LEFTWARDS)
    local = {PELVIS: pelvis}
    for side in (0, 1):
        local |= leg(side, hips[side], lower, bones[side], pelvis)
    return hips[0] - pelvis.apply(o[HIPS[0]]), local


def leg(side, hip, lower, bones, pelvis):
    """One leg between its two points, the knee over the toes."""
    foot = Rotation.from_quat(np.roll(lower.foot_turned[side], -1))
    up = hip - lower.ankle_m[side]
    length, n = np.linalg.norm(up), unit(up)
    y = unit(np.cross(n, foot.apply(AHEAD)))
    (a, b), x = bones, np.cross(y, n)
    at_hip = np.arccos(np.clip((a * a + length**2 - b * b) / (2 * a * length), -1, 1))
    flexion = np.pi - np.arccos(np.clip((a * a + b * b - length**2) / (2 * a * b), -1, 1))
    thigh = from_axes(x, y, n) * turn(LEFTWARDS, -at_hip)
    knee = turn(LEFTWARDS, flexion)
    return {
        HIPS[side]: pelvis.inv() * thigh,
        KNEES[side]: knee,
        ANKLES[side]: (thigh * knee).inv() * foot,
        TOES[side]: turn(LEFTWARDS, -lower.toe_rad[side]),
    }  # fmt: skip


def spine(plan, unknowns):
    """Eq. 1 to 4 and the collars."""
    coronal, sagittal, transverse, collar_y, collar_z, abdomen = unknowns
    local = {}
    for k, joint in enumerate((WAIST, BACK, NECK, HEAD)):
        x = sagittal * WEIGHTS[plan.classes[0], 0, k] + (abdomen if k == 0 else 0.0)
        local[joint] = paper(x, transverse / 4, coronal * WEIGHTS[plan.classes[1], 1, k])
    for side, sign in ((0, 1), (1, -1)):
        y = collar_y if side == 0 or plan.opposed[0] else sign * collar_y
        z = collar_z if side == 0 or plan.opposed[1] else sign * collar_z
        local[CLAVICLES[side]] = paper(0.0, y, z)
    return local


def hanging(arm, side, chest, clavicle):
    """An arm without target."""
    out = 1 - 2 * side
    ahead = chest.apply(AHEAD)
    heading = turn(UP, np.arctan2(ahead[1], ahead[0]))
    up = (heading.inv() * chest).apply(UP)
    bow, lean = np.arctan2(up[0], up[2]), out * np.arctan2(-up[1], np.hypot(up[0], up[2]))
    flank = 0.5 * (lean + np.hypot(lean, arms.SOFT_LEAN)) - 0.5 * arms.SOFT_LEAN
    flank = arms.MOST_LEAN * np.tanh(flank / arms.MOST_LEAN)
    kept = (1 - arms.HANG) * lean + arms.HANG * flank
    base = heading * turn(LEFTWARDS, (1 - arms.HANG) * bow) * turn(AHEAD, out * kept)
    lift = Rotation.from_rotvec(
        [out * (arm[arms.OUT] + arms.NEUTRAL_OUT), -(arm[arms.FORWARD] + arms.NEUTRAL_FORWARD), 0.0]
    )
    upper = base * lift * turn(UP, -out * arm[arms.TURN])
    elbow = turn(LEFTWARDS, -(arm[arms.ELBOW] + arms.NEUTRAL_ELBOW)) * turn(
        UP, -out * (arm[arms.PALM] + arms.NEUTRAL_PALM)
    )
    return {SHOULDERS[side]: clavicle.inv() * upper, ELBOWS[side]: elbow, WRISTS[side]: Rotation.identity()}


def reaching(body, arm, side, shoulder_m, target_m, clavicle):
    """An arm with a target: elbow by the cosine law, then the turn about shoulder to target (5.3)."""
    a, b = -body.offset_m[ELBOWS[side], 2], -body.offset_m[WRISTS[side], 2]
    to = target_m - shoulder_m
    length, n = min(np.linalg.norm(to), a + b), unit(to)
    resting, zero = clavicle.apply([1.0, 0.0, 0.0]), clavicle.apply([0.0, 0.0, -1.0])
    swivel = (1 - 2 * side) * (arm[arms.SWIVEL] + arms.NEUTRAL_SWIVEL)
    out = turn(n, swivel).apply(least(resting, n).apply(zero))  # where the elbow points
    at_shoulder = np.arccos(np.clip((a * a + length**2 - b * b) / (2 * a * length), -1, 1))
    flexion = np.pi - np.arccos(np.clip((a * a + b * b - length**2) / (2 * a * b), -1, 1))
    # flexing goes towards X of the upper arm, so the elbow points to -X
    upper = from_axes(-out, np.cross(-n, -out), -n) * turn(LEFTWARDS, at_shoulder)
    return {
        SHOULDERS[side]: clavicle.inv() * upper,
        ELBOWS[side]: turn(LEFTWARDS, -flexion),
        WRISTS[side]: Rotation.identity(),
    }  # fmt: skip


def looking(body, plan, joints, turns, local):
    """Section 5.4: neck, then head, turned sideways and nodded towards the target, seen from the chest."""
    chest, height = turns[BACK], body.head_top_m[2]
    eyes = np.array(gaze.EYES) * height

    def seen(direction):
        x, y, z = chest.inv().apply(direction)
        level, yaw = np.hypot(x, y), np.arctan2(y, x)
        clear = [np.clip(v, 0, 1) for v in (level / gaze.STEEP, (np.pi - abs(yaw)) / gaze.BEHIND)]
        return np.prod([u * u * (3 - 2 * u) for u in clear]) * yaw, np.arctan2(z, level)

    rest = seen(turns[HEAD].apply(AHEAD))
    for joint, weight in ((NECK, plan.gaze * gaze.NECK_SHARE), (HEAD, plan.gaze)):
        wanted = seen(unit(plan.look_at_m - joints[HEAD] - turns[HEAD].apply(eyes)))
        face = seen(turns[HEAD].apply(AHEAD))
        yaw, pitch = (r + weight * (w - r) for r, w in zip(rest, wanted, strict=True))
        level = turn(LEFTWARDS, face[1]) * turn(UP, -face[0])
        way = chest * turn(UP, yaw) * turn(LEFTWARDS, -pitch) * level * chest.inv()
        local[joint] = turns[PARENT[joint]].inv() * way * turns[joint]
        follow(body, joints, turns, local, (NECK, HEAD))


def follow(body, joints, turns, local, which):
    """Forward kinematics of some joints, parents first."""
    for j in which:
        joints[j] = joints[PARENT[j]] + turns[PARENT[j]].apply(body.offset_m[j])
        turns[j] = turns[PARENT[j]] * local[j]


def assembled(body, plan, unknowns, offsets):
    """All joints (21, 3) and the place (2,) of the centre of mass, in the paper's order of lower body, torso, arms,
    head.
    """
    place, local = legs(body, plan.lower, offsets)
    local |= spine(plan, unknowns)
    joints, turns = {PELVIS: place}, {PELVIS: local[PELVIS]}
    trunk = (WAIST, BACK, NECK, HEAD, *CLAVICLES)
    follow(body, joints, turns, local, (*trunk, *(j for s in (0, 1) for j in (HIPS[s], KNEES[s], ANKLES[s], TOES[s]))))
    for side in (0, 1):
        clavicle = turns[CLAVICLES[side]]
        shoulder_m = joints[CLAVICLES[side]] + clavicle.apply(body.offset_m[SHOULDERS[side]])
        if plan.reaching[side]:
            local |= reaching(body, plan.arm[side], side, shoulder_m, plan.wrist_m[side], clavicle)
        else:
            local |= hanging(plan.arm[side], side, turns[BACK], clavicle)
        follow(body, joints, turns, local, (SHOULDERS[side], ELBOWS[side], WRISTS[side]))
    if plan.gaze > 0:
        looking(body, plan, joints, turns, local)
    parts = [joints[j] + turns[j].apply(com) for j, com in zip(body.part_joint, body.part_com_m, strict=True)]
    com = np.average(parts, axis=0, weights=body.part_mass_kg)
    return np.array([joints[j] for j in range(len(PARENT))]), com[:2]


def balanced(body, plan, unknowns, start):
    """The joints with the centre of mass over its place, and the offsets that bring it there."""

    def error(offsets):
        return assembled(body, plan, unknowns, offsets)[1] - plan.balance_m

    found = root(error, start, tol=1e-6)
    return assembled(body, plan, unknowns, found.x)[0], found.x


def penalty(row, value):
    """Figure 4 with SciPy's Hermite splines."""
    stray = value - row[0]
    basin, low, far, high = row[5:9] if stray >= 0 else row[1:5]
    stray, wall = abs(stray), (high - low) / (far - basin)
    first = min(2 * low / basin, 3 * wall)
    last = max(2 * wall - first, wall)
    if stray > far:
        return high + last * (stray - far)
    return float(CubicHermiteSpline([0, basin, far], [0, low, high], [0, first, last])(stray))


def objective(body, plan, wishes, unknowns, start):
    """Eq. 5."""
    joints, offsets = balanced(body, plan, unknowns, start)
    total = sum(w * penalty(row, u) for w, row, u in zip(wishes.weight, wishes.wanted, unknowns, strict=True))
    for side in (0, 1):
        if plan.reaching[side]:
            away = np.linalg.norm(joints[SHOULDERS[side]] - plan.wrist_m[side])
            total += wishes.reach_weight * penalty(wishes.reach[side], away)
    return total, offsets


def solve(body, plan, wishes, bounds, improving):
    """Coordinate-wise Brent: the joints (21, 3) and the unknowns (6,)."""
    unknowns, offsets, before = wishes.wanted[:, 0].copy(), np.zeros(2), np.inf
    for _ in range(CYCLES):
        value, offsets = objective(body, plan, wishes, unknowns, offsets)
        if value < 1e-6 or before - value <= improving * value:
            break
        before = value
        for u in np.flatnonzero(wishes.free):

            def along(x, u=u, start=offsets):
                tried = unknowns.copy()
                tried[u] = x
                return objective(body, plan, wishes, tried, start)[0]

            unknowns[u] = minimize_scalar(along, bounds=bounds[u], method="bounded", options={"xatol": 0.01}).x
    return balanced(body, plan, unknowns, offsets)[0], unknowns
