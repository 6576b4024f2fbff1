"""Going back and forth in a run: to any tick that was ever reached, by a keyframe and simulating on from there."""

from __future__ import annotations

from engine.core.journal import Command, Journal
from engine.core.keyframes import Keyframes
from engine.core.recorder import Apply, Recorder, Step
from engine.core.world import World

KEYFRAME_TICKS = 30
MEMORY_BYTES = 64 << 20


class Timeline(Recorder):
    """A recorder that can be rewound. After going back, `advance` replays what is recorded until its end; a command
    given in the past starts another future there."""

    def __init__(
        self,
        world: World,
        step: Step,
        apply: Apply,
        journal: Journal,
        keyframe_ticks: int = KEYFRAME_TICKS,
        memory_bytes: int = MEMORY_BYTES,
    ):
        super().__init__(world, step, apply, journal)
        self.keyframes = Keyframes(world.snapshot(), keyframe_ticks, memory_bytes)

    @property
    def first_tick(self) -> int:
        return self.keyframes.first_tick

    @property
    def last_tick(self) -> int:
        """The furthest tick of this future."""
        return self.journal.last_tick

    def command(self, command: Command) -> None:
        super().command(command)
        self.keyframes.forget_after(self.world.tick)

    def advance(self) -> None:
        super().advance()
        if self.keyframes.wants(self.world.tick):
            self.keyframes.keep(self.world.snapshot())

    def seek(self, tick: int) -> None:
        """Be at this tick of the recording, or at the nearer end of it. ReplayDiverged if the way there differs."""
        tick = min(max(tick, self.first_tick), self.last_tick)
        keyframe = self.keyframes.latest_until(tick)
        if not keyframe.tick <= self.world.tick <= tick:
            self.world.restore(keyframe)
        while self.world.tick < tick:
            self.advance()

    def step_back(self, ticks: int = 1) -> None:
        self.seek(self.world.tick - ticks)
