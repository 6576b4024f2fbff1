"""Running a world under its journal: the one way in which commands reach a world and ticks pass, live or replayed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from engine.core.errors import BadInput
from engine.core.journal import Command, Journal, made_with, plain_json
from engine.core.world import World

Step = Callable[[World], Any]  # one tick: `schedule.tick`
Apply = Callable[[World, Command], Any]  # what a command does to a world


class Recorder:
    """Records while the journal is open at its end; replays and compares where the journal already knows the tick.

    So a recording is `Recorder(world, step, apply, new_journal(header, world))`, a replay the same with a loaded one.
    """

    def __init__(self, world: World, step: Step, apply: Apply, journal: Journal):
        self.world = world
        self.journal = journal
        self._step = step
        self._apply = apply
        journal.witness(world.tick, world.digest())

    def command(self, command: Command) -> None:
        """Give the world a command; the next `advance` begins with it. Ticks recorded after now are lost."""
        self.journal.command(self.world.tick, command)

    def advance(self) -> None:
        """One tick: its commands, then all systems. ReplayDiverged where the journal remembers it otherwise."""
        for command in self.journal.commands_at(self.world.tick):
            self._apply(self.world, command)
        self._step(self.world)
        self.journal.witness(self.world.tick, self.world.digest())

    @property
    def at_end(self) -> bool:
        """Whether the next `advance` is news and not a replay."""
        return self.world.tick >= self.journal.last_tick


def new_journal(header: dict[str, Any], world: World) -> Journal:
    """An empty journal that begins now. In mid-run it keeps the state itself, which no header could rebuild."""
    known = {"made_with": made_with(), **plain_json(header)}
    return Journal(known, world.tick, world.snapshot() if world.tick else None)


def replay(world: World, step: Step, apply: Apply, journal: Journal) -> Recorder:
    """Ready to go through a recording, from its own start if it has one. The world is freshly built from the header.

    BadInput where the kept start belongs to another kind of world; ReplayDiverged where the world already differs.
    """
    if journal.start is not None:
        try:
            world.restore(journal.start)
        except (ValueError, IndexError) as trouble:
            raise BadInput("recording", f"the recording does not fit: {trouble}") from trouble
    return Recorder(world, step, apply, journal)
