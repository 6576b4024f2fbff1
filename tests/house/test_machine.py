"""The doctor looks for itself, and says what to do."""

import json
import subprocess
import sys

import pytest

from demos import machine
from demos.cli import main
from tests.conftest import ROOT

CHECKS = ["python", "packages", "graphics", "display", "ffmpeg", "threads", "clips", "cache", "disk"]


def doctor(**environment):
    import os

    done = subprocess.run(
        [sys.executable, "-m", "demos.cli", "doctor", "--json"], cwd=ROOT, capture_output=True, text=True,
        env={**os.environ, **environment},
    )  # fmt: skip
    return done.returncode, json.loads(done.stdout), done.stderr


def test_here_everything_needed_is_there():
    code, report, err = doctor()
    assert [check["name"] for check in report["checks"]] == CHECKS
    assert (code, report["fit"], err) == (0, True, "")


def test_no_gl_is_seen_and_answered(tmp_path):
    """EGL told to find no driver at all."""
    code, report, _ = doctor(__EGL_VENDOR_LIBRARY_DIRS=str(tmp_path))
    graphics = report["checks"][CHECKS.index("graphics")]
    assert (code, report["fit"], graphics["state"]) == (3, False, "missing")
    assert "libegl1" in graphics["advice"]


@pytest.mark.parametrize("broken", [None, "#!/bin/sh\nexit 1\n"])
def test_an_ffmpeg_that_fails_is_missing(monkeypatch, tmp_path, broken):
    path = tmp_path / "ffmpeg"
    path.write_text(broken or "no program")
    path.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert machine._ffmpeg().state == "missing"


def test_a_missing_package_is_named(monkeypatch):
    monkeypatch.setattr(machine, "_declared_packages", lambda: ["numpy", "no-such-package"])
    finding = machine._packages()
    assert (finding.state, "no-such-package" in finding.detail) == ("missing", True)


def test_all_that_is_declared_is_looked_for():
    assert {"numpy", "mujoco-core", "glfw", "pip"} <= set(machine._declared_packages())


def test_text_has_a_line_for_each_check(monkeypatch, capsys):
    lost, kept = ("graphics", "missing", "no EGL", "install it"), ("disk", "good", "1 GiB")
    findings = [machine.Finding(*lost), machine.Finding(*kept)]
    monkeypatch.setattr(machine, "examine", lambda: findings)
    assert main(["doctor"]) == 3
    first, second = capsys.readouterr().out.splitlines()
    assert first.startswith("!!")
    assert first.endswith("no EGL  ->  install it")
    assert second.startswith("ok")


def test_a_cache_is_tried(monkeypatch, tmp_path):
    monkeypatch.setenv("BRACE_CACHE", str(tmp_path / "new/deeper"))
    assert machine._cache().state == "good"
    assert not (tmp_path / "new").exists()  # looking changes nothing
    monkeypatch.setenv("BRACE_CACHE", "/proc/nowhere/cache")
    assert machine._cache().state == "warning"
