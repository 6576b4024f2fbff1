"""Entities, columns and queries; and that the digest sees all state and nothing else."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from engine.core.journal_file import FORMAT
from engine.core.rows import DeadEntity
from engine.core.snapshot import Snapshot
from engine.core.world import Component, UndeclaredAccess, World, column
from tests.core.toy_world import COMPONENTS, Flight, Marked, Wear, toy


@pytest.fixture
def world():
    return World(COMPONENTS, seed=7)


def test_an_entity_is_a_row_with_a_generation(world):
    first = world.spawn(Flight(position_m=(1, 2, 3)), Wear(bounces=4))
    second = world.spawn(Wear())
    assert (world.row(first), world.row(second)) == (0, 1)
    assert first == 1 << 32
    assert world[Flight].position_m[world.row(first)].tolist() == [1, 2, 3]
    assert world.has(first, Flight)
    assert not world.has(second, Flight)
    assert world.entity(1) == second
    assert len(world) == 2


def test_a_handle_never_means_the_next_tenant_of_its_row(world):
    old = world.spawn(Wear())
    world.despawn(old)
    new = world.spawn(Wear())
    assert world.row(new) == 0
    assert new != old
    assert world.alive(new)
    assert not world.alive(old)
    with pytest.raises(DeadEntity, match=r"row 0, generation 1\) is not in the world"):
        world.row(old)


@pytest.mark.parametrize("nobody", [0, -1, 5, 9 << 32, 1 << 32 | 77])
def test_nobody_is_not_alive(world, nobody):
    world.spawn(Wear())
    assert not world.alive(nobody)
    with pytest.raises(DeadEntity):
        world.despawn(nobody)


def test_an_empty_row_has_no_entity(world):
    for row in (0, -1, 16, 99):
        with pytest.raises(DeadEntity):
            world.entity(row)


def test_the_lowest_free_row_is_used_first(world):
    handles = [world.spawn(Wear()) for _ in range(5)]
    for gone in (handles[3], handles[1]):
        world.despawn(gone)
    assert [world.row(world.spawn(Wear())) for _ in range(3)] == [1, 3, 5]


def test_queries_are_ascending_rows_that_have_all_and_none_of_those_without(world):
    world.spawn(Wear())
    both = world.spawn(Flight(), Wear())
    world.spawn(Flight(), Wear(), Marked())
    assert world.rows(Flight).tolist() == [1, 2]
    assert world.rows(Wear, Flight).tolist() == [1, 2]
    assert world.rows(Flight, without=(Marked,)).tolist() == [1]
    assert world.rows().tolist() == [0, 1, 2]
    assert world.rows(Flight).dtype == np.int64
    world.remove(both, Flight)
    assert world.rows(Flight).tolist() == [2]
    world.add(both, Marked())
    assert world.rows(Marked).tolist() == [1, 2]


def test_a_query_is_the_callers_own(world):
    world.spawn(Flight())
    world.rows(Flight)[:] = 99
    assert world.rows(Flight).tolist() == [0]


def test_growth_keeps_every_value_and_the_view(world):
    view = world[Flight]
    handles = [world.spawn(Flight(position_m=(number, 0, 0))) for number in range(100)]
    assert world[Flight] is view
    assert view.position_m[world.rows(Flight), 0].tolist() == list(range(100))
    assert view.present.sum() == 100
    assert all(world.alive(handle) for handle in handles)


def test_a_component_comes_and_goes_clean(world):
    entity = world.spawn(Flight(position_m=(1, 2, 3)))
    world.remove(entity, Flight)
    world.add(entity, Flight(velocity_mps=(4, 5, 6)))
    assert world[Flight].position_m[0].tolist() == [0, 0, 0]
    with pytest.raises(ValueError, match="row 0 already has Flight"):
        world.add(entity, Flight())
    with pytest.raises(ValueError, match="row 0 has no Wear"):
        world.remove(entity, Wear)


def test_rows_without_a_component_hold_its_fill(world):
    """A kernel that looks where nobody is must see the same before and after going back."""
    entity = world.spawn(Flight(position_m=(1, 2, 3)))
    before = world.snapshot()
    world.remove(entity, Flight)
    assert not world[Flight].position_m.any()
    world[Flight].position_m[:] = 9.0
    world.restore(before)
    assert world[Flight].position_m.tolist() == [[1, 2, 3]] + [[0, 0, 0]] * 15


def test_columns_are_written_into_and_not_replaced(world):
    world.spawn(Flight())
    world[Flight].velocity_mps += 1.0
    assert world[Flight].velocity_mps[0].tolist() == [1, 1, 1]
    with pytest.raises(AttributeError, match="write into the column"):
        world[Flight].velocity_mps = np.zeros((16, 3))
    with pytest.raises(ValueError, match="read-only"):
        world[Flight].present[0] = False


def test_what_cannot_be_is_refused(world):
    class Stranger(Component):
        fact = column()

    with pytest.raises(UndeclaredAccess, match="Stranger is no component of this world"):
        world.spawn(Stranger())
    with pytest.raises(UndeclaredAccess, match="Stranger"):
        world[Stranger]
    with pytest.raises(ValueError, match="at most one component of a kind"):
        world.spawn(Wear(), Wear())
    with pytest.raises(ValueError, match="two components of one name"):
        World((Wear, Flight, Wear))
    with pytest.raises(AttributeError):
        world.secret = 1  # all state is columns
    assert len(world) == 0


# --- the digest ------------------------------------------------------------------------------------------------------


def _changes():
    """Every kind of state there is, each by the smallest change to it."""
    return {
        "a bit of a float": lambda world: world[Flight].position_m.__setitem__((0, 0), 5e-324),
        "the sign of zero": lambda world: world[Flight].position_m.__setitem__((0, 0), -0.0),
        "a truth": lambda world: world[Wear].cracked.__setitem__(2, True),
        "a count": lambda world: world[Wear].bounces.__setitem__(1, 1),
        "a tick": lambda world: setattr(world, "tick", 1),
        "a draw": lambda world: world.random("wind").word(),
        "an event": lambda world: world.emit("clap"),
        "a component": lambda world: world.add(world.entity(0), Marked()),
        "a newcomer": lambda world: world.spawn(),
        "a death": lambda world: world.despawn(world.entity(1)),
        "a new tenant": lambda world: (world.despawn(world.entity(2)), world.spawn(*_third_ball())),
    }


def _third_ball():
    return Flight(position_m=(0.0, 2, 0.2 + 0.1 * 2)), Wear()


def test_the_digest_sees_every_kind_of_state():
    digests = [toy()[0].digest()]
    for change in _changes().values():
        world, _ = toy()
        change(world)
        digests.append(world.digest())
    assert len(set(digests)) == len(_changes()) + 1


@pytest.mark.parametrize("change", list(_changes()))
def test_going_back_undoes_every_kind_of_change(change):
    world, _ = toy()
    world.emit("start", world.entity(0), speed_mps=3.0)
    before, handles = world.snapshot(), [world.entity(row) for row in range(3)]
    _changes()[change](world)
    world.restore(before)
    assert world.snapshot() == before
    assert world.digest() == before.digest
    assert [world.entity(row) for row in range(3)] == handles


def test_the_digest_does_not_see_capacity_or_what_nobody_owns():
    small, _ = toy()
    large, _ = toy()
    before = large.snapshot()
    for _ in range(200):
        large.spawn(Flight(position_m=(9, 9, 9)))
    large.restore(before)
    assert large.digest() == small.digest()
    large[Flight].position_m[50] = 3.0  # a row of nobody
    small[Marked]
    assert large.digest() == small.digest()


@pytest.mark.parametrize("gone", [0, 1, 2])
def test_a_gap_in_the_rows_is_hashed_as_its_present_rows(gone):
    """Neighbouring rows are hashed where they lie, others are gathered: both must see each write, and no dead row."""
    world, _ = toy()
    world.remove(world.entity(gone), Flight)
    before = world.digest()
    world[Flight].position_m[gone] = 5.0
    assert world.digest() == before
    for row in {0, 1, 2} - {gone}:
        world[Flight].position_m[row, 1] += 1.0
        assert world.digest() != before
        world[Flight].position_m[row, 1] -= 1.0
        assert world.digest() == before


def test_growth_for_some_leaves_no_component_hashed_where_it_was():
    world, _ = toy()
    world.digest()
    for _ in range(100):
        world.spawn(Marked())
    before = world.digest()
    world[Flight].position_m[1, 1] += 1.0
    assert world.digest() != before


def test_the_digest_does_not_see_the_order_in_which_streams_were_opened():
    one, two = World(COMPONENTS), World(COMPONENTS)
    for world, names in ((one, ("wind", "crowd")), (two, ("crowd", "wind"))):
        for name in names:
            world.random(name).word()
    one.random("never drawn from")
    assert one.digest() == two.digest()


def test_the_digest_sees_components_and_seed():
    assert World(COMPONENTS, seed=1).digest() != World(COMPONENTS, seed=2).digest()
    assert World(COMPONENTS).digest() != World(COMPONENTS[::-1]).digest()


# --- snapshots -------------------------------------------------------------------------------------------------------


def test_a_snapshot_lives_by_itself():
    world, step = toy()
    before = world.snapshot()
    digest = before.digest
    for _ in range(50):
        step(world)
    assert before.digest == digest != world.digest()
    assert before.tick == 0


def test_a_snapshot_restores_a_world_that_never_saw_that_state():
    world, step = toy()
    for _ in range(30):
        step(world)
    other = World(COMPONENTS, seed=7)
    other.restore(world.snapshot())
    assert other.digest() == world.digest()
    for _ in range(30):
        step(world)
        step(other)
    assert other.digest() == world.digest()
    assert list(other.events) == list(world.events)


def test_a_larger_snapshot_makes_a_smaller_world_grow():
    world = World(COMPONENTS)
    for number in range(77):
        world.spawn(Flight(position_m=(number, 0, 0)))
    other = World(COMPONENTS)
    other.restore(world.snapshot())
    assert other.digest() == world.digest()
    assert other.row(other.spawn(Flight())) == 77
    assert other[Flight].position_m[:78, 0].tolist() == [*range(77), 0]


def test_a_snapshot_goes_through_bytes():
    world, step = toy()
    for _ in range(60):
        step(world)
    assert len(world.events)
    snapshot = world.snapshot()
    again = Snapshot.from_bytes(snapshot.to_bytes())
    assert again == snapshot
    assert again.digest == world.digest()


def test_bytes_that_are_no_snapshot_are_refused():
    world, step = toy()
    for _ in range(60):
        step(world)
    good = world.snapshot().to_bytes()
    for bad in (b"", good[:-1], good[:7], good + b"x", good.replace(b"bounced", b"Bounced", 1)):
        with pytest.raises(ValueError):
            Snapshot.from_bytes(bad)


def test_a_snapshot_of_another_kind_of_world_changes_nothing():
    world, _ = toy()
    digest = world.digest()
    for stranger in (World(COMPONENTS[:2], seed=7), World(COMPONENTS, seed=8)):
        with pytest.raises(ValueError, match="the snapshot was taken"):
            world.restore(stranger.snapshot())
        assert world.digest() == digest


# --- the same bits everywhere ----------------------------------------------------------------------------------------

PRINT_DIGEST = """
from tests.core.toy_world import toy
world, step = toy()
for _ in range(200):
    step(world)
print(world.digest())
"""


def test_another_process_with_other_hashing_gives_the_same_bits():
    """Sets and dictionaries keyed by classes and text are ordered otherwise in each of these processes."""
    root = Path(__file__).resolve().parents[2]
    world, step = toy()
    for _ in range(200):
        step(world)
    for hash_seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": hash_seed, "PYTHONPATH": str(root)}
        ran = subprocess.run(
            [sys.executable, "-c", PRINT_DIGEST], cwd=root, env=environment, capture_output=True, text=True, check=True
        )
        assert ran.stdout.strip() == world.digest()


def test_the_layout_of_the_state_is_what_recordings_were_made_with():
    """If this changes, recordings made before no longer replay: raise `FORMAT` in `journal_file` along with it."""
    world = World((Flight, Wear), seed=7)
    for number in range(3):
        world.spawn(Flight(position_m=(number, 0.1, -0.0)), Wear(bounces=number))
    world.despawn(world.entity(1))
    world.emit("clap", world.entity(2), height_m=0.1)
    world.random("wind").word()
    world.tick = 5
    assert FORMAT == 1
    assert world.digest() == "d9017c3f39a23177b5f4604969d2c892"
