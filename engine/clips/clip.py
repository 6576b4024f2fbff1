"""A clip: one motion on the canonical skeleton, ready to be played."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np

from engine.body.skeleton import Body, Pose


class Loop(NamedTuple):
    """How a clip goes on when it is over: from frame `last` back to frame `first`, numbers only, so that kernels take
    it.

    Over the `blend` frames before `last` the motion that leads up to `first` fades in, so nothing jumps. A round
    carries the path on: by (x_m, y_m) and yaw_rad, in the clip's own frame. last = 0: the clip does not loop, it holds
    its last pose."""

    first: float = 0.0
    last: float = 0.0
    blend: float = 0.0
    x_m: float = 0.0
    y_m: float = 0.0
    yaw_rad: float = 0.0


@dataclass(frozen=True)
class ImportReport:
    """What the import found in the file and what it did with it."""

    name: str
    format: str  # "bvh", "asf/amc", "npz", or "synthetic"
    frames: int  # kept frames
    fps: float
    duration_s: float
    source_joints: int
    scale_to_m: float  # metres for one unit of the file
    up_axis: str  # the file's, such as "+Y"
    leg_length_m: float
    height_m: float
    floor_m: float  # height of the floor in the file's world, under the first kept frame
    floor_slope: float  # rise of the file's floor per metre, taken out
    facing_deg: float  # the file's own heading in the first kept frame
    rest_frames_dropped: int
    # bridged: "first" and "last" kept frame of each glitch, and the "joints" that were astray in them
    glitches: list[dict[str, Any]]
    planted: dict[str, list[list[int]]]  # "left", "right": first and last kept frame of every stretch
    missing_joints: list[str]  # canonical joints that nothing in the file moves
    # how far from its Y axis a well-bent elbow or knee bent before it was put right, 95th percentile
    hinge_residual_deg: float
    position_error_m: float  # greatest distance of a joint from its place in the file (shorter spine and neck chains)
    notes: list[str]

    def as_dict(self) -> dict[str, Any]:
        """Plain values for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class Clip:
    """F frames of one subject. In frame 0 the pelvis is over the world's origin and faces +X; the floor is z = 0."""

    name: str
    fps: float
    pose: Pose  # root_m (F, 3), rotations (F, 21, 4), interpolable from frame to frame
    body: Body
    planted: np.ndarray  # (F, 2) bool, left and right
    loop: Loop
    report: ImportReport
    key: str  # tells this content from any other

    @property
    def frames(self) -> int:
        return len(self.pose.root_m)

    @property
    def duration_s(self) -> float:
        """From the first frame to the last; for a loop to the frame from which it goes back."""
        return (self.loop.last if self.loops else self.frames - 1) / self.fps

    @property
    def loops(self) -> bool:
        return self.loop.last > 0.0
