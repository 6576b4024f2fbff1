"""Compiled kernels on disk, written by one process at a time."""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Iterator

from numba.core.caching import FunctionCache


class KernelCache(FunctionCache):
    """Numba's own, except that processes wait for each other where they add to it, and that types may move.

    Numba numbers the files of a function's versions by an index that it reads and then writes: of two processes that
    compile two versions at once, both may take one number, and one version would later be run for the other.

    The index also names the types of all versions. Where one of them has been moved or renamed since, though the
    function was not touched, Numba fails to read it; here the function is compiled anew.
    """

    def load_overload(self, sig, target_context):
        try:
            return super().load_overload(sig, target_context)
        except (ImportError, AttributeError):
            with _alone_in(self.cache_path):
                self.flush()
            return None

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
