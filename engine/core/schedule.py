"""The order of a tick. A system is a function of the world that declares when it runs, what it reads and writes."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import IntEnum
from typing import TYPE_CHECKING, Any, NamedTuple

from engine.core.checked import run_checked

if TYPE_CHECKING:
    from engine.core.component import Component
    from engine.core.world import World

System = Callable[["World", int], Any]


class Stage(IntEnum):
    """The parts of a tick, in order."""

    SENSE = 0  # threats fly; who is about to be hit, where, when
    DECIDE = 1  # what everybody is doing about it
    ANIMATE = 2  # clips and blends give the pose
    SIMULATE = 3  # contacts, and the bodies that were struck
    SETTLE = 4  # balance, footing, the account of it all


class Declaration(NamedTuple):
    """What a system says of itself. What it writes it may also read; despawning writes all that the entity has."""

    stage: Stage
    reads: frozenset[type[Component]]
    writes: frozenset[type[Component]]


def system(
    stage: Stage, reads: Iterable[type[Component]] = (), writes: Iterable[type[Component]] = ()
) -> Callable[[System], System]:
    """Declare a function `f(world, tick)` a system. The function itself stays as it is."""
    declaration = Declaration(Stage(stage), frozenset(reads), frozenset(writes))

    def declare(function: System) -> System:
        function.declaration = declaration  # type: ignore[attr-defined]
        return function

    return declare


def declaration_of(function: System) -> Declaration:
    """What `@system` attached. TypeError where it was forgotten."""
    found = getattr(function, "declaration", None)
    if found is None:
        name = getattr(function, "__name__", repr(function))
        raise TypeError(f"{name} is no system: decorate it with @system(Stage...., reads=(...), writes=(...))")
    return found


class Schedule:
    """Systems in the order in which they run: by stage, and within a stage as listed.

    `checked` holds every system to its declaration and to finite numbers, at several times the cost: for tests.
    """

    def __init__(self, systems: Iterable[System], checked: bool = False):
        self.systems = tuple(sorted(systems, key=lambda function: declaration_of(function).stage))
        self.checked = checked

    def tick(self, world: World) -> None:
        """One tick of the world: every system once, then the next tick begins."""
        for function in self.systems:
            if self.checked:
                run_checked(function, declaration_of(function), world)
            else:
                function(world, world.tick)
        world.tick += 1
