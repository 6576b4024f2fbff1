"""Senses: which threats are on their way, to whom, and when a character notices them (thesis 3.1, 4.2).

There is no model of the eyes. A scripted threat is perceived one time-to-contact before the contact that its script
promises; a free one is predicted, every tick, with the very function that it flies by, and may miss.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from behaviours.components import Character, Flight, Posture, Reaction, Threat
from behaviours.perceive.perceived import AIMS, aim_of, target_centre
from behaviours.playing import body_of, heading_of
from behaviours.settle.seams import shown
from behaviours.timing import TICK_S, facing_dot_threat, time_to_contact_s, whole_ticks
from engine.body.kinematics import joints_of
from engine.core.schedule import Stage, system
from engine.maths import vector
from engine.maths.ballistics import GRAVITY_MPS2, fly
from engine.maths.kernel import njit

GUARDED = ("head", "torso", "pelvis")  # what a free threat may be about to hit


class Encounter(NamedTuple):
    """When and where a flight comes closest to a place. Seconds from now, metres, m/s."""

    after_s: float
    distance_m: float
    centre_m: tuple[float, float, float]
    velocity_mps: tuple[float, float, float]


@njit(cache=True)
def closest_approach(position_m, velocity_mps, drag, place_m, horizon_s, step_s):
    """Flies a ball ahead until it is nearest to a place, within a horizon. Returns the fields of an Encounter.

    Once the ball only goes away from the place the search is over; between the last steps a parabola is fitted.
    """
    p = (position_m[0], position_m[1], position_m[2])
    v = (velocity_mps[0], velocity_mps[1], velocity_mps[2])
    best_s, best_m, best_p, best_v = 0.0, vector.distance(p, place_m), p, v
    steps = int(horizon_s / step_s)
    for k in range(1, steps + 1):
        p, v = fly(p, v, GRAVITY_MPS2, drag, step_s)
        away = vector.distance(p, place_m)
        if away < best_m:
            best_s, best_m, best_p, best_v = k * step_s, away, p, v
        elif k * step_s > best_s + 0.25:
            break
    # within the step the path is straight: its foot point from the place
    speed2 = max(vector.inner(best_v, best_v), 1e-12)
    late = -vector.inner(vector.subtract(best_p, place_m), best_v) / speed2
    late = min(max(late, -step_s), step_s)
    if best_s + late < 0.0:
        late = -best_s
    at, speed = fly(best_p, best_v, GRAVITY_MPS2, drag, late)
    return best_s + late, vector.distance(at, place_m), at, speed


def predict(world, row: int, threat_row: int) -> tuple[str, Encounter]:
    """What part of a character a flight comes closest to, and how: the part's name and the encounter."""
    f, settings, body = world[Flight], world.assets.settings, body_of(world, row)
    positions, orientations = joints_of(body, shown(world, row)[0])
    found = []
    for name in GUARDED:
        joint, offset = aim_of(body, name)
        place = target_centre(joint, offset, positions, orientations)
        found.append((
            name,
            Encounter(*closest_approach(
                f.position_m[threat_row], f.velocity_mps[threat_row], float(f.drag_per_m[threat_row]),
                place, settings.senses.horizon_s, TICK_S,
            )),
        ))  # fmt: skip
    return min(found, key=lambda pair: pair[1].distance_m)


def facing_dot(world, row: int, towards) -> float:
    """Cosine between the way the character in a row faces and a direction (towards the threat)."""
    return facing_dot_threat(heading_of(world, row), towards)


def normal_ttc_s(world, row: int, threat_row: int, velocity_mps) -> float:
    """The time to contact at which a character notices such a threat (eq. 4.1)."""
    towards = vector.scale(vector.unit(velocity_mps, (1.0, 0.0, 0.0)), -1.0)
    speed_norm = float(world[Threat].speed_norm[threat_row])
    return time_to_contact_s(speed_norm, facing_dot(world, row, towards), world.assets.settings.timing)


@system(Stage.SENSE, reads=(Flight, Threat, Posture, Character, Reaction), writes=(Threat,))
def watch_free_threats(world, tick):
    """A free ball that will hit or pass close is noticed, no sooner than eq. 4.1 has it; what it will do is known
    each tick.
    """
    t = world[Threat]
    for threat_row in world.rows(Threat, Flight):
        if t.spent[threat_row]:
            continue
        row = world.row(int(t.at[threat_row]))
        if t.noticed[threat_row] and not t.passes[threat_row]:
            t.strayed[threat_row] = has_strayed(world, threat_row)
        elif not t.scripted[threat_row]:
            look_at(world, row, threat_row, tick)


def look_at(world, row: int, threat_row: int, tick: int) -> None:
    """A free ball that nobody guards against yet: will it hit, pass close, or neither?"""
    t, senses = world[Threat], world.assets.settings.senses
    name, meeting = predict(world, row, threat_row)
    if meeting.after_s <= 0.0:
        t.spent[threat_row] = meeting.distance_m > senses.gone_m
        return
    gap_m = meeting.distance_m - world[Flight].radius_m[threat_row]
    passes = gap_m > senses.hit_within_m
    if gap_m > max(senses.hit_within_m, senses.flinch_within_m) or (passes and t.noticed[threat_row]):
        return
    if meeting.after_s <= normal_ttc_s(world, row, threat_row, meeting.velocity_mps):
        face(world, threat_row, name, meeting.centre_m, meeting.velocity_mps, tick, meeting.after_s)
        t.passes[threat_row], t.taken_up[threat_row] = passes, False


def has_strayed(world, threat_row: int) -> bool:
    """Whether a noticed ball no longer comes along the line that it is expected on: something else was in its way."""
    f, t = world[Flight], world[Threat]
    _, distance_m, _, _ = closest_approach(
        f.position_m[threat_row], f.velocity_mps[threat_row], float(f.drag_per_m[threat_row]), t.line_m[threat_row],
        world.assets.settings.senses.horizon_s, TICK_S,
    )  # fmt: skip
    return bool(distance_m > world.assets.settings.senses.strayed_m)


def face(world, threat_row: int, aim: str, line_m, velocity_mps, tick: int, ttc_s: float) -> None:
    """Writes what a perceived threat means: its line, its travel, when it comes."""
    t, position = world[Threat], world[Flight].position_m[threat_row]
    t.aim[threat_row] = AIMS.index(aim)
    t.contact[threat_row] = tick + whole_ticks(ttc_s)
    t.line_m[threat_row] = line_m
    t.tangent[threat_row] = vector.unit(velocity_mps, (-1.0, 0.0, 0.0))
    t.travel[threat_row] = vector.unit(vector.subtract(line_m, position), (-1.0, 0.0, 0.0))
    t.noticed[threat_row] = True


def first_due(seconds: float) -> int:
    """The tick at which a time of the scenario falls due."""
    return int(np.rint(seconds / TICK_S))
