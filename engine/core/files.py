"""Whole files or none: written under another name beside the target, renamed when complete."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from engine.core.errors import BadInput, EnvironmentTrouble

_NO_ROOM = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the disk quota is used up",
    errno.EFBIG: "the file may not grow further",
}


def write_atomically(path: str | os.PathLike, data: bytes) -> None:
    """Puts these bytes under this name; see `whole_file`."""
    with whole_file(path) as part:
        part.write_bytes(data)


@contextmanager
def whole_file(path: str | os.PathLike) -> Iterator[Path]:
    """Yields a temporary path with the target's suffix; renames it on success, removes it on any failure.

    BadInput where the target is not a plain file; EnvironmentTrouble where the disk is full or forbids writing.
    """
    target = check_output(path)
    # symlinks stay: what they point to is replaced
    target = target.resolve()
    part = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix}")
    with disk_trouble(target):
        try:
            part.touch()
            yield part
            _to_disk(part)
            os.replace(part, target)
        finally:
            part.unlink(missing_ok=True)


def check_output(path: str | os.PathLike) -> Path:
    """The path of a file that can be written there, found out before any work is done."""
    target = Path(path)
    if target.exists() and not target.is_file():
        raise BadInput("output", "this is not a plain file, so it is not overwritten", str(path))
    _check_folder(target)
    return target


def _check_folder(target: Path) -> None:
    """The folder must be there, and let us write."""
    if not target.parent.is_dir():
        raise EnvironmentTrouble("unwritable", f"there is no folder {target.parent} to write into", str(target))
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise EnvironmentTrouble("unwritable", f"no leave to write into the folder {target.parent}", str(target))


@contextmanager
def disk_trouble(path: str | os.PathLike) -> Iterator[None]:
    """Turns what the operating system says about a disk into one line."""
    try:
        yield
    except OSError as trouble:
        if trouble.errno in _NO_ROOM:
            raise EnvironmentTrouble(
                "disk-full", f"{_NO_ROOM[trouble.errno]}; nothing was kept", str(path)
            ) from trouble
        raise EnvironmentTrouble("unwritable", f"cannot write: {trouble.strerror or trouble}", str(path)) from trouble


def _to_disk(part: Path) -> None:
    """A full disk may only tell when the data is really written."""
    handle = os.open(part, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
