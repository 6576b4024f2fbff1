"""A scenario, running: the world it is played in, the systems of a tick in their order, and the commands that come
from outside.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from behaviours.components import (
    COMPONENTS,
    NOBODY,
    Blend,
    Blow,
    Character,
    Feet,
    Playback,
    Posture,
    Ragdoll,
    Reaction,
    Recover,
    Residual,
    Script,
    Struck,
    Sustained,
)
from behaviours.launching import launch_threats, make_of, threaten, throw
from behaviours.measure.observing import Observer
from behaviours.measure.report import report_of
from behaviours.overriding import override
from behaviours.perceive.flying import clear_away, fly_balls
from behaviours.perceive.senses import watch_free_threats
from behaviours.placing import placed
from behaviours.reaction import advance_reactions, notice
from behaviours.recover.getting_up import get_up
from behaviours.recover.going_on import go_on
from behaviours.recover.library import FindClip, clip_for, gather_libraries
from behaviours.recover.search import Library
from behaviours.respond.contact import meet_balls
from behaviours.respond.response import step_bodies
from behaviours.scenario import check_threat, check_throw
from behaviours.scenario_spec import BallSpec, CharacterSpec, Scenario, ThreatSpec
from behaviours.settings import Settings
from behaviours.settle.settling import settle_poses
from behaviours.stance.shape import mix, shape
from behaviours.timing import TICK_S
from behaviours.wearing import Worn, worn_by, worn_pose, worn_shape
from engine.body.capsules import Capsules, body_capsules
from engine.body.skeleton import Body
from engine.clips.clip import Clip
from engine.clips.mirror import mirror_clip
from engine.clips.playback import sample
from engine.core.clock import ticks
from engine.core.errors import BadInput
from engine.core.journal import Command
from engine.core.schedule import Schedule
from engine.core.world import World
from engine.physics.model import RagdollModel, model_for

# one tick, the way the data flows; the schedule sorts by stage and keeps this order within one
SYSTEMS = (
    clear_away,
    fly_balls,
    launch_threats,
    watch_free_threats,
    advance_reactions,
    get_up,
    go_on,
    notice,
    step_bodies,
    settle_poses,
    meet_balls,
)


@dataclass(frozen=True)
class Assets:
    """What never changes in a run: shared by all ticks, no part of the state."""

    settings: Settings
    clips: tuple[Clip, ...]
    bodies: tuple[Body, ...]
    models: tuple[RagdollModel, ...]
    capsules: tuple[Capsules, ...]
    stances: tuple[Worn | None, ...]  # None: the clip as it is
    threats: tuple[ThreatSpec, ...]
    character_rows: tuple[int, ...]
    libraries: tuple[Library | None, ...]  # of each character: what it may go on with, where that is searched for


def build_world(scenario: Scenario, find: FindClip) -> World:
    """The world of a scenario at tick 0. `find` brings a character's clip (it may raise BadInput)."""
    own = tuple(_clip_of(spec, find) for spec in scenario.character)
    bodies = tuple(clip.body for clip in own)
    rows = tuple(range(len(own)))
    settings = override(Settings(), flat_settings(scenario.settings))
    models = tuple(model_for(body) for body in bodies)
    capsules = tuple(body_capsules(body) for body in bodies)
    clips, libraries = gather_libraries(scenario, own, find, settings)
    stances = tuple(_stance_of(spec, body) for spec, body in zip(scenario.character, bodies, strict=True))
    assets = Assets(settings, clips, bodies, models, capsules, stances, scenario.threat, rows, libraries)
    world = World(COMPONENTS, scenario.seed, assets)
    for row, spec in zip(rows, scenario.character, strict=True):
        _spawn_character(world, row, spec)
    for k in range(len(scenario.threat)):
        world.spawn(Script(spec=k))
    return world


def _clip_of(spec: CharacterSpec, find: FindClip) -> Clip:
    clip = find(spec)
    return mirror_clip(clip) if spec.mirrored else clip


def _stance_of(spec: CharacterSpec, body: Body) -> Worn | None:
    stance = spec.stance
    if stance.intensity == 0.0:
        return None
    if stance.shape is not None:
        own: dict[str, Any] = dict(stance.shape)
        return worn_shape(body, mix(shape(), shape(**own), stance.intensity))
    return worn_by(body, stance.set, stance.intensity)


def flat_settings(nested: dict[str, Any]) -> dict[str, Any]:
    """{"block": {"offset_m": 0.1}} -> {"block.offset_m": 0.1}. BadInput where a group holds no keys."""
    flat: dict[str, Any] = {}
    for group, values in nested.items():
        if not isinstance(values, dict):
            raise BadInput("scenario", f"settings.{group} must be a table of constants, found {values!r}")
        flat |= {f"{group}.{name}": value for name, value in values.items()}
    return flat


def _spawn_character(world: World, row: int, spec: CharacterSpec) -> None:
    """One character standing in its clip at the start time."""
    clip = world.assets.clips[row]
    if spec.start_s > clip.duration_s and not clip.loops:
        raise BadInput(
            "scenario",
            f"character.{row}.start_s is {spec.start_s}; the clip {clip.name!r} lasts {clip.duration_s:.2f} s",
        )
    heading = math.radians(spec.heading_deg)
    # the character, not the clip's first frame, stands at the place asked for
    start = placed(sample(clip, spec.start_s), (0.0, 0.0), heading)
    place = np.array(spec.position_m) - start.root_m[:2]
    pose, before = (placed(sample(clip, max(0.0, spec.start_s - s)), place, heading) for s in (0.0, TICK_S))
    worn = world.assets.stances[row]
    if worn is not None:
        pose, before = worn_pose(clip.body, pose, worn), worn_pose(clip.body, before, worn)
    entity = world.spawn(
        Playback(clip=row, offset_s=spec.start_s + TICK_S, own_pace=-1000.0, place_m=place, heading_rad=heading),
        Posture(
            root_m=pose.root_m, rotations=pose.rotations, before_root_m=before.root_m, before_rotations=before.rotations
        ),
        Character(
            body=row,
            startle=spec.startle,
            protects=spec.protects,
            boldness=spec.boldness,
            response_s=spec.response_s,
        ),
        Reaction(threat=NOBODY),
        Blend(ticks=1.0),
        Sustained(root_m=pose.root_m, rotations=pose.rotations),
        Ragdoll(),
        Struck(recover=Recover[spec.recover.upper()], played=row),
        Blow(ball=NOBODY),
        Feet(ticks=(1.0, 1.0)),
        Residual(since=-1000),
    )
    assert world.row(entity) == row  # characters come first: their rows are those of the assets


def apply_command(world: World, command: Command) -> None:
    """What comes in from outside, as data, before a tick. BadInput where it is neither of

    {"do": "throw", position_m, velocity_mps, at: which character, and what `ThrowSpec` has}: a ball that may miss;
    {"do": "threaten", "threat": {what a scenario's threat says}}: one that comes as a scripted threat does, from now.
    """
    if command.get("do") == "threaten":
        threat = check_threat(command.get("threat"))
        _row_of(world, threat)
        threaten(world, threat)
        return
    if command.get("do") != "throw":
        raise BadInput("command", f"unknown command {command.get('do')!r}; expected 'throw' or 'threaten'")
    ball = check_throw(command)
    make = make_of(ball, math.dist(ball.velocity_mps, (0.0, 0.0, 0.0)))
    throw(world, _row_of(world, ball), ball.kind, make, ball.position_m, ball.velocity_mps, ball.spin_radps)


def _row_of(world: World, ball: BallSpec) -> int:
    """Of the character that it is meant for. BadInput where there is none."""
    rows = world.assets.character_rows
    if ball.at_character >= len(rows):
        raise BadInput("command", f"at character {ball.at_character}: there are {len(rows)}, counted from 0")
    return rows[ball.at_character]


class Simulation:
    """A world and its schedule, to be stepped; with `observe`, watched for the report."""

    def __init__(self, scenario: Scenario, find: FindClip = clip_for, *, observe: bool = False, checked: bool = False):
        """find: brings the clip of a character; checked: systems may touch only what they declare. BadInput or
        EnvironmentTrouble where a clip cannot be had.
        """
        self.scenario = scenario
        self.commands: dict[int, list[Command]] = {}
        for given in scenario.command:
            self.commands.setdefault(ticks(given.at_s), []).append(given.as_command())
        self.world = build_world(scenario, find)
        self.schedule = Schedule(SYSTEMS, checked=checked)
        self.observer = Observer(self.world, self.world.assets.character_rows) if observe else None

    @property
    def ticks(self) -> int:
        """How many ticks the scenario lasts."""
        return round(self.scenario.duration_s / TICK_S)

    def step(self, world: World | None = None) -> None:
        """One tick, the scenario's commands for it first. Takes the world as recorders pass it; it is always this
        simulation's own.
        """
        for command in self.commands.get(self.world.tick, ()):
            apply_command(self.world, command)
        self.schedule.tick(self.world)
        if self.observer:
            self.observer.look(self.world)

    def report(self) -> dict[str, Any]:
        """What happened, as `brace react --json` has it. ValueError unless observed."""
        if self.observer is None:
            raise ValueError("only a simulation made with observe=True can report")
        return report_of(self.world, self.observer.tracks)
