"""Skin that follows bones: weights by where a point is along each limb, and blending by dual quaternions.

Kavan, Collins, Zara, O'Sullivan, *Geometric Skinning with Approximate Dual Quaternion Blending* (2008): blended limbs
keep their volume when they bend and twist, where blended matrices collapse (the sweet's wrapper).
"""

from __future__ import annotations

import numpy as np

from engine.body import skeleton as sk
from engine.maths import rotations
from engine.render.sculpture.parts import outwards
from engine.render.sculpture.whole import Bind

INFLUENCES = 4
SHOULDER_LINEAR = 0.4  # raised arms' armpits bulge with dual quaternions and cave in with matrices: between, neither
SMOOTHINGS = 12  # rounds over the mesh that take the last edges off


def skin_weights(bind: Bind, points: np.ndarray, triangles: np.ndarray, coarser: float = 1.0):
    """Joints (V, 4) and their weights (V, 4) of a body's skin in the bind pose: descending, summing to one.

    coarser: how many times larger than usual the triangles are; the weights must come out alike.
    """
    weights = smoothed(anatomical_weights(bind, points), triangles, round(SMOOTHINGS / coarser**2))
    joints = np.argsort(-weights, axis=1, kind="stable")[:, :INFLUENCES]
    kept = np.take_along_axis(weights, joints, axis=1)
    return joints, kept / kept.sum(axis=1, keepdims=True)


def anatomical_weights(bind: Bind, points: np.ndarray) -> np.ndarray:
    """(V, 21): limbs first, each cut off the trunk where it folds; what is left goes along the spine."""
    weights = np.zeros((len(points), sk.JOINT_COUNT))
    limbs = np.zeros(len(points))
    for side in (sk.LEFT, sk.RIGHT):
        arm, leg = _arm_share(bind, points, side), _leg_share(bind, points, side)
        limbs += arm + leg
        elbow, wrist, knee, ankle = (
            _beyond(bind, points, joint, child, half)
            for joint, child, half in (
                (sk.ELBOWS[side], sk.WRISTS[side], 0.045),
                (sk.WRISTS[side], None, 0.030),
                (sk.KNEES[side], sk.ANKLES[side], 0.060),
                (sk.ANKLES[side], None, 0.034),
            )
        )
        toe = _toe_share(bind, points, side)
        for joints, shares in (
            ((sk.SHOULDERS, sk.ELBOWS, sk.WRISTS), (arm, elbow, wrist)),
            ((sk.HIPS, sk.KNEES, sk.ANKLES, sk.TOES), (leg, knee, ankle, toe)),
        ):
            from_here = [*np.cumprod(shares, axis=0), np.zeros(len(points))]  # what this joint and those after it have
            for k, sides in enumerate(joints):
                weights[:, sides[side]] = from_here[k] - from_here[k + 1]
    for joint, share in _spine_shares(bind, points).items():
        weights[:, joint] = np.maximum(1.0 - limbs, 0.0) * share
    return weights / weights.sum(axis=1, keepdims=True)


def smoothed(weights: np.ndarray, triangles: np.ndarray, rounds: int) -> np.ndarray:
    """Each vertex half way to the mean of its neighbours, again and again (V, J)."""
    sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    count = np.maximum(np.bincount(sides[:, 0], minlength=len(weights)), 1)[:, None]
    order = np.argsort(sides[:, 0], kind="stable")
    begins = np.searchsorted(sides[order, 0], np.arange(len(weights)))
    neighbours = sides[order, 1]
    for _ in range(rounds):
        weights = 0.5 * weights + 0.5 * np.add.reduceat(weights[neighbours], begins, axis=0) / count
    return weights


def moved_by_skin(points, normals, joints, weights, places: np.ndarray, turns: np.ndarray):
    """Points and normals (V, 3) carried along by joint transforms, world_from_rest: places (21, 3), turns (21, 4)."""
    linear = np.sum(weights[..., None] * (rotations.rotate(turns[joints], points[:, None, :]) + places[joints]), axis=1)
    real = turns[joints]  # (V, 4, 4)
    dual = 0.5 * rotations.multiply(np.concatenate([np.zeros((sk.JOINT_COUNT, 1)), places], axis=1), turns)[joints]
    alike = np.where(np.sum(real * real[:, :1], axis=2) < 0.0, -1.0, 1.0) * weights
    real, dual = np.sum(alike[..., None] * real, axis=1), np.sum(alike[..., None] * dual, axis=1)
    length = np.linalg.norm(real, axis=1, keepdims=True)
    real, dual = real / length, dual / length
    shift = 2.0 * rotations.multiply(dual, rotations.conjugate(real))[:, 1:]
    first = joints[:, :2]
    at_shoulder = np.isin(first, sk.SHOULDERS).any(axis=1) & ~np.isin(first, sk.ELBOWS).any(axis=1)
    drawn_in = np.where(at_shoulder, SHOULDER_LINEAR, 0.0)[:, None]
    moved = (1.0 - drawn_in) * (rotations.rotate(real, points) + shift) + drawn_in * linear
    return moved, rotations.rotate(real, normals)


def world_from_rest(rest: np.ndarray, positions: np.ndarray, orientations: np.ndarray) -> np.ndarray:
    """What carries a point of the identity pose to where its joint has gone: the places (..., 21, 3); turns are the
    orientations themselves. rest: (21, 3) joints of the identity pose."""
    return positions - rotations.rotate(orientations, rest)


def _arm_share(bind: Bind, points: np.ndarray, side: int) -> np.ndarray:
    """One along the arm, none on the trunk: the fold runs from over the shoulder down through the armpit."""
    shoulder = bind.positions[sk.SHOULDERS[side]]
    along = bind.positions[sk.ELBOWS[side]] - shoulder
    along = along / np.linalg.norm(along)
    local = points - shoulder
    out = outwards(side)
    # straight above the joint the deltoid begins further in, under it the armpit is further out
    beyond = local @ along
    over = local @ np.array([0.0, out * along[2], -along[1] * out]) * -1.0
    share = _ramp(beyond + 0.25 * np.clip(over, -0.06, 0.06), -0.062, 0.070)
    # the flank hangs beyond that fold too, yet is no arm: nearer to the arm's own line than to the trunk's side
    aside = np.linalg.norm(local - np.maximum(beyond, 0.0)[:, None] * along, axis=1)
    flank = out * local[:, 1]
    return share * np.where(beyond > 0.0, _ramp(0.074 + 0.9 * flank - aside, -0.032, 0.032), 1.0)


def _leg_share(bind: Bind, points: np.ndarray, side: int) -> np.ndarray:
    """One along the leg; the fold of the groin rises outwards from the crotch over the hip."""
    hip, out = bind.positions[sk.HIPS[side]], outwards(side)
    local = (points - hip) * (1.0, out, 1.0)
    below = -local[:, 2] + 0.42 * np.clip(local[:, 1], -0.09, 0.09) + 0.10 * np.clip(local[:, 0], -0.1, 0.1)
    middle = 0.5 * (bind.positions[sk.LEFT_HIP][1] + bind.positions[sk.RIGHT_HIP][1])
    arms = _outside_arms(bind, points)
    return _ramp(below, -0.075, 0.085) * _ramp(out * (points[:, 1] - middle), -0.022, 0.022) * arms


def _outside_arms(bind: Bind, points: np.ndarray) -> np.ndarray:
    """None where an arm is, lest a hand that hangs low be taken for a leg."""
    return np.prod([1.0 - _arm_share(bind, points, side) for side in (sk.LEFT, sk.RIGHT)], axis=0)


def _toe_share(bind: Bind, points: np.ndarray, side: int) -> np.ndarray:
    ahead = points[:, 0] - bind.positions[sk.TOES[side]][0]
    return _ramp(ahead, -0.020, 0.020)


def _beyond(bind: Bind, points: np.ndarray, joint: int, child: int | None, half_m: float) -> np.ndarray:
    """From none to one across a joint, along the bone that leads to it and the one that leads away."""
    before = _unit(bind.positions[joint] - bind.positions[sk.PARENT[joint]])
    after = before if child is None else _unit(bind.positions[child] - bind.positions[joint])
    return _ramp((points - bind.positions[joint]) @ _unit(before + after), -half_m, half_m)


def _spine_shares(bind: Bind, points: np.ndarray) -> dict[int, np.ndarray]:
    """Pelvis to head by height, the clavicles by how far out and how high on the trunk."""
    z, at = points[:, 2], bind.positions[:, 2]
    over_waist = _ramp(z, at[sk.WAIST] - 0.075, at[sk.WAIST] + 0.075)
    over_back = _ramp(z, at[sk.BACK] - 0.085, at[sk.BACK] + 0.085)
    root = 0.5 * (at[sk.LEFT_SHOULDER] + at[sk.RIGHT_SHOULDER]) + 0.05
    low, high = max(at[sk.NECK], root) - 0.035, max(at[sk.NECK], root) + 0.055
    over_neck = _ramp(z - 0.15 * points[:, 0], low, high)
    # the head's fold goes from under the chin to the nape
    over_head = _ramp(z - at[sk.HEAD] + 0.30 * (points[:, 0] - bind.positions[sk.HEAD][0]), -0.035, 0.030)
    shares = {
        sk.PELVIS: 1.0 - over_waist,
        sk.WAIST: over_waist * (1.0 - over_back),
        sk.BACK: over_waist * over_back * (1.0 - over_neck),
        sk.NECK: over_waist * over_back * over_neck * (1.0 - over_head),
        sk.HEAD: over_waist * over_back * over_neck * over_head,
    }
    chest = shares[sk.BACK]
    for side in (sk.LEFT, sk.RIGHT):
        inner, outer = bind.positions[sk.CLAVICLES[side]], bind.positions[sk.SHOULDERS[side]]
        across = (points[:, 1] - inner[1]) / (outer[1] - inner[1])
        yoke = chest * _ramp(across, 0.12, 0.85) * _ramp(z - outer[2], -0.17, -0.02)
        shares[sk.CLAVICLES[side]] = yoke
        shares[sk.BACK] = shares[sk.BACK] - yoke
    return shares


def _ramp(x: np.ndarray, low: float, high: float) -> np.ndarray:
    """Zero below, one above, smooth to the second derivative between (Perlin 2002)."""
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * t * (t * (6.0 * t - 15.0) + 10.0)


def _unit(v: np.ndarray) -> np.ndarray:
    return v / np.linalg.norm(v)
