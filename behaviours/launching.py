"""Launching the threats of a scenario (thesis 3.1): scripted ones flown back from their contact, free ones thrown."""

from __future__ import annotations

import math
from functools import partial

from behaviours.components import Character, Feet, Flight, Phase, Playback, Posture, Reaction, Script, Threat
from behaviours.perceive.approach import Approach, coming_from
from behaviours.perceive.perceived import aim_of, target_centre
from behaviours.perceive.senses import face, facing_dot, first_due
from behaviours.perceive.threats import KINDS, Make, make_threat
from behaviours.playing import body_of, clip_pose, clip_time_s, heading_of, perception_clip_s
from behaviours.protect.aiming import Asked, aimed, aimed_unseen
from behaviours.protect.protection import at_perception, felt
from behaviours.scenario_spec import BallSpec, ThreatSpec
from behaviours.settle.seams import shown
from behaviours.timing import TICK_S, time_to_contact_s, whole_ticks
from engine.body.kinematics import joints_of
from engine.body.skeleton import Pose
from engine.core.schedule import Stage, system
from engine.maths import vector
from engine.maths.ballistics import GRAVITY_MPS2, fly

UPRIGHT = (1.0, 0.0, 0.0, 0.0)


def make_of(spec: BallSpec, speed_mps: float) -> Make:
    """The body of a scenario's threat."""
    return make_threat(
        spec.kind,
        speed_mps,
        spec.size,
        size_means=spec.size_means,
        radius_m=spec.radius_m,
        mass_kg=spec.mass_kg,
        speed_range_mps=spec.speed_range_mps,
        drag=spec.drag,
    )


def speed_of(spec: ThreatSpec) -> float:
    """The speed asked for, else the middle of the kind's range."""
    low, high = spec.speed_range_mps or KINDS[spec.kind].speed_range_mps
    return 0.5 * (low + high) if spec.speed_mps is None else spec.speed_mps


@system(
    Stage.SENSE,
    reads=(Script, Posture, Playback, Character, Reaction, Feet, Flight, Threat),
    writes=(Script, Flight, Threat),
)
def launch_threats(world, tick):
    """Whatever the scenario has due now takes off."""
    for script_row in world.rows(Script):
        spec = world.assets.threats[int(world[Script].spec[script_row])]
        character = world.assets.character_rows[spec.at_character]
        if spec.free:
            if tick >= first_due(spec.released_s):
                throw_free(world, spec, character)
                world.despawn(world.entity(script_row))
        elif is_due(world, spec, character, tick):
            throw_scripted(world, spec, character, tick)
            world.despawn(world.entity(script_row))


def scripted_ttc_s(world, spec: ThreatSpec, row: int) -> float:
    """How long before its contact a scripted threat is perceived (eq. 4.1, from its velocity at contact)."""
    if spec.ttc_s is not None:
        return spec.ttc_s
    make = make_of(spec, speed_of(spec))
    towards = coming_from(heading_of(world, row), math.radians(spec.azimuth_deg), math.radians(spec.elevation_deg))
    return time_to_contact_s(make.speed_norm, facing_dot(world, row, towards), world.assets.settings.timing)


def is_due(world, spec: ThreatSpec, row: int, tick: int) -> bool:
    """Whether a scripted threat is perceived now."""
    if spec.contact_s is not None:
        return tick + whole_ticks(scripted_ttc_s(world, spec, row)) >= first_due(spec.contact_s)
    return tick >= first_due(1.0 if spec.perceived_s is None else spec.perceived_s)


def throw_scripted(world, spec: ThreatSpec, row: int, tick: int) -> int:
    """Puts a scripted threat where it has to be now to arrive as its script says; it is perceived at once. Its
    handle.
    """
    make = make_of(spec, speed_of(spec))
    way = aimed_approach(world, spec, make, row)
    entity = world.spawn(
        ball(spec.kind, make, way.start_m, way.start_mps, spec.spin_radps),
        Threat(at=world.entity(row), speed_norm=make.speed_norm, size_norm=make.size_norm, scripted=True),
    )
    face(world, world.row(entity), str(spec.target), way.contact_m, way.contact_mps, tick, way.ttc_s)
    world.emit(
        "launched",
        entity,
        at=world.entity(row),
        target=str(spec.target),
        ttc_s=way.ttc_s,
        elevation_raised_deg=way.raised_deg,
        ttc_shortened_s=way.shortened_s,
    )
    return entity


def threaten(world, spec: ThreatSpec) -> None:
    """A scripted threat that begins to come now, from outside: as if the scenario had it due at this tick.

    Balls fly before threats are launched, so in this tick it flies once more than one of the scenario's: it starts a
    tick further back.
    """
    entity = throw_scripted(world, spec, world.assets.character_rows[spec.at_character], world.tick)
    f, row = world[Flight], world.row(entity)
    at, speed = fly(f.position_m[row], f.velocity_mps[row], GRAVITY_MPS2, float(f.drag_per_m[row]), -TICK_S)
    f.position_m[row], f.velocity_mps[row] = at, speed


def aimed_approach(world, spec: ThreatSpec, make: Make, row: int) -> Approach:
    """The flight that meets the target's centre as it will be in the rules pose, before block (A1), or where it will be
    anyway, of somebody who sees nothing coming.
    """
    body, settings = body_of(world, row), world.assets.settings
    ttc_s = whole_ticks(scripted_ttc_s(world, spec, row)) * TICK_S
    asked = Asked(
        str(spec.target), math.radians(spec.azimuth_deg), math.radians(spec.elevation_deg), speed_of(spec), ttc_s,
        make, felt(world, row, make.speed_norm, make.size_norm),
    )  # fmt: skip
    if not world[Character].protects[row]:
        return aimed_unseen(body, shown(world, row)[0], partial(unaware_pose, world, row), asked, settings)[0]
    at = at_perception(world, row, perception_clip_s(world, row, world.tick), ttc_s)
    return aimed(body, at, asked, settings)[0]


def unaware_pose(world, row: int, later_s: float) -> Pose:
    """What somebody who goes on as they are will look like by then: the clip's pose; of one who was struck, as now."""
    if world[Reaction].phase[row] != Phase.PLAY:
        return shown(world, row)[0]
    return clip_pose(world, row, clip_time_s(world, row, world.tick + later_s / TICK_S))


def ball(kind: str, make: Make, position_m, velocity_mps, spin_radps=(0.0, 0.0, 0.0)) -> Flight:
    """A ball of a kind, about to fly."""
    of = KINDS[kind]
    return Flight(
        kind=list(KINDS).index(kind),
        position_m=position_m,
        velocity_mps=velocity_mps,
        spin_radps=spin_radps,
        turned=UPRIGHT,
        before_m=position_m,
        before_turned=UPRIGHT,
        radius_m=make.radius_m,
        mass_kg=make.mass_kg,
        drag_per_m=make.drag_per_m,
        restitution=of.restitution,
        friction=of.friction,
    )


def throw_free(world, spec: ThreatSpec, row: int) -> None:
    """Throws a free threat from where the scenario says, with its velocity or straight at its target."""
    velocity = spec.velocity_mps
    if velocity is None:
        velocity = velocity_towards(spec.position_m, place_of(world, spec.target, row), speed_of(spec))
    throw(world, row, spec.kind, make_of(spec, vector.length(velocity)), spec.position_m, velocity, spec.spin_radps)


def place_of(world, target, row: int):
    """Where a target is now: a point as it is, or a part of the character by name. World metres."""
    if not isinstance(target, str):
        return target
    body = body_of(world, row)
    joint, offset = aim_of(body, target)
    return target_centre(joint, offset, *joints_of(body, shown(world, row)[0]))


def velocity_towards(position_m, place_m, speed_mps: float) -> tuple[float, float, float]:
    """The velocity, about this fast, that brings a ball from one place to another under gravity, without drag."""
    way = vector.subtract(place_m, position_m)
    flight_s = max(vector.length(way) / speed_mps, 1e-3)
    return vector.subtract(vector.scale(way, 1.0 / flight_s), vector.scale(GRAVITY_MPS2, 0.5 * flight_s))


def throw(world, row: int, kind: str, make: Make, position_m, velocity_mps, spin_radps=(0.0, 0.0, 0.0)) -> int:
    """A ball thrown by anyone at a character, who may see it coming; it may miss. Its handle."""
    return world.spawn(
        ball(kind, make, position_m, velocity_mps, spin_radps),
        Threat(at=world.entity(row), speed_norm=make.speed_norm, size_norm=make.size_norm),
    )
