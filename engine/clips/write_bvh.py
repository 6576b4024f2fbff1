"""Biovision hierarchy files (.bvh) of canonical motion: what `engine.clips.bvh` reads, and what other programs open.

The file's axes are the usual ones, see `engine.maths.y_up`. Lengths are
centimetres. A joint turns by Z, X and Y in that order of channels; at rest one stands upright with hanging arms.
"""

from __future__ import annotations

import numpy as np

from engine.body.skeleton import HEAD, JOINTS, PARENT, TOES, WRISTS, Body, Pose
from engine.maths import rotations
from engine.maths.y_up import y_up, y_up_rotations

CM_PER_M = 100.0
ROOT_CHANNELS = "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation"
CHANNELS = "CHANNELS 3 Zrotation Xrotation Yrotation"


def bvh_text(body: Body, pose: Pose, fps: float) -> str:
    """The whole file: root_m (F, 3) and rotations (F, 21, 4) at a steady rate, F at least 1.

    Angles to 1e-5 degrees and lengths to a micrometre: read again, every joint is within 0.01 mm of where it was.
    """
    return "\n".join([*_hierarchy(body), *_motion(pose, fps)]) + "\n"


def _hierarchy(body: Body) -> list[str]:
    lines = ["HIERARCHY"]
    open_joints: list[int] = []
    for joint, name in enumerate(JOINTS):
        while open_joints and open_joints[-1] != PARENT[joint]:  # the table lists a whole limb before the next begins
            _close(lines, open_joints)
        indent = "\t" * len(open_joints)
        lines += [f"{indent}{'JOINT' if open_joints else 'ROOT'} {name}", indent + "{"]
        open_joints.append(joint)
        indent = "\t" * len(open_joints)
        lines += [f"{indent}{_offset(body.offset_m[joint])}", indent + (CHANNELS if joint else ROOT_CHANNELS)]
        tip = _tip(body, joint)
        if tip is not None:
            lines += [indent + "End Site", indent + "{", f"{indent}\t{_offset(tip)}", indent + "}"]
    while open_joints:
        _close(lines, open_joints)
    return lines


def _close(lines: list[str], open_joints: list[int]) -> None:
    open_joints.pop()
    lines.append("\t" * len(open_joints) + "}")


def _offset(offset_m: np.ndarray) -> str:
    return "OFFSET " + " ".join(f"{value:.6f}" for value in np.round(y_up(offset_m) * CM_PER_M, 6) + 0.0)


def _tip(body: Body, joint: int) -> np.ndarray | None:
    """Where a chain's last bone ends, in its joint's frame."""
    if joint == HEAD:
        return body.head_top_m
    if joint in WRISTS:
        return body.fingertip_m[WRISTS.index(joint)]
    if joint in TOES:
        return body.sole_m[TOES.index(joint), 4:].mean(axis=0)
    return None


def _motion(pose: Pose, fps: float) -> list[str]:
    # rounded, and 0.0 added, so that no file says -0.00000
    root_cm = np.round(y_up(pose.root_m) * CM_PER_M, 4) + 0.0
    degrees = np.round(np.degrees(euler_zxy(y_up_rotations(pose.rotations))), 5) + 0.0
    lines = ["MOTION", f"Frames: {len(root_cm)}", f"Frame Time: {1.0 / fps:.10f}"]
    for place, turns in zip(root_cm, degrees, strict=True):
        lines.append(" ".join([f"{value:.4f}" for value in place] + [f"{value:.5f}" for value in turns.ravel()]))
    return lines


def euler_zxy(quaternions: np.ndarray) -> np.ndarray:
    """Angles (F, J, 3) about Z, X, Y with R = Rz Rx Ry, of rotations (F, J, 4); radians, smooth along the frames.

    R[2, 1] = sin x, R[0, 1] / R[1, 1] = -tan z, R[2, 0] / R[2, 2] = -tan y. Two sets of angles give each rotation, and
    whole turns can be added: of all these the one nearest to the frame before, so that a program may interpolate them.
    """
    m = rotations.to_matrix(quaternions)
    before, out = np.zeros((m.shape[1], 3)), np.empty((*m.shape[:2], 3))
    for frame, matrices in enumerate(m):
        before = out[frame] = _nearest(_angles(matrices, before[:, 2]), before)
    return out


POLE = 1e-7  # cos x below which only the sum of z and y (x up) or their difference (x down) can be told


def _angles(m: np.ndarray, y_before: np.ndarray) -> np.ndarray:
    """One set of angles (J, 3) of matrices (J, 3, 3); at the poles, where y is anything, it stays what it was."""
    cosine = np.hypot(m[:, 0, 1], m[:, 1, 1])
    at_pole = cosine < POLE
    x = np.arctan2(m[:, 2, 1], cosine)
    y = np.where(at_pole, y_before, np.arctan2(-m[:, 2, 0], m[:, 2, 2]))
    both = np.arctan2(m[:, 1, 0], m[:, 0, 0])
    z = np.where(at_pole, both - np.sign(x) * y, np.arctan2(-m[:, 0, 1], m[:, 1, 1]))
    return np.stack([z, x, y], axis=-1)


def _nearest(angles: np.ndarray, before: np.ndarray) -> np.ndarray:
    """Of all angles that mean the same rotations, those nearest to the ones before: (J, 3) each."""
    other = np.stack([angles[:, 0] + np.pi, np.pi - angles[:, 1], angles[:, 2] + np.pi], axis=-1)
    turn = 2.0 * np.pi
    first, second = (a - turn * np.round((a - before) / turn) for a in (angles, other))
    away = [np.abs(a - before).sum(axis=-1, keepdims=True) for a in (first, second)]
    return np.where(away[0] <= away[1], first, second)
