"""What `brace stance` tells about a stance: the JSON of the interfaces, and the same in words."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from behaviours.stance.measures import Measures, amplitudes, measures, penalties
from behaviours.stance.solve import StanceResult
from engine.body.skeleton import JOINTS, Body


def as_json(body: Body, result: StanceResult, set_name: str, intensity: float, milliseconds: float) -> dict[str, Any]:
    """The report as plain data. milliseconds: what the caller measured; nothing here looks at a clock."""
    found = measures(body, result)
    return {
        "set": set_name,
        "intensity": intensity,
        "states": result.shape.states._asdict(),
        "numbers": result.shape.numbers._asdict(),
        "amplitudes": amplitudes(result),
        "penalties": penalties(result),
        "cycles": int(result.outcome.cycles),
        "evaluations": int(result.outcome.evaluations),
        "yields": int(result.outcome.yields),
        "milliseconds": milliseconds,
        "wrist_error_m": _sides(found.wrist_error_m),
        "reached": _sides(result.wrist_error_m < 1e-3),
        "foot_error_m": _sides(found.foot_error_m),
        "foot_error_deg": _sides(np.degrees(found.foot_error_rad)),
        "balance_error_m": found.balance_error_m,
        "com_wanted_m": result.plan.balance_m.tolist(),
        "com_m": result.com_m.tolist(),
        "support_m": found.support_m.tolist(),
        "support_margin_m": found.margin_m,
        "joint_limit_excess_rad": found.limit_excess_rad,
        "gaze_error_deg": None if math.isnan(found.gaze_error_rad) else math.degrees(found.gaze_error_rad),
        "lower_body_kept": result.kept,
        "pose": pose_as_json(result),
    }


def pose_as_json(result: StanceResult) -> dict[str, Any]:
    """Joints in the world and local rotations, by name."""
    return {
        "joints_m": dict(zip(JOINTS, result.joints_m.tolist(), strict=True)),
        "rotations_wxyz": dict(zip(JOINTS, result.pose.rotations.tolist(), strict=True)),
    }


def lines(body: Body, result: StanceResult, set_name: str, intensity: float, milliseconds: float) -> list[str]:
    """The report for people: the shape, how the solve went, and every error."""
    found, outcome = measures(body, result), result.outcome
    said = [f"{set_name} {intensity:+.2f}", f"  states      {', '.join(_words(result))}"]
    said += [f"  {name:<24} {value:+.3f}" for name, value in amplitudes(result).items() if abs(value) > 5e-4]
    others = {k: v for k, v in result.shape.numbers._asdict().items() if abs(v) > 5e-4 and not _is_unknown(k)}
    said += [f"  {name:<24} {value:+.3f}" for name, value in others.items()]
    said.append(
        f"  solved in {outcome.cycles} cycles, {outcome.evaluations} evaluations, {outcome.yields} steps of giving "
        f"way, {milliseconds:.2f} ms"
    )
    return said + [f"  {line}" for line in _errors(result, found)]


def _errors(result: StanceResult, found: Measures) -> list[str]:
    foot_mm, foot_deg = 1000 * found.foot_error_m.max(), math.degrees(found.foot_error_rad.max())
    over_deg = math.degrees(found.limit_excess_rad)
    said = [
        f"feet        off by {foot_mm:.2g} mm, {foot_deg:.2g} deg",
        f"balance     off by {1000 * found.balance_error_m:.2g} mm, {100 * found.margin_m:.1f} cm inside the support",
        f"limits      {'kept' if over_deg < 1e-4 else f'exceeded by {over_deg:.2f} deg'}",
    ]
    for side, name in enumerate(("left", "right")):
        if result.plan.reaching[side]:
            miss = result.wrist_error_m[side]
            said.append(
                f"{name:<5} wrist {'on its target' if miss < 1e-3 else f'{100 * miss:.1f} cm short of its target'}"
            )
    if not math.isnan(found.gaze_error_rad):
        said.append(
            f"gaze        {math.degrees(found.gaze_error_rad):.0f} deg from the target, weight {result.plan.gaze:.2f}"
        )
    if result.kept < 1.0:
        said.append(f"legs        let the lower body have {100 * result.kept:.0f} % of what was asked")
    return said


def _words(result):
    states = result.shape.states
    yield f"sagittal {states.sagittal_class}"
    yield f"coronal {states.coronal_class}"
    yield f"collars {states.collar_y} in Y, {states.collar_z} in Z"
    yield f"{('left', 'right')[result.plan.lower.root]} foot dominant"


def _is_unknown(name: str) -> bool:
    return name in ("coronal", "sagittal", "transverse_rad", "collar_y_rad", "collar_z_rad", "abdomen_x_rad")


def _sides(pair) -> dict[str, Any]:
    left, right = np.asarray(pair).tolist()
    return {"left": left, "right": right}
