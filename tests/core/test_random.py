"""Chance: the same bits as NumPy's Philox, even, independent by name, and rewound with the world."""

from __future__ import annotations

import hashlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from engine.core.random import WORD, philox
from engine.core.world import World

WORDS = st.integers(0, WORD)


@given(st.integers(0, (1 << 128) - 3), WORDS, WORDS)
def test_the_generator_is_philox(counter, key_low, key_high):
    """NumPy counts up before each block, hence the one."""
    oracle = np.random.Philox(counter=counter, key=key_low | key_high << 64)
    assert philox(counter + 1, (key_low, key_high)) == tuple(oracle.random_raw(4).tolist())


def test_a_stream_is_the_words_of_its_key_in_order():
    key = int.from_bytes(hashlib.sha256(b"7/wind").digest()[:16], "little")
    oracle = np.random.Philox(counter=(1 << 256) - 1, key=key)
    stream = World((), seed=7).random("wind")
    assert [stream.word() for _ in range(10)] == oracle.random_raw(10).tolist()


def test_streams_differ_by_name_and_seed_and_do_not_shift_one_another():
    world = World((), seed=1)
    alone = [World((), seed=1).random("a").uniform() for _ in range(1)]
    world.random("b").uniform()
    assert [world.random("a").uniform()] == alone
    assert world.random("a").uniform() != alone[0]
    assert World((), seed=1).random("b").uniform() != alone[0]
    assert World((), seed=2).random("a").uniform() != alone[0]


def test_going_back_draws_the_same_again_even_from_a_stream_held_on_to():
    world = World((), seed=1)
    stream = world.random("a")
    stream.uniform()
    before = world.snapshot()
    first = [stream.uniform(), stream.normal(), stream.integers(0, 10), world.random("new").word()]
    world.restore(before)
    assert [stream.uniform(), stream.normal(), stream.integers(0, 10), world.random("new").word()] == first


def test_the_distributions_are_what_they_say():
    """Kolmogorov-Smirnov and chi-squared, on fixed seeds: a wrong shape fails by many orders of magnitude."""
    world = World((), seed=11)
    uniform = [world.random("u").uniform(-2.0, 3.0) for _ in range(4000)]
    normal = [world.random("n").normal(1.0, 0.5) for _ in range(4000)]
    whole = [world.random("i").integers(-3, 4) for _ in range(7000)]
    assert stats.kstest(uniform, stats.uniform(-2.0, 5.0).cdf).pvalue > 0.01
    assert stats.kstest(normal, stats.norm(1.0, 0.5).cdf).pvalue > 0.01
    assert sorted(set(whole)) == list(range(-3, 4))
    assert stats.chisquare(np.bincount(np.array(whole) + 3)).pvalue > 0.01


def test_bounds_are_kept():
    stream = World(()).random("a")
    assert stream.integers(5, 6) == 5
    assert 0 <= stream.integers(0, WORD) < WORD
    assert stream.choice(1) == 0
    for low, high in ((3, 3), (3, 2), (0, 1 << 65)):
        with pytest.raises(ValueError, match="no whole number in"):
            stream.integers(low, high)
