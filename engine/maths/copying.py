"""Copying in kernels."""

from __future__ import annotations

from engine.maths.kernel import njit


@njit(cache=True)
def copy_into(target, source):
    """Writes one array (n,) into another of the same length.

    In a kernel `target[:] = source` brings along, for the message that a wrong length would get, all of Numba's text
    handling: thousands of lines compiled again in every kernel that calls it, however indirectly.
    """
    for i in range(len(target)):
        target[i] = source[i]
