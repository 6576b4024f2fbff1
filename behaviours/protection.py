"""From a threat in the world to the sustained pose of the character it comes at (thesis 3): what the pose is computed
from.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from behaviours.components import Character, Flight, Reaction, Sustained, Threat
from behaviours.perceived import AIMS, NO_JOINT, PerceivedThreat, aim_of, target_weights
from behaviours.playing import body_of, clip_pose, planted_in_clip
from behaviours.seams import shown
from behaviours.sustained import Protection, protect
from behaviours.threats import KINDS
from behaviours.timing import TICK_S
from behaviours.wearing import as_felt
from engine.body.kinematics import joints_of
from engine.body.skeleton import MIRRORED, PELVIS, Body, Pose
from engine.clips.mirror import mirror_pose
from engine.maths import quaternion

# lean, turn, recoil, then left and right of reach and of swivel
MIRRORED_CONTROLS = np.array([0, 1, 2, 4, 3, 6, 5])


def perceive(
    body: Body, pose: Pose, aim: str, line_m, tangent, travel, speed_norm: float, size_norm: float, radius_m: float
) -> PerceivedThreat:
    """A threat as the rules take it. `pose` says how head and pelvis share the defence (3.4)."""
    joint, offset = aim_of(body, aim)
    head, pelvis = 1.0, 0.0
    if aim == "pelvis":
        head, pelvis = 0.0, 1.0
    elif aim != "head":
        head, pelvis = target_weights(body, line_m, *joints_of(body, pose))
    excess_m = max(0.0, radius_m - KINDS["volleyball"].radius_m)
    return PerceivedThreat(
        _triple(travel), _triple(tangent), _triple(line_m), joint, offset,
        float(speed_norm), float(size_norm), excess_m, float(head), float(pelvis),
    )  # fmt: skip


def _triple(v) -> tuple[float, float, float]:
    return (float(v[0]), float(v[1]), float(v[2]))


def felt(world, row: int, speed_norm: float, size_norm: float) -> tuple[float, float]:
    """A threat's speed and size as the rules take them: coloured by how bold the character is (S9)."""
    temper, boldness = world.assets.settings.temper, float(world[Character].boldness[row])
    return as_felt(speed_norm, boldness, temper.speed_share), as_felt(size_norm, boldness, temper.size_share)


def perceived_threat(world, row: int, threat_row: int) -> PerceivedThreat:
    """The threat in a row of the world, as the character in another sees it."""
    t = world[Threat]
    return perceive(
        body_of(world, row),
        shown(world, row)[0],
        AIMS[t.aim[threat_row]],
        t.line_m[threat_row],
        t.tangent[threat_row],
        t.travel[threat_row],
        *felt(world, row, t.speed_norm[threat_row], t.size_norm[threat_row]),
        world[Flight].radius_m[threat_row],
    )


def look_ahead(world, row: int, clip_s: float, ttc_s: float) -> tuple[Pose, np.ndarray, bool]:
    """The clip's pose that pelvis and lifted foot come from, which feet stand, and whether that is the clip's next
    landing (A4).

    With a foot on the ground: the clip 1/6 s on. In flight: the landing, if it comes within the time to contact.
    """
    ahead_s = world.assets.settings.timing.sustained_ahead_s
    planted = planted_in_clip(world, row, clip_s)
    if not planted.any():
        for k in range(1, int(ttc_s / TICK_S)):
            landing_s = clip_s + k * TICK_S
            there = planted_in_clip(world, row, landing_s)
            if there.any():
                return clip_pose(world, row, landing_s), there, True
    return clip_pose(world, row, clip_s + ahead_s), planted, False


class Defence(NamedTuple):
    """What the reaction takes from a worked-out protection. World."""

    rules: Pose
    sustained: Pose
    controls: np.ndarray  # (7,)
    com_wanted_m: np.ndarray  # (2,)
    case: int
    held: np.ndarray  # (2,) bool: left, right foot stands in it
    turn_side: int


def defend(world, row: int, threat: PerceivedThreat, clip_s: float, ttc_s: float) -> Defence:
    """The protective pose of a character as it is now.

    It is always worked out as for a threat from the left: one from the right is mirrored, with all that it is aimed
    at, and the answer mirrored back. A search stops where rounding lets it; so it stops at the same place for both.
    """
    body, now = body_of(world, row), shown(world, row)[0]
    ahead, planted, landing = look_ahead(world, row, clip_s, ttc_s)
    side, settings = float(world[Character].turn_side[row]), world.assets.settings
    if comes_from_left(now, threat):
        return _defence(protect(body, now, ahead, planted, threat, settings, side, landing))
    body = world.assets.mirrored_bodies[int(world[Character].body[row])]
    seen = mirrored_threat(threat)
    found = protect(body, mirror_pose(now), mirror_pose(ahead), planted[::-1].copy(), seen, settings, -side, landing)
    return mirrored_defence(_defence(found))


def comes_from_left(now: Pose, threat: PerceivedThreat) -> bool:
    """Whether a threat comes from the character's left, or from dead ahead."""
    heading = quaternion.heading(now.rotations[PELVIS])
    leftward = math.cos(heading) * threat.direction[1] - math.sin(heading) * threat.direction[0]
    return bool(leftward <= 0.0)


def mirrored_threat(threat: PerceivedThreat) -> PerceivedThreat:
    """The same threat in a mirror along the X axis."""
    joint = threat.target_joint
    return threat._replace(
        direction=_mirrored(threat.direction),
        tangent=_mirrored(threat.tangent),
        line_point_m=_mirrored(threat.line_point_m),
        target_joint=joint if joint == NO_JOINT else int(MIRRORED[joint]),
        target_offset_m=_mirrored(threat.target_offset_m),
    )


def mirrored_defence(found: Defence) -> Defence:
    """A defence seen in that mirror."""
    return Defence(
        mirror_pose(found.rules),
        mirror_pose(found.sustained),
        found.controls[MIRRORED_CONTROLS],
        found.com_wanted_m * [1.0, -1.0],
        found.case,
        found.held[::-1].copy(),
        -found.turn_side,
    )


def _mirrored(v) -> tuple[float, float, float]:
    return (v[0], -v[1], v[2])


def _defence(found: Protection) -> Defence:
    return Defence(
        found.rules,
        found.sustained,
        np.array(found.controls),
        np.array(found.com_wanted_m),
        int(found.case),
        np.array(found.feet.held),
        int(np.sign(found.choices.turn_side)),
    )


def protect_from(world, row: int, threat: PerceivedThreat) -> None:
    """Works out the sustained pose and keeps it in the character's row."""
    r, s = world[Reaction], world[Sustained]
    ttc_s = float(r.contact[row] - r.perceived[row]) * TICK_S
    found = defend(world, row, threat, float(r.clip_s[row]), ttc_s)
    s.root_m[row], s.rotations[row] = found.sustained
    s.rules_root_m[row], s.rules_rotations[row] = found.rules
    s.controls[row] = found.controls
    s.com_wanted_m[row] = found.com_wanted_m
    s.case[row] = found.case
    s.held[row] = found.held
    world[Character].turn_side[row] = found.turn_side
