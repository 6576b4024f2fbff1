"""Machines without graphics: one line that says what to install, exit code 3. Each in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from engine.core.errors import EXIT_ENVIRONMENT

ROOT = Path(__file__).resolve().parents[2]
TRY = """
import sys
from engine.core.errors import EnvironmentTrouble
from engine.render.context import make_context
try:
    make_context(headless=sys.argv[1] == "headless", size=(64, 64))
except EnvironmentTrouble as trouble:
    print(trouble.line())
    sys.exit(trouble.exit_code)
"""


def _try(kind: str, **environment: str) -> subprocess.CompletedProcess:
    env = {
        name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")
    } | environment
    return subprocess.run(
        [sys.executable, "-c", TRY, kind], cwd=ROOT, env=env, capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize(
    ("kind", "environment", "expected"),
    [
        ("headless", {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent"}, "apt-get install libegl1 libgl1"),
        ("headless", {"MESA_GL_VERSION_OVERRIDE": "3.1"}, "OpenGL 3.3"),
        ("window", {}, "without a display use: brace capture"),
        ("window", {"DISPLAY": ":4711"}, "no window can be opened here"),
    ],
    ids=["no driver", "too old", "no display", "wrong display"],
)
def test_one_line_and_exit_code_three(kind, environment, expected):
    done = _try(kind, **environment)
    assert done.returncode == EXIT_ENVIRONMENT, done.stdout + done.stderr
    assert expected in done.stdout
    assert done.stdout.startswith("error[")
    assert done.stdout.count("\n") == 1
    assert "Traceback" not in done.stderr


def test_libraries_that_are_missing_altogether(tmp_path):
    """The loader finds nothing: as on a machine without the packages."""
    hide = tmp_path / "sitecustomize.py"
    hide.write_text(
        "import glcontext\n"
        "def absent(name):\n"
        "    def create(**_):\n"
        "        raise Exception('libEGL.so: cannot open shared object file')\n"
        "    return create\n"
        "glcontext.get_backend_by_name = absent\n"
        "glcontext.default_backend = lambda: absent('')\n"
    )
    done = _try("headless", PYTHONPATH=str(tmp_path))
    assert done.returncode == EXIT_ENVIRONMENT, done.stdout + done.stderr
    assert "libegl1 libgl1" in done.stdout
