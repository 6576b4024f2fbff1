"""Small people written as motion files, so that every reader and every convention can be tried on a known figure."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

# MotionBuilder's names, Y up, T-pose, metres: (name, parent, offset)
T_POSE = (
    ("Hips", None, (0.0, 0.0, 0.0)),
    ("Spine", "Hips", (0.0, 0.10, 0.0)),
    ("Spine1", "Spine", (0.0, 0.18, 0.0)),
    ("Neck", "Spine1", (0.0, 0.22, 0.0)),
    ("Head", "Neck", (0.0, 0.12, 0.01)),
    ("LeftShoulder", "Spine1", (0.02, 0.20, 0.0)),
    ("LeftArm", "LeftShoulder", (0.15, 0.0, 0.0)),
    ("LeftForeArm", "LeftArm", (0.28, 0.0, 0.0)),
    ("LeftHand", "LeftForeArm", (0.26, 0.0, 0.0)),
    ("RightShoulder", "Spine1", (-0.02, 0.20, 0.0)),
    ("RightArm", "RightShoulder", (-0.15, 0.0, 0.0)),
    ("RightForeArm", "RightArm", (-0.28, 0.0, 0.0)),
    ("RightHand", "RightForeArm", (-0.26, 0.0, 0.0)),
    ("LeftUpLeg", "Hips", (0.09, -0.03, 0.0)),
    ("LeftLeg", "LeftUpLeg", (0.0, -0.42, 0.0)),
    ("LeftFoot", "LeftLeg", (0.0, -0.41, 0.0)),
    ("LeftToeBase", "LeftFoot", (0.0, -0.05, 0.13)),
    ("RightUpLeg", "Hips", (-0.09, -0.03, 0.0)),
    ("RightLeg", "RightUpLeg", (0.0, -0.42, 0.0)),
    ("RightFoot", "RightLeg", (0.0, -0.41, 0.0)),
    ("RightToeBase", "RightFoot", (0.0, -0.05, 0.13)),
)  # fmt: skip
# hips over the floor when standing straight: half a sole thickness under the toe joint
HIP_HEIGHT = 0.94
ARMS_HANG = {"LeftArm": (-90.0, 0.0, 0.0), "RightArm": (90.0, 0.0, 0.0)}  # degrees about Z, Y, X


def write_person(path: Path, poses: Sequence[dict[str, tuple[float, float, float]]], *, roots: np.ndarray | None = None,
                 joints: Sequence = T_POSE, unit: float = 1.0, fps: float = 60.0, prefix: str = "", newline: str = "\n",
                 z_up: bool = False) -> Path:  # fmt: skip
    """A BVH of one pose a frame: joint -> degrees about Z, Y, X (0 if left out). unit: file units in a metre. roots (F,
    3) Y up."""
    roots = np.tile([0.0, HIP_HEIGHT, 0.0], (len(poses), 1)) if roots is None else roots
    # Z up: x stays, y goes to z, z to -y; a rotation about an axis becomes one about where that axis went
    turn = (lambda v: (v[0], -v[2], v[1])) if z_up else (lambda v: tuple(v))
    order = "Zrotation Yrotation Xrotation" if not z_up else "Yrotation Zrotation Xrotation"
    lines = ["HIERARCHY"]
    _write_joint(lines, joints, None, unit, turn, prefix, order, 0)
    lines += ["MOTION", f"Frames: {len(poses)}", f"Frame Time: {1.0 / fps:.8f}"]
    for root, pose in zip(roots, poses, strict=True):
        values = list(np.array(turn(root)) * unit)
        for name in _written_order(joints):
            z, y, x = pose.get(name, (0.0, 0.0, 0.0))
            values += [-z, y, x] if z_up else [z, y, x]
        lines.append(" ".join(f"{value:.7f}" for value in values))
    path.write_bytes(newline.join([*lines, ""]).encode())
    return path


def _children(joints: Sequence, name: str | None) -> list:
    return [joint for joint in joints if joint[1] == name]


def _written_order(joints: Sequence, name: str | None = None) -> list[str]:
    return [n for joint in _children(joints, name) for n in (joint[0], *_written_order(joints, joint[0]))]


def _write_joint(lines, joints, parent, unit, turn, prefix, order, depth) -> None:
    for name, _, offset in _children(joints, parent):
        pad = "  " * depth
        lines += [f"{pad}{'JOINT' if parent else 'ROOT'} {prefix}{name}", f"{pad}{{"]
        lines.append(f"{pad}  OFFSET " + " ".join(f"{v * unit:.6f}" for v in turn(offset)))
        channels = order if parent else f"Xposition Yposition Zposition {order}"
        lines.append(f"{pad}  CHANNELS {len(channels.split())} {channels}")
        if _children(joints, name):
            _write_joint(lines, joints, name, unit, turn, prefix, order, depth + 1)
        else:
            lines += [f"{pad}  End Site", f"{pad}  {{", f"{pad}    OFFSET 0.0 0.0 0.0", f"{pad}  }}"]
        lines.append(f"{pad}}}")


def swing_arms(frames: int) -> list[dict[str, tuple[float, float, float]]]:
    """Standing with the arms down, bending elbows and knees a little, differently on each side."""
    poses = []
    for phase in np.linspace(0.0, 2.0 * np.pi, frames):
        left, right = 40.0 + 30.0 * np.sin(phase), 30.0 + 20.0 * np.cos(phase)
        # in a T-pose the elbow bends about the vertical: the left one from +X towards +Z is a negative turn about Y
        poses.append({**ARMS_HANG, "LeftForeArm": (0.0, -left, 0.0), "RightForeArm": (0.0, right, 0.0)})
    return poses
