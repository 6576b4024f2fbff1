"""A file is written whole or not at all."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from engine.core.errors import BadInput, EnvironmentTrouble
from engine.core.files import write_atomically


def test_a_file_is_replaced_whole(tmp_path):
    path = tmp_path / "file"
    path.write_bytes(b"a longer text from before")
    write_atomically(path, b"new")
    assert path.read_bytes() == b"new"
    assert list(tmp_path.iterdir()) == [path]


def test_a_link_keeps_pointing_to_where_the_file_is(tmp_path):
    (tmp_path / "real").write_bytes(b"old")
    (tmp_path / "link").symlink_to("real")
    write_atomically(tmp_path / "link", b"new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_bytes() == b"new"


def test_a_disk_that_fills_up_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch):
    """The sync is where a full disk shows itself last."""

    def no_room(descriptor):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", no_room)
    path = tmp_path / "file"
    path.write_bytes(b"old")
    with pytest.raises(EnvironmentTrouble) as caught:
        write_atomically(path, b"new")
    assert caught.value.line() == f"error[disk-full] {path}: the disk is full; nothing was kept"
    assert caught.value.exit_code == 3
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


LIMITED = """
import resource, sys
from engine.core.errors import EnvironmentTrouble
from engine.core.files import write_atomically
resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
try:
    write_atomically(sys.argv[1], bytes(100_000))
except EnvironmentTrouble as trouble:
    print(trouble.line())
    sys.exit(trouble.exit_code)
"""


def test_the_system_refusing_more_bytes_leaves_nothing(tmp_path):
    """A real limit of the operating system, in a process of its own: the write itself fails half way."""
    root = Path(__file__).resolve().parents[2]
    ended = subprocess.run(
        [sys.executable, "-c", LIMITED, str(tmp_path / "file")], cwd=root, capture_output=True, text=True, check=False
    )
    assert ended.returncode == 3, ended.stderr
    assert ended.stdout == f"error[disk-full] {tmp_path / 'file'}: the file may not grow further; nothing was kept\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("place", ["missing/file", "plain/file"])
def test_a_place_that_cannot_be_written_is_named(tmp_path, place):
    (tmp_path / "plain").write_bytes(b"")
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(EnvironmentTrouble, match=r"there is no folder .*(missing|plain) to write into") as caught:
        write_atomically(tmp_path / place, b"x")
    assert caught.value.code == "unwritable"
    assert sorted(tmp_path.rglob("*")) == before


def test_a_folder_is_not_overwritten_by_a_file(tmp_path):
    (tmp_path / "folder").mkdir()
    with pytest.raises(BadInput, match="not a plain file"):
        write_atomically(tmp_path / "folder", b"x")
    assert [path.name for path in tmp_path.rglob("*")] == ["folder"]
