"""Writing a file whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from engine.core.errors import EnvironmentTrouble


def write_atomically(path: str | Path, data: bytes) -> None:
    """Put these bytes under this name; whatever was there stays until they are safely on the disk.

    EnvironmentTrouble where the disk is full or the place cannot be written; then nothing is left behind.
    """
    target = Path(os.path.realpath(path))  # a link keeps pointing to where the file really is
    unfinished = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        try:
            with open(unfinished, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.replace(unfinished, target)
        finally:
            unfinished.unlink(missing_ok=True)
    except OSError as trouble:
        raise EnvironmentTrouble("WRITE", f"cannot write: {trouble.strerror or trouble}", str(path)) from trouble
