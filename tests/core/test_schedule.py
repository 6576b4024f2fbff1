"""The order of a tick, and that a checked schedule holds every system to what it declared."""

from __future__ import annotations

import numpy as np
import pytest

from engine.core.checked import NonFinite, UndeclaredWrite
from engine.core.schedule import Schedule, Stage, declaration_of, system
from engine.core.world import UndeclaredAccess, World
from tests.core.toy_world import COMPONENTS, SYSTEMS, Flight, Marked, Wear, toy


def test_systems_run_by_stage_and_then_as_listed():
    ran = []

    def noting(stage, name):
        @system(stage)
        def note(world, tick):
            ran.append((name, tick))

        return note

    listed = [(Stage.SETTLE, "e"), (Stage.DECIDE, "b"), (Stage.SENSE, "a"), (Stage.DECIDE, "c"), (Stage.ANIMATE, "d")]
    schedule = Schedule([noting(stage, name) for stage, name in listed])
    world = World(())
    schedule.tick(world)
    schedule.tick(world)
    assert ran == [(name, 0) for name in "abcde"] + [(name, 1) for name in "abcde"]
    assert world.tick == 2


def test_a_system_stays_the_function_that_it_was():
    def look(world, tick):
        """Look."""

    declared = system(Stage.SENSE, reads=(Flight,), writes=[Wear])(look)
    assert declared is look
    assert declaration_of(look) == (Stage.SENSE, frozenset({Flight}), frozenset({Wear}))


def test_a_function_without_a_declaration_is_refused():
    def forgetful(world, tick):
        pass

    with pytest.raises(TypeError, match="forgetful is no system: decorate it with @system"):
        Schedule([forgetful])


def test_checked_and_unchecked_runs_have_the_same_bits():
    (world, step), (watched, step_watched) = toy(), toy(checked=True)
    for _ in range(200):
        step(world)
        step_watched(watched)
        assert world.digest() == watched.digest()
    assert sum(event.kind == "gone" for event in world.events) == 3
    assert len(world) == 0


def _one_system(action, reads=(), writes=()):
    """A world of toy balls, the first of them marked, and a checked schedule of one system that does this."""

    @system(Stage.DECIDE, reads=reads, writes=writes)
    def act(world, tick):
        action(world)

    world, _ = toy()
    world.add(world.entity(0), Marked())
    return world, Schedule([act], checked=True)


@pytest.mark.parametrize(
    ("action", "missing"),
    [
        (lambda world: world[Wear], "Wear .* reads"),
        (lambda world: world.rows(Flight, Wear), "Wear .* reads"),
        (lambda world: world.rows(Flight, without=(Wear,)), "Wear .* reads"),
        (lambda world: world.has(world.entity(0), Wear), "Wear .* reads"),
        (lambda world: world.spawn(Wear()), "Wear .* writes"),
        (lambda world: world.remove(world.entity(0), Marked), "Marked .* writes"),
        (lambda world: world.add(world.entity(1), Marked()), "Marked .* writes"),
        (lambda world: world.despawn(world.entity(0)), "(Wear|Marked) .* writes"),
    ],
)
def test_what_was_not_declared_is_refused(action, missing):
    world, schedule = _one_system(action, reads=(Marked,), writes=(Flight,))
    before = world.digest()
    with pytest.raises(UndeclaredAccess, match=missing):
        schedule.tick(world)
    assert world.digest() == before
    world[Wear]  # outside of systems all is open again


def test_a_query_that_another_system_made_before_is_refused_too():
    world, schedule = _one_system(lambda world: world.rows(Wear), reads=(Flight,))
    world.rows(Wear)
    with pytest.raises(UndeclaredAccess, match="Wear"):
        schedule.tick(world)


def test_a_write_to_what_is_only_read_is_found():
    def touch(world):
        world[Flight].velocity_mps[1, 2] = -0.0

    world, schedule = _one_system(touch, reads=(Flight,))
    with pytest.raises(UndeclaredWrite, match="act changed Flight at tick 0, which it declares only to read"):
        schedule.tick(world)
    world, schedule = _one_system(touch, reads=(Flight,), writes=(Flight,))
    schedule.tick(world)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_a_number_that_is_none_is_named_by_its_place(value):
    def spoil(world):
        world[Flight].velocity_mps[2, 1] = value

    world, schedule = _one_system(spoil, writes=(Wear, Flight))
    world.tick = 41
    with pytest.raises(NonFinite, match=r"Flight\.velocity_mps of row 2 is not finite after act at tick 41") as caught:
        schedule.tick(world)
    place = caught.value
    assert (place.component, place.field, place.row) == ("Flight", "velocity_mps", 2)
    assert (place.system, place.tick) == ("act", 41)


def test_a_row_of_nobody_may_hold_anything():
    def spoil(world):
        world[Flight].velocity_mps[9] = np.nan

    world, schedule = _one_system(spoil, writes=(Flight,))
    schedule.tick(world)


def test_every_toy_system_says_the_truth():
    for function in SYSTEMS:
        assert declaration_of(function).writes <= set(COMPONENTS)
