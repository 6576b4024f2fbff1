"""What a clip is made from, and the name that tells one making from any other."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from engine.clips.acclaim import find_asf
from engine.core.errors import BadInput

FORMATS = (".bvh", ".amc", ".npz", ".json")


@dataclass(frozen=True)
class Wanted:
    """What a caller may ask of an import besides the file."""

    sex: str = "male"
    body_mass_kg: float | None = None
    first_frame: int = 0  # of the file
    last_frame: int | None = None
    as_captured: bool = False  # glitches of a frame or two are left in


def sources_of(path: Path) -> list[Path]:
    """The files that a clip is made of. BadInput if a kind of file is not known or a skeleton is missing."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        raise BadInput("clip-format", f"found a {suffix or 'nameless'} file, expected {', '.join(FORMATS)}", str(path))
    if not path.is_file():
        raise BadInput("clip-missing", "found no such file, expected a clip", str(path))
    return [path, find_asf(path)] if suffix == ".amc" else [path]


def content_key(path: Path, wanted: Wanted) -> str:
    """A name for what an import will give: it changes with any byte of the files, of the wishes, or of the code that
    imports."""
    digest = hashlib.sha256(f"{importer_version()} {wanted}".encode())
    for file in sources_of(path):
        try:
            digest.update(hashlib.sha256(file.read_bytes()).digest())
        except OSError as trouble:
            raise BadInput(
                "clip-unreadable", f"found no readable file ({trouble.strerror}), expected a clip", str(file)
            ) from None
    return digest.hexdigest()


@cache
def importer_version() -> str:
    """Of the code that the outcome depends on, so that nothing imported by older code is ever taken from a cache."""
    here = Path(__file__).parent
    sources = [
        *sorted(here.glob("*.py")),
        *sorted((here.parent / "body").glob("*.py")),
        here.parent / "maths" / "rotations.py",
    ]
    return hashlib.sha256(b"\0".join(source.read_bytes() for source in sources)).hexdigest()[:16]
