"""Compiled kernels on disk, written by one process at a time."""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Iterator

from numba.core.caching import FunctionCache


class KernelCache(FunctionCache):
    """Numba's own, except that processes wait for each other where they add to it.

    Numba numbers the files of a function's versions by an index that it reads and then writes: of two processes that
    compile two versions at once, both may take one number, and one version would later be run for the other.
    """

    def save_overload(self, sig, data):
        with _alone_in(self.cache_path):
            super().save_overload(sig, data)


@contextlib.contextmanager
def _alone_in(folder: str) -> Iterator[None]:
    """Holds a folder; released however the process ends."""
    os.makedirs(folder, exist_ok=True)
    handle = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield
    finally:
        os.close(handle)
