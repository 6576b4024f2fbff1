"""What set-up does once packages are there: clips that need not come, kernels compiled in parts."""

import os
import subprocess
import sys
import time

import numpy as np
import pytest
from numba import njit

from demos import set_up
from engine.core.errors import EnvironmentTrouble
from tests.conftest import ROOT


def test_without_network_it_says_so_and_goes_on(monkeypatch, capsys):
    def no_network(say):
        raise EnvironmentTrouble("fetch", "could not fetch walk (no network)")

    monkeypatch.setattr("engine.clips.library.fetch", no_network)
    set_up.fetch_clips()
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    assert "no network" in said
    assert "embedded clip 'sway'" in said


def test_a_part_says_which_kernels_it_compiles(monkeypatch, capsys):
    @njit
    def treble(x):
        return 3.0 * x

    monkeypatch.setitem(set_up.PARTS, "protection", lambda: treble(np.float64(2.0)))
    set_up._compile_part("protection")
    assert [name.rpartition(".")[2] for name in capsys.readouterr().out.split()] == ["treble"]


def test_all_parts_run_and_their_kernels_are_counted(monkeypatch, tmp_path):
    stand_in = tmp_path / "python"
    stand_in.write_text(f'#!/bin/sh\necho "$*" >>{tmp_path}/calls\necho engine.one\necho engine.two\n')
    stand_in.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(stand_in))
    assert set_up._compile_parts() == 2 * len(set_up.PARTS)
    calls = (tmp_path / "calls").read_text().splitlines()
    assert sorted(calls) == [f"-P -m demos.set_up kernels-{part}" for part in sorted(set_up.PARTS)]


def test_what_no_first_picture_needs_is_compiled_behind_it(monkeypatch, tmp_path):
    """By a process that is in nobody's way and holds no stream open that somebody may read to its end."""
    stand_in, said = tmp_path / "python", tmp_path / "said"
    stand_in.write_text(
        "#!/bin/sh\nstreams=$(readlink /proc/$$/fd/1 /proc/$$/fd/2 | sort -u)\nsession=$(cut -d' ' -f6 /proc/$$/stat)\n"
        f'echo "$*" "$(nice)" "$session" "$streams" >{said}\n'
    )
    stand_in.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(stand_in))
    assert set_up._compile_later().wait(60.0) == 0
    *words, nice, session, streams = said.read_text().split()
    assert words == ["-P", "-m", "demos.set_up", "kernels-stance"]
    assert (int(nice), streams) == (19, "/dev/null")
    assert int(session) != os.getsid(0)


@pytest.mark.parametrize(("in_parts", "later"), [(0, 0), (7, 1)])
def test_nothing_goes_on_behind_where_nothing_was_to_compile(monkeypatch, tmp_path, in_parts, later):
    begun = []
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path))
    monkeypatch.setattr(set_up, "_compile_parts", lambda: in_parts)
    monkeypatch.setattr(set_up, "_run", lambda scenario: None)
    monkeypatch.setattr(set_up, "_tidy_seldom", lambda: None)
    monkeypatch.setattr(set_up, "on_compiling", lambda tell: None)
    monkeypatch.setattr(set_up, "_compile_later", lambda: begun.append(1))
    monkeypatch.setattr(os, "sched_getaffinity", lambda process: {0, 1})
    set_up.compile_kernels()
    assert len(begun) == later


@pytest.fixture
def begun(monkeypatch, tmp_path):
    """Begun compilations are counted here, and remembered in a cache of our own; nothing is compiled."""
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(set_up, "get_kernels_ready", lambda: None)
    monkeypatch.setattr(set_up, "newest_kernel_source_s", lambda: 1000.0)
    begun = []
    monkeypatch.setattr(set_up, "compile_kernels", lambda: begun.append(set_up._date_mark(1001.0)))
    return begun


def test_kernels_are_compiled_before_the_first_window_and_after_every_update(begun, monkeypatch):
    """Also one that brought new files, beside which no kernel can be stale."""
    for _ in range(2):
        set_up.compile_what_changed()
        assert begun == [True]
    monkeypatch.setattr(set_up, "newest_kernel_source_s", lambda: 1002.0)
    set_up.compile_what_changed()
    assert begun == [True, True]


def test_no_window_waits_where_nothing_can_be_remembered(begun, monkeypatch, tmp_path):
    (tmp_path / "file").touch()
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "file" / "cache"))
    set_up.compile_what_changed()
    assert begun == []


def test_compiling_is_remembered_from_when_it_began(monkeypatch, tmp_path):
    """What is edited while it goes on is not in it."""
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path))
    monkeypatch.setattr(set_up, "_compile_parts", lambda: 0)
    monkeypatch.setattr(set_up, "_tidy_seldom", lambda: None)
    monkeypatch.setattr(set_up, "on_compiling", lambda tell: None)
    ended = []
    monkeypatch.setattr(set_up, "_run", lambda scenario: (time.sleep(0.05), ended.append(time.time())))
    set_up.compile_kernels()
    (mark,) = tmp_path.iterdir()
    assert 0.0 < ended[0] - mark.stat().st_mtime < 60.0


def test_parts_are_found_from_any_folder(monkeypatch, tmp_path):
    """Whoever compiles after an update may stand anywhere, and need not have a PYTHONPATH."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PYTHONPATH", raising=False)
    done = subprocess.run(
        set_up._to_compile([]), env=set_up._environment(), capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (0, "")


def test_figures_are_sculpted_ahead_as_pictures_want_them(monkeypatch, tmp_path):
    from engine.clips.library import find_clip
    from engine.render import mesh_cache
    from engine.render.passes.figures import DETAIL

    monkeypatch.setenv("BRACE_CACHE", str(tmp_path))  # no clip but the embedded one is here
    made = []
    monkeypatch.setattr(mesh_cache, "cached_mesh", lambda body, coarser: made.append((body, coarser)))
    set_up._sculpt()
    assert [coarser for _, coarser in made] == list(set_up.MOSTLY_SEEN)
    assert {coarser for _, coarser in DETAIL} >= set(set_up.MOSTLY_SEEN)
    expected = mesh_cache.body_key(find_clip("sway").body)
    assert all(mesh_cache.body_key(body) == expected for body, _ in made)


def test_the_blow_comes_without_a_protection_before_it(monkeypatch):
    """Else both parts would compile the same kernels."""
    from behaviours.components import Phase, Reaction
    from demos import running

    started, seen = [], set()
    start = running.start

    def watched(*words):
        started.append(start(*words))
        step = started[0].step

        def stepped():
            step()
            seen.add(Phase(int(started[0].world[Reaction].phase[0])).name)

        monkeypatch.setattr(started[0], "step", stepped)
        return started[0]

    monkeypatch.setattr(running, "start", watched)
    set_up._be_struck()
    assert {"RESPOND", "RECOVER_BLEND"} <= seen
    assert not seen & {"STARTLE", "PROTECT", "HOLD"}


def test_once_compiled_nothing_is_left_to_compile():
    command = [sys.executable, "-m", "demos.set_up", "kernels"]
    for _ in range(2):  # the first may have something to do
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    first, last = done.stderr.splitlines()
    assert first == "brace: compiling kernels, once"
    assert last.startswith("brace: 0 kernels compiled in ")
