"""From a threat in the world to the sustained pose of the character it comes at (thesis 3): what the pose is computed
from.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.components import Character, Flight, Reaction, Sustained, Threat
from behaviours.perceive.perceived import AIMS, PerceivedThreat, aim_of, target_weights
from behaviours.perceive.threats import KINDS
from behaviours.playing import body_of, clip_pose, planted_in_clip
from behaviours.protect.mirroring import rounded_pose, rounded_threat
from behaviours.protect.sustained import Protection, protect
from behaviours.settle.seams import shown
from behaviours.timing import TICK_S
from behaviours.wearing import as_felt
from engine.body.kinematics import joints_of
from engine.body.skeleton import Body, Pose


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
    flies = flight_ticks(world, row, clip_s, ttc_s)
    if flies:
        landing_s = clip_s + flies * TICK_S
        return clip_pose(world, row, landing_s), planted_in_clip(world, row, landing_s), True
    ahead_s = world.assets.settings.timing.sustained_ahead_s
    return clip_pose(world, row, clip_s + ahead_s), planted_in_clip(world, row, clip_s), False


def flight_ticks(world, row: int, clip_s: float, ttc_s: float) -> int:
    """How long it is to the clip's next landing; 0 for a foot on the ground, or no landing within the time to
    contact.
    """
    for k in range(int(ttc_s / TICK_S)):
        if planted_in_clip(world, row, clip_s + k * TICK_S).any():
            return k
    return 0


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
    """The protective pose of a character as it is now."""
    ahead, planted, landing = look_ahead(world, row, clip_s, ttc_s)
    now, side = shown(world, row)[0], float(world[Character].turn_side[row])
    return _defence(protect(
        body_of(world, row), rounded_pose(now), rounded_pose(ahead), planted, rounded_threat(threat),
        world.assets.settings, side, landing,
    ))  # fmt: skip


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
