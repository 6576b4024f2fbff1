"""One protective pose on its own: a clip at a time, a threat, what came of it. The report of `brace pose`, and its
picture.

Nothing moves here: the threat is planned as a scripted one (specification A1), the pose is worked out, and that is all.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from behaviours.perceive.approach import Approach, coming_from
from behaviours.perceive.perceived import PerceivedThreat
from behaviours.perceive.threats import KINDS, Make, make_threat
from behaviours.protect.aiming import Asked, aimed
from behaviours.protect.sustained import Protection, protect
from behaviours.protect.task import AtPerception
from behaviours.rules.controls import CONTROLS
from behaviours.settings import Settings
from behaviours.timing import TICK_S, facing_dot_threat, time_to_contact_s, whole_ticks
from behaviours.wearing import Worn, as_felt, worn_pose
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import JOINTS, PELVIS, Body, Pose
from engine.clips.clip import Clip
from engine.clips.playback import planted_at, sample
from engine.maths import quaternion

REPORTED_ERRORS = ("balance", "hands", "torso", "pelvis_height", "feet", "controls", "limits", "total")


class PoseCase(NamedTuple):
    """What `brace pose` asks for."""

    at_s: float
    azimuth_deg: float
    elevation_deg: float
    speed_mps: float
    size: float
    target: str = "head"
    kind: str = "volleyball"
    size_means: str = "rule"
    worn: Worn | None = None  # the stance under the clip
    boldness: float = 0.0  # -1 timid ... +1 bold


class PosedCase(NamedTuple):
    """And what came of it. World metres."""

    body: Body
    clip: Pose  # at perception
    ahead: Pose  # where the pelvis and a foot in the air come from
    threat: PerceivedThreat
    approach: Approach
    protection: Protection


def pose_case(clip: Clip, case: PoseCase, settings: Settings) -> PosedCase:
    """The protective pose of a clip's subject at a time against a scripted threat. ValueError for an unknown target."""
    make = make_threat(case.kind, case.speed_mps, case.size, size_means=case.size_means)
    now = _sampled(clip, case.at_s, case.worn)
    ttc_s = _ttc_s(case, make, float(quaternion.heading(now.rotations[PELVIS])), settings)
    ahead, planted, landing = _look_ahead(clip, case, ttc_s, settings)
    at, temper = AtPerception(now, ahead, planted, landing), settings.temper
    felt = (
        as_felt(make.speed_norm, case.boldness, temper.speed_share),
        as_felt(make.size_norm, case.boldness, temper.size_share),
    )
    asked = Asked(
        case.target, math.radians(case.azimuth_deg), math.radians(case.elevation_deg), case.speed_mps, ttc_s, make, felt
    )
    way, threat = aimed(clip.body, at, asked, settings)
    return PosedCase(clip.body, now, ahead, threat, way, protect(clip.body, at, threat, settings))


def _ttc_s(case: PoseCase, make: Make, heading: float, settings: Settings) -> float:
    """Time to contact (eq. 4.1), in whole ticks. A character faces the way it is heading, as in a run."""
    towards = coming_from(heading, math.radians(case.azimuth_deg), math.radians(case.elevation_deg))
    facing = facing_dot_threat(heading, towards)
    return whole_ticks(time_to_contact_s(make.speed_norm, facing, settings.timing)) * TICK_S


def _sampled(clip: Clip, time_s: float, worn: Worn | None) -> Pose:
    """As in a run: the clip's pose, over the stance that is worn under it."""
    pose = sample(clip, time_s)
    return pose if worn is None else worn_pose(clip.body, pose, worn)


def _look_ahead(clip: Clip, case: PoseCase, ttc_s: float, settings: Settings) -> tuple[Pose, np.ndarray, bool]:
    """As in a run: the clip 1/6 s on, or its next landing for somebody in the air (A4)."""
    planted = planted_at(clip, case.at_s)
    if not planted.any():
        for k in range(1, int(ttc_s / TICK_S)):
            there = planted_at(clip, case.at_s + k * TICK_S)
            if there.any():
                return _sampled(clip, case.at_s + k * TICK_S, case.worn), there, True
    return _sampled(clip, case.at_s + settings.timing.sustained_ahead_s, case.worn), planted, False


def pose_report(posed: PosedCase, milliseconds: float | None = None) -> dict[str, Any]:
    """The report as plain values for JSON; `milliseconds` is what the solve took, measured by whoever ran it."""
    found = posed.protection
    poses = {"clip": posed.clip, "rules": found.rules, "sustained": found.sustained}
    return {
        "controls": dict(zip(CONTROLS, found.controls.tolist(), strict=True)),
        "controls_initial": dict(zip(CONTROLS, found.controls_initial.tolist(), strict=True)),
        "case": found.case.name.lower(),
        "support_m": found.support_m.tolist(),
        "com_m": {name: com_of(posed.body, pose).tolist() for name, pose in poses.items()},
        "com_wanted_m": found.com_wanted_m.tolist(),
        "error": {name: found.errors[name] for name in REPORTED_ERRORS},
        "error_initial": {name: found.errors_initial[name] for name in REPORTED_ERRORS},
        "solver": found.solver._asdict() | {"milliseconds": milliseconds},
        "feet": {
            "ankle_m": dict(zip(("left", "right"), found.feet.ankle_m.tolist(), strict=True)),
            "held": dict(zip(("left", "right"), found.feet.held.tolist(), strict=True)),
            "step_m": dict(zip(("left", "right"), found.feet.step_m.tolist(), strict=True)),
        },
        "turn_side": "left" if found.choices.turn_side > 0 else "right",
        "wrap": found.choices.wrap,
        "pose": {name: _pose_values(posed.body, pose) for name, pose in poses.items()},
        "threat": {
            "direction": list(posed.threat.direction),
            "tangent": list(posed.threat.tangent),
            "line_point_m": [float(v) for v in posed.threat.line_point_m],
            "position_m": [float(v) for v in posed.approach.start_m],
            "velocity_mps": [float(v) for v in posed.approach.start_mps],
            "ttc_s": posed.approach.ttc_s,
            "elevation_raised_deg": posed.approach.raised_deg,
        },
    }


def _pose_values(body: Body, pose: Pose) -> dict[str, Any]:
    positions, _ = joints_of(body, pose)
    return {
        "joints_m": dict(zip(JOINTS, positions.tolist(), strict=True)),
        "rotations_wxyz": dict(zip(JOINTS, np.asarray(pose.rotations).tolist(), strict=True)),
    }


class PosePicture(NamedTuple):
    """What a picture of the case shows. World metres."""

    body: Body
    clip: Pose
    rules: Pose
    sustained: Pose
    support_m: np.ndarray  # (m, 2) on the floor
    com_rules_m: np.ndarray  # (3,)
    com_m: np.ndarray  # (3,)
    com_wanted_m: np.ndarray  # (2,)
    line_m: np.ndarray  # (2, 3) the line of approach, the last metre before the target
    ball_m: np.ndarray  # (3,) the ball, about to arrive
    ball_radius_m: float


def picture_of(posed: PosedCase, before_m: float = 1.0) -> PosePicture:
    """The figures, points and lines of the case; the ball `before_m` short of its target."""
    found, tangent = posed.protection, np.array(posed.threat.tangent)
    end = np.array(posed.threat.line_point_m, float)
    start = end - before_m * tangent
    radius_m = KINDS["volleyball"].radius_m + posed.threat.excess_radius_m
    return PosePicture(
        posed.body, posed.clip, found.rules, found.sustained, found.support_m, found.com_rules_m, found.com_m,
        found.com_wanted_m, np.stack([start, end]), start, radius_m,
    )  # fmt: skip
