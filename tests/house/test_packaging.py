"""What is shipped: a wheel with everything that a checkout runs on, that works without the checkout."""

import subprocess
import sys
import zipfile

import pytest

from tests.conftest import ROOT

ROOMS = ("engine", "behaviours", "shaders", "demos")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    words = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    (path,) = folder.glob("brace-*.whl")
    return path


def test_every_source_is_in_it_and_nothing_else(wheel):
    with zipfile.ZipFile(wheel) as archive:
        inside = {name for name in archive.namelist() if ".dist-info/" not in name}
    files = [path.relative_to(ROOT) for room in ROOMS for path in (ROOT / room).rglob("*") if path.is_file()]
    assert inside == {path.as_posix() for path in files if "__pycache__" not in path.parts}
    assert any(name.startswith("shaders/") and not name.endswith(".py") for name in inside)
    assert "demos/scenarios/volleyball.toml" in inside
    assert {f"{room}/py.typed" for room in ROOMS} <= inside  # else its users' type checkers pass it over


def test_it_carries_its_licence_and_its_command(wheel):
    with zipfile.ZipFile(wheel) as archive:
        texts = {name.split(".dist-info/")[1]: name for name in archive.namelist() if ".dist-info/" in name}
        assert archive.read(texts["licenses/LICENSE"]).startswith(b"MIT License")
        assert b"brace = demos.cli:main" in archive.read(texts["entry_points.txt"])


def test_it_runs_without_the_checkout(wheel, tmp_path):
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    words = "import sys, demos.cli as c; assert sys.argv[1] in c.__file__; sys.exit(c.main(['bench', 'columns']))"
    done = subprocess.run([sys.executable, "-c", words, str(tmp_path)], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "64 projectiles" in done.stdout
