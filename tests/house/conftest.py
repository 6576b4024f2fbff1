"""The command as a process of its own: what draws must not share a process with other tests' graphics contexts."""

import os
import subprocess
import sys

import pytest

from tests.conftest import ROOT


@pytest.fixture
def brace(tmp_path):
    """Runs `brace` in an empty folder, without a display. Returns the finished process, its output as text."""

    def run(*words, **environment):
        inherited = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
        return subprocess.run(
            [sys.executable, "-P", "-m", "demos.cli", *words], cwd=tmp_path, capture_output=True, text=True,
            env={**inherited, "PYTHONPATH": str(ROOT), **environment},
        )  # fmt: skip

    return run
