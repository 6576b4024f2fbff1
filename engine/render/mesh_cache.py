"""Meshes kept in the user's cache, so that a body is sculpted once and not at every start.

A file is keyed by what the mesh depends on: the body's lengths, the wishes, and the sculpting code itself, so it is
never stale. It is written beside its name and renamed. One that cannot be read, or written, is as good as none.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import threading
import zipfile
from pathlib import Path

import numpy as np

from engine.body.skeleton import Body
from engine.render.mannequin import MannequinMesh, mannequin_mesh

_SHAPED_BY = ("mannequin.py", "surface.py", "adaptive.py", "skinning.py", "sculpture/*.py")  # beside this file


def cached_mesh(body: Body, coarser: float = 1.0, style: str = "smooth") -> MannequinMesh:
    """`mannequin_mesh`, from the cache if the same was ever made before."""
    path = cache_folder() / "meshes" / f"{mesh_key(body, coarser, style)}.npz"
    kept = _load(path)
    if kept is None:
        kept = mannequin_mesh(body, coarser, style)
        with contextlib.suppress(OSError):
            _save(path, kept)
    return kept


def cache_folder() -> Path:
    """$BRACE_CACHE, else brace in $XDG_CACHE_HOME, else in ~/.cache; the same as for clips."""
    base = os.environ.get("XDG_CACHE_HOME")
    told = os.environ.get("BRACE_CACHE")
    return Path(told) if told else (Path(base) if base else Path.home() / ".cache") / "brace"


def mesh_key(body: Body, coarser: float, style: str) -> str:
    """A name for what the mesh will be."""
    said = f"{_sculpture_key()} {coarser!r} {style} ".encode()
    return hashlib.sha256(said + body_key(body)).hexdigest()[:40]


def body_key(body: Body) -> bytes:
    """What the mesh depends on: figures whose bodies agree in it share one."""
    lengths = (body.offset_m, body.head_top_m, body.palm_m, body.fingertip_m, body.sole_m)
    return b"".join(np.asarray(part, float).tobytes() for part in lengths)


@functools.cache
def _sculpture_key() -> str:
    """Changes with every change to the code that shapes bodies."""
    here = Path(__file__).parent
    files = [file for pattern in _SHAPED_BY for file in sorted(here.glob(pattern))]
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()


def _load(path: Path) -> MannequinMesh | None:
    try:
        with open(path, "rb") as file:
            arrays = np.load(file, allow_pickle=False)
            return MannequinMesh(*(arrays[name] for name in MannequinMesh._fields))
    except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile):
        return None


def _save(path: Path, mesh: MannequinMesh) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{path.name}.{os.getpid()}.{threading.get_ident()}")
    try:
        with open(beside, "xb") as file:
            np.savez(file, **mesh._asdict())
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)
