"""What was to be seen at every tick of a run, kept beside the world: for the timeline, the plots and the limb forces.

An entry is of the state after a tick, under the number of ticks that have passed: that of `world.tick` is the last.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from behaviours.components import Character, Phase, Posture, Ragdoll, Reaction
from behaviours.playing import body_of
from demos.stage import standing
from engine.body.kinematics import centre_of_mass, joints_of
from engine.body.skeleton import HEAD, Pose
from engine.body.support import margin_m, polygon_of
from engine.core.clock import TICK_RATE_HZ
from engine.maths import rotations

GRAVITY_MPS2 = 9.80665
PHYSICS_HZ = 480.0
MARKED = ("perceived", "contact", "touch", "missed", "flinched")  # events that the timeline shows


class Mark(NamedTuple):
    """An event of a character, at its tick."""

    tick: int
    kind: str
    row: int
    data: dict[str, Any]


class Span(NamedTuple):
    """A phase, from its first tick to its last."""

    phase: Phase
    first: int
    last: int


@dataclass
class Past:
    """One character's. Lists have one entry a tick."""

    spans: list[Span] = field(default_factory=list)
    margin_m: list[float] = field(default_factory=list)  # of the COM inside the support polygon; nan in the air
    head_g: list[float] = field(default_factory=list)  # the head's acceleration, its greatest within the tick
    head_mps: list[np.ndarray] = field(default_factory=list)  # at the end of a tick of physics; empty elsewhere
    parts_m: list[np.ndarray] = field(default_factory=list)  # (P, 3) float32, centres of the body's parts


class History:
    """Fills up as a run goes on; forgets what another future replaces."""

    def __init__(self, world) -> None:
        self.first_tick = world.tick
        self.pasts = {int(row): Past() for row in world.rows(Character)}
        self.marks: list[Mark] = []
        self._events = len(world.events)
        self.note(world)

    @property
    def last_tick(self) -> int:
        return self.first_tick + len(next(iter(self.pasts.values())).margin_m) - 1

    def note(self, world) -> None:
        """After each tick. A tick that is known already is only played again."""
        if world.tick <= self.last_tick:
            return
        for row, past in self.pasts.items():
            _note(world, row, past)
        rows = {world.entity(row): row for row in self.pasts}
        for event in world.events[self._events :]:
            if event.kind in MARKED and event.entity in rows:
                self.marks.append(Mark(event.tick + 1, event.kind, rows[event.entity], event.data))
        self._events = len(world.events)

    def forget_after(self, world) -> None:
        """Everything after the world's tick: it will be otherwise."""
        count = world.tick - self.first_tick + 1
        for past in self.pasts.values():
            for kept in (past.margin_m, past.head_g, past.head_mps, past.parts_m):
                del kept[count:]
            past.spans = [
                span._replace(last=min(span.last, world.tick)) for span in past.spans if span.first <= world.tick
            ]
        self.marks = [mark for mark in self.marks if mark.tick <= world.tick]
        self._events = len(world.events)

    def window(self, values: list[float], last: int, ticks: int) -> np.ndarray:
        """The entries of the last so many ticks up to `last`, fewer at the beginning."""
        end = last - self.first_tick + 1
        return np.array(values[max(0, end - ticks) : end], float)

    def forces_N(self, row: int, tick: int, masses_kg: np.ndarray) -> np.ndarray | None:
        """(P, 3) what acts on each part of a body beside its weight, m (a - g); None in the first two ticks.

        Newton's second law on the centres of the parts at three ticks.
        """
        at = tick - self.first_tick
        parts = self.pasts[row].parts_m
        if at < 2 or at >= len(parts):
            return None
        before, middle, now = (parts[at - k].astype(float) for k in (2, 1, 0))
        acceleration = (now - 2.0 * middle + before) * TICK_RATE_HZ**2
        return masses_kg[:, None] * (acceleration + (0.0, 0.0, GRAVITY_MPS2))


def _note(world, row: int, past: Past) -> None:
    p, phase, tick = world[Posture], Phase(int(world[Reaction].phase[row])), world.tick
    if past.spans and past.spans[-1].phase == phase:
        past.spans[-1] = past.spans[-1]._replace(last=tick)
    else:
        past.spans.append(Span(phase, tick, tick))
    body = body_of(world, row)
    positions, orientations = joints_of(body, Pose(p.root_m[row], p.rotations[row]))
    turned = rotations.rotate(orientations[body.part_joint], body.part_com_m)
    past.parts_m.append((positions[body.part_joint] + turned).astype(np.float32))
    polygon = polygon_of(body, positions, orientations, standing(world, row, body, positions, orientations))
    com = centre_of_mass(body, positions, orientations)
    past.margin_m.append(float(margin_m(polygon, com)) if len(polygon) else float("nan"))
    past.head_g.append(_head_g(world, row, past, int(np.flatnonzero(body.part_joint == HEAD)[0])))


def _head_g(world, row: int, past: Past, head: int) -> float:
    """From the physics' own steps where it is under way, else from three ticks. Without gravity, in g."""
    before = past.head_mps[-1:] if past.head_mps and len(past.head_mps[-1]) else []
    past.head_mps.append(np.empty(0))
    if world[Ragdoll].active[row]:
        steps = np.array([*before, *world[Ragdoll].head_mps[row]])
        past.head_mps[-1] = steps[-1]
        return float(np.linalg.norm(np.diff(steps, axis=0), axis=1).max()) * PHYSICS_HZ / GRAVITY_MPS2
    if len(past.parts_m) < 3:
        return 0.0
    first, middle, last = (past.parts_m[k][head].astype(float) for k in (-3, -2, -1))
    return float(np.linalg.norm(last - 2.0 * middle + first)) * TICK_RATE_HZ**2 / GRAVITY_MPS2
