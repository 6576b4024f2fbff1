"""Where the two sources meet (S9), measured: one threat met by a timid and by a bold character of one clip."""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np

from behaviours.protect.pose_report import PoseCase, pose_case
from behaviours.protect.sustained import Case
from behaviours.settings import Settings
from behaviours.wearing import worn_by
from engine.body.kinematics import com_of, joints_of
from engine.body.skeleton import WRISTS
from engine.clips.library import find_clip, list_clips

CLIPS = ("sway", "walk", "stand", "run")  # those of them that are here
TIMES_S = (0.4, 0.9)
AZIMUTHS_DEG, ELEVATION_DEG = (0.0, 40.0, -70.0), 8.0
SPEEDS_MPS, TARGETS = (23.0, 29.0), ("head", "torso")
# boldness, and the stance that goes with it
TIMID, BOLD = (-1.0, "posture", -0.5), (1.0, "posture", 0.9)


class Pair(NamedTuple):
    """One threat met twice. Metres."""

    what: str
    apart_m: float  # the wrist that differs more
    off_balance_m: float  # the worse of the two; nan where neither can be in balance (nobody stands)


def pairs() -> list[Pair]:
    """Every threat at every clip that is here."""
    ready = {listed.name for listed in list_clips() if listed.ready}
    rows = product([c for c in CLIPS if c in ready], TIMES_S, AZIMUTHS_DEG, SPEEDS_MPS, TARGETS)
    return [pair for row in rows if (pair := _pair(*row)) is not None]


def _pair(clip_name: str, at_s: float, azimuth_deg: float, speed_mps: float, target: str) -> Pair | None:
    """None where the character is in the air, or too far out of balance for any pose to mend (thesis 3.3)."""
    clip, wrists, off = find_clip(clip_name), [], []
    for boldness, stance, intensity in (TIMID, BOLD):
        case = PoseCase(
            at_s, azimuth_deg, ELEVATION_DEG, speed_mps, 0.5, target,
            worn=worn_by(clip.body, stance, intensity), boldness=boldness,
        )  # fmt: skip
        found = pose_case(clip, case, Settings()).protection
        if found.case in (Case.UNRECOVERED, Case.AIRBORNE):
            return None
        wrists.append(joints_of(clip.body, found.sustained)[0][list(WRISTS)])
        off.append(float(np.hypot(*(com_of(clip.body, found.sustained)[:2] - found.com_wanted_m))))
    apart_m = float(np.sqrt(((wrists[0] - wrists[1]) ** 2).sum(axis=1)).max())
    return Pair(f"{clip_name} {at_s:g} s, {azimuth_deg:+.0f} deg, {speed_mps:g} m/s, {target}", apart_m, max(off))
