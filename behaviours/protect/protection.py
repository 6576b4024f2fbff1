"""From a threat in the world to the sustained pose of the character it comes at (thesis 3): what the pose is computed
from.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.components import Character, Flight, Reaction, Sustained, Threat
from behaviours.perceive.perceived import AIMS, PerceivedThreat
from behaviours.playing import body_of, clip_pose, planted_in_clip
from behaviours.protect.aiming import perceive
from behaviours.protect.mirroring import rounded_pose, rounded_threat
from behaviours.protect.sustained import Protection, protect
from behaviours.protect.task import AtPerception
from behaviours.settle.seams import shown
from behaviours.timing import TICK_S
from behaviours.wearing import as_felt
from engine.body.skeleton import Pose


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


def at_perception(world, row: int, clip_s: float, ttc_s: float) -> AtPerception:
    """How a character is now, and where its clip goes on (A4): 1/6 s with a foot on the ground; in flight to its next
    landing, if that comes within the time to contact.
    """
    now, turn_side = shown(world, row)[0], float(world[Character].turn_side[row])
    flies = flight_ticks(world, row, clip_s, ttc_s)
    if flies:
        lands_s = clip_s + flies * TICK_S
        landing = clip_pose(world, row, lands_s)
        return AtPerception(now, landing, planted_in_clip(world, row, lands_s), True, turn_side)
    ahead = clip_pose(world, row, clip_s + world.assets.settings.timing.sustained_ahead_s)
    return AtPerception(now, ahead, planted_in_clip(world, row, clip_s), False, turn_side)


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
    at = at_perception(world, row, clip_s, ttc_s)
    at = at._replace(now=rounded_pose(at.now), ahead=rounded_pose(at.ahead))
    return _defence(protect(body_of(world, row), at, rounded_threat(threat), world.assets.settings))


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
