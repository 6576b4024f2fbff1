"""A cursor over the bytes of a saved state: each part of the world takes back, in order, what it put in."""

from __future__ import annotations

import numpy as np


class Reader:
    """Reads from the front. ValueError where the bytes end too early."""

    __slots__ = ("_at", "_bytes")

    def __init__(self, data: bytes):
        self._bytes = data
        self._at = 0

    def take(self, size: int) -> bytes:
        end = self._at + size
        if size < 0 or end > len(self._bytes):
            raise ValueError(f"{size} bytes wanted at {self._at} of {len(self._bytes)}")
        taken = self._bytes[self._at : end]
        self._at = end
        return taken

    def integer(self) -> int:
        """A signed 64-bit integer, little end first."""
        return int.from_bytes(self.take(8), "little", signed=True)

    def block(self) -> bytes:
        """Bytes that say their own length first: what `block` wrote."""
        return self.take(self.integer())

    def array(self, dtype: np.dtype | type, shape: tuple[int, ...]) -> np.ndarray:
        """A read-only array over the bytes themselves."""
        kind = np.dtype(dtype)
        size = kind.itemsize
        for length in shape:
            size *= length
        return np.frombuffer(self.take(size), kind).reshape(shape)

    def finish(self) -> None:
        """ValueError if anything is left unread."""
        if self._at != len(self._bytes):
            raise ValueError(f"{len(self._bytes) - self._at} bytes too many")


def integer(value: int) -> bytes:
    return value.to_bytes(8, "little", signed=True)


def block(data: bytes) -> bytes:
    return integer(len(data)) + data
