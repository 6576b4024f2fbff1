"""A whole run as arrays: who was where, what was thrown, what happened, at a steady rate."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from behaviours.components import Feet, Flight, Phase, Reaction
from behaviours.playing import body_of
from behaviours.simulation import Simulation
from demos.frames import frame_count, frames_of
from demos.running import with_progress
from demos.stage import shown_pose
from engine.body.skeleton import JOINT_COUNT, Body, Pose
from engine.core.clock import TICK_RATE_HZ
from engine.maths import rotations

PHASE_NAMES = tuple(phase.name.lower() for phase in Phase)
MARKED = ("perceived", "contact")  # events worth a mark on a timeline


class Person(NamedTuple):
    """One character, F frames."""

    name: str
    sex: str
    body: Body
    pose: Pose  # (F, 3), (F, 21, 4), each quaternion on the side of the one before
    phase: np.ndarray  # (F,) values of Phase
    planted: np.ndarray  # (F, 2) bool


class Thrown(NamedTuple):
    """One ball, F frames; where it is not seen yet or any more it stays at the nearest place where it was."""

    radius_m: float
    mass_kg: float
    position_m: np.ndarray  # (F, 3)
    turned: np.ndarray  # (F, 4)
    seen: np.ndarray  # (F,) bool


class Footage(NamedTuple):
    """Everything that was to be seen."""

    title: str
    fps: float
    time_s: np.ndarray  # (F,)
    people: tuple[Person, ...]
    balls: tuple[Thrown, ...]
    marks: tuple[tuple[float, str], ...]  # (time_s, kind) of the first person's events in MARKED


def film(simulation: Simulation, fps: float, title: str, advance: Callable[[], None] | None = None) -> Footage:
    """Runs a simulation from where it is to its end, and keeps what is to be seen `fps` times a second."""
    world, rows = simulation.world, simulation.world.assets.character_rows
    count = frame_count(simulation.ticks, fps)
    poses = [Pose(np.empty((count, 3)), np.empty((count, JOINT_COUNT, 4))) for _ in rows]
    phases, planted = np.empty((len(rows), count), np.int64), np.empty((len(rows), count, 2), bool)
    balls: dict[int, _Ball] = {}
    frames = frames_of(world, advance or simulation.step, simulation.ticks, fps)
    for frame, alpha in enumerate(with_progress(frames, "simulating", count)):
        for row, pose in zip(rows, poses, strict=True):
            pose.root_m[frame], pose.rotations[frame] = shown_pose(world, row, alpha)
        phases[:, frame], planted[:, frame] = world[Reaction].phase[list(rows)], world[Feet].planted[list(rows)]
        _look_at_balls(world, alpha, frame, count, balls)
    people = [
        Person(f"{Path(spec.clip).stem}_{k}", spec.sex, body_of(world, row), _continuous(pose), phases[k], planted[k])
        for k, (spec, row, pose) in enumerate(zip(simulation.scenario.character, rows, poses, strict=True))
    ]
    first = world.entity(rows[0])
    marks = tuple(
        (event.tick / TICK_RATE_HZ, event.kind)
        for event in world.events
        if event.kind in MARKED and event.entity == first
    )
    thrown = tuple(ball.whole() for ball in balls.values())
    return Footage(title, fps, np.arange(count) / fps, tuple(people), thrown, marks)


def _continuous(pose: Pose) -> Pose:
    return Pose(pose.root_m, rotations.continuity(rotations.normalise(pose.rotations)))


class _Ball:
    """A ball while it is being filmed."""

    def __init__(self, radius_m: float, mass_kg: float, count: int):
        self.radius_m, self.mass_kg = radius_m, mass_kg
        self.position_m, self.turned = np.zeros((count, 3)), np.zeros((count, 4))
        self.seen = np.zeros(count, bool)

    def whole(self) -> Thrown:
        """Held still at its ends over the frames in which it is not there."""
        there = np.flatnonzero(self.seen)
        nearest = there[np.searchsorted(there, np.arange(len(self.seen)), side="right").clip(1) - 1]
        turned = rotations.continuity(rotations.normalise(self.turned[nearest]))
        return Thrown(self.radius_m, self.mass_kg, self.position_m[nearest], turned, self.seen)


def _look_at_balls(world, alpha: float, frame: int, count: int, balls: dict[int, _Ball]) -> None:
    f = world[Flight]
    for row in world.rows(Flight):
        handle = world.entity(row)
        if handle not in balls:
            balls[handle] = _Ball(float(f.radius_m[row]), float(f.mass_kg[row]), count)
        ball = balls[handle]
        ball.position_m[frame] = (1.0 - alpha) * f.before_m[row] + alpha * f.position_m[row]
        ball.turned[frame] = rotations.slerp(f.before_turned[row], f.turned[row], alpha)
        ball.seen[frame] = True
