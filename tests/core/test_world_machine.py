"""Any sequence of spawning, adding, removing, dying, writing and going back agrees with a model made of plain dicts."""

from __future__ import annotations

import copy

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import Bundle, RuleBasedStateMachine, consumes, invariant, precondition, rule

from engine.core.world import World
from tests.core.toy_world import COMPONENTS, Flight, Marked, Wear

NUMBERS = st.floats(-1e6, 1e6)
KINDS = st.sampled_from([Flight, Wear, Marked])


def _component(kind, number):
    """One component of a kind whose fields are all decided by one number."""
    if kind is Flight:
        return Flight(position_m=(number, 0, 0), velocity_mps=(0, number, 0))
    return Wear(bounces=int(number), cracked=number > 0) if kind is Wear else Marked()


def _facts(component):
    return {name: getattr(component, name).tolist() for name in component.columns}


class WorldMachine(RuleBasedStateMachine):
    """`model` maps the handles of the living to {component class: {field: value}}."""

    handles = Bundle("handles")
    snapshots = Bundle("snapshots")

    def __init__(self):
        super().__init__()
        self.world = World(COMPONENTS, seed=3)
        self.model = {}

    @rule(target=handles, kinds=st.sets(KINDS), number=NUMBERS)
    def spawn(self, kinds, number):
        components = [_component(kind, number) for kind in COMPONENTS if kind in kinds]
        handle = self.world.spawn(*components)
        assert handle not in self.model
        self.model[handle] = {type(component): _facts(component) for component in components}
        return handle

    @rule(count=st.integers(15, 40))
    def crowd(self, count):
        """Enough at once to outgrow the columns."""
        for _ in range(count):
            self.model[self.world.spawn(Wear(bounces=count))] = {Wear: _facts(Wear(bounces=count))}

    @rule(handle=consumes(handles))
    def despawn(self, handle):
        assert self.world.alive(handle) == (handle in self.model)
        if handle in self.model:
            self.world.despawn(handle)
            del self.model[handle]

    @rule(handle=handles, kind=KINDS, number=NUMBERS)
    def add_or_remove(self, handle, kind, number):
        if handle not in self.model:
            return
        if kind in self.model[handle]:
            self.world.remove(handle, kind)
            del self.model[handle][kind]
        else:
            self.world.add(handle, _component(kind, number))
            self.model[handle][kind] = _facts(_component(kind, number))

    @rule(number=NUMBERS)
    @precondition(lambda self: self.model)
    def write_a_whole_column(self, number):
        """Rows that nobody owns are written too: they must not matter."""
        self.world[Flight].position_m[:, 2] = number
        for owned in self.model.values():
            if Flight in owned:
                owned[Flight]["position_m"][2] = number

    @rule(target=snapshots)
    def snapshot(self):
        return self.world.snapshot(), copy.deepcopy(self.model)

    @rule(kept=snapshots)
    def restore(self, kept):
        snapshot, model = kept
        self.world.restore(snapshot)
        self.model = copy.deepcopy(model)
        assert self.world.digest() == snapshot.digest

    def is_the_model(self, world):
        assert len(world) == len(self.model)
        rows = sorted(handle & 0xFFFFFFFF for handle in self.model)
        assert world.rows().tolist() == rows
        for handle, owned in self.model.items():
            row = world.row(handle)
            for kind in COMPONENTS:
                assert world.has(handle, kind) == (kind in owned)
            for kind, facts in owned.items():
                assert {name: getattr(world[kind], name)[row].tolist() for name in facts} == facts

    @invariant()
    def the_world_is_the_model(self):
        self.is_the_model(self.world)

    @invariant()
    def queries_agree(self):
        for kind in COMPONENTS:
            owners = sorted(handle & 0xFFFFFFFF for handle, owned in self.model.items() if kind in owned)
            assert self.world.rows(kind).tolist() == owners
            assert np.flatnonzero(self.world[kind].present).tolist() == owners

    @invariant()
    def the_digest_is_of_the_state_alone(self):
        """A world with none of this history, given this state, hashes the same and packs the same bytes."""
        fresh = World(COMPONENTS, seed=3)
        fresh.restore(self.world.snapshot())
        self.is_the_model(fresh)
        assert fresh.snapshot() == self.world.snapshot()


TestWorldMachine = WorldMachine.TestCase
TestWorldMachine.settings = settings(max_examples=60, stateful_step_count=30, deadline=None)
