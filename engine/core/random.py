"""Named streams of chance. A draw is a function of the world's seed, the stream's name and how many were drawn before.

So the whole state of chance is one count per stream: it is saved, restored and hashed like everything else, and a new
stream never shifts an old one. The generator is Philox 4x64-10 (Salmon, Moraes, Dror, Shaw, "Parallel random numbers:
as easy as 1, 2, 3", SC 2011), written out here because NumPy promises no lasting bits for its distributions.
"""

from __future__ import annotations

import hashlib
import json
import math

from engine.core.reader import Reader, block

WORD = (1 << 64) - 1
MULTIPLIER_A, MULTIPLIER_B = 0xD2E7470EE14C6C93, 0xCA5A826395121157  # Salmon et al. 2011, table 2
WEYL_A, WEYL_B = 0x9E3779B97F4A7C15, 0xBB67AE8584CAA73B
ROUNDS = 10
WORDS_PER_BLOCK = 4


def philox(counter: int, key: tuple[int, int]) -> tuple[int, int, int, int]:
    """Four 64-bit words from a block number and a key."""
    a, b, c, d = counter & WORD, counter >> 64 & WORD, 0, 0
    key_a, key_b = key
    for _ in range(ROUNDS):
        left, right = a * MULTIPLIER_A, c * MULTIPLIER_B
        a, b, c, d = right >> 64 ^ b ^ key_a, right & WORD, left >> 64 ^ d ^ key_b, left & WORD
        key_a, key_b = key_a + WEYL_A & WORD, key_b + WEYL_B & WORD
    return a, b, c, d


class Stream:
    """One named stream. It remembers nothing: what was drawn is counted in the world."""

    __slots__ = ("_drawn", "_key", "_name")

    def __init__(self, seed: int, name: str, drawn: dict[str, int]):
        hashed = hashlib.sha256(f"{seed}/{name}".encode()).digest()
        self._name = name
        self._key = (int.from_bytes(hashed[:8], "little"), int.from_bytes(hashed[8:16], "little"))
        self._drawn = drawn

    def word(self) -> int:
        """64 even bits."""
        count = self._drawn.get(self._name, 0)
        self._drawn[self._name] = count + 1
        return philox(count // WORDS_PER_BLOCK, self._key)[count % WORDS_PER_BLOCK]

    def uniform(self, low: float = 0.0, high: float = 1.0) -> float:
        """In [low, high), on 2^53 steps."""
        return low + (high - low) * ((self.word() >> 11) * 2.0**-53)

    def normal(self, mean: float = 0.0, deviation: float = 1.0) -> float:
        """Box and Muller 1958, the cosine half: two words a draw, always."""
        radius = math.sqrt(-2.0 * math.log(((self.word() >> 11) + 1) * 2.0**-53))
        return mean + deviation * radius * math.cos(2.0 * math.pi * (self.word() >> 11) * 2.0**-53)

    def integers(self, low: int, high: int) -> int:
        """A whole number in [low, high), each equally likely. ValueError if there is none."""
        span = high - low
        if not 0 < span <= WORD:
            raise ValueError(f"no whole number in [{low}, {high})")
        fair = (WORD + 1) // span * span  # words from here on would favour the small numbers
        while (word := self.word()) >= fair:
            pass
        return low + word % span

    def choice(self, count: int) -> int:
        """A whole number in [0, count)."""
        return self.integers(0, count)


class Streams:
    """The streams of one world, and how many words each has given."""

    __slots__ = ("_drawn", "_open", "_seed")

    def __init__(self, seed: int):
        self._seed = seed
        self._drawn: dict[str, int] = {}
        self._open: dict[str, Stream] = {}

    def named(self, name: str) -> Stream:
        if name not in self._open:
            self._open[name] = Stream(self._seed, name, self._drawn)
        return self._open[name]

    def parts(self) -> list[bytes]:
        """Sorted by name: the order in which streams were first used is no state."""
        return [block(json.dumps(sorted(self._drawn.items())).encode())]

    def read(self, reader: Reader) -> None:
        """Become what `parts` said, under the streams that are already handed out."""
        counts = dict(json.loads(reader.block()))
        self._drawn.clear()
        self._drawn.update(counts)
