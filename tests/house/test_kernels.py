"""A compiled kernel never outlives a source that it was compiled from, and drags nothing along that costs set-up."""

import ast
import io
import os
import re
import sys

import pytest

from demos.kernels import forget_stale, newest_kernel_source_s, terminal_line
from tests.conftest import ROOT

SOURCES = {
    "engine/maths/vector.py": "from numba import njit\n",
    "engine/body/arm.py": "from engine.maths import (\n    quaternion,\n    vector,\n)\n",
    "behaviours/block.py": "import numpy\nfrom engine.body.arm import bend\n",
    "behaviours/lean.py": "import math\n",
}


@pytest.fixture
def tree(tmp_path):
    """Three rooms whose every module has one compiled kernel, younger than all sources."""
    (tmp_path / "demos").mkdir()
    for name, text in SOURCES.items():
        source = tmp_path / name
        source.parent.mkdir(parents=True, exist_ok=True)
        source.write_text(text)
        date(source, 100)
        for ending in ("nbi", "1.nbc"):
            compiled = source.parent / "__pycache__" / f"{source.stem}.kernel-7.py311.{ending}"
            compiled.parent.mkdir(exist_ok=True)
            compiled.touch()
            date(compiled, 200)
    return tmp_path


def date(path, seconds):
    os.utime(path, (seconds, seconds))


def kept(tree):
    return {path.name.split(".")[0] for path in tree.rglob("*.nb[ic]")}


def test_nothing_is_thrown_away_without_an_edit(tree):
    assert forget_stale(tree) == []
    assert kept(tree) == {"vector", "arm", "block", "lean"}


def test_progress_stays_in_one_line_of_a_narrow_terminal(monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    monkeypatch.setattr("sys.stderr", Terminal())
    monkeypatch.setenv("COLUMNS", "60")
    terminal_line("compiling kernels: 12, behaviours.protect.sustained.a_name_that_goes_on_for_long")
    (line,) = sys.stderr.getvalue().split("\r\033[K")[1:]
    assert line == "compiling kernels: 12, behaviours.protect.sustained.a_name_"


def test_only_edits_of_what_ticks_run_make_a_window_wait(tree):
    date(tree / "engine/maths/vector.py", 300)
    (tree / "demos/panel.py").touch()
    assert newest_kernel_source_s(tree) == 300


def test_an_edit_reaches_all_that_import_it_however_indirectly(tree):
    date(tree / "engine/maths/vector.py", 300)
    assert set(forget_stale(tree)) == {"engine/maths/vector.py", "engine/body/arm.py", "behaviours/block.py"}
    assert kept(tree) == {"lean"}


def test_an_edit_leaves_what_it_imports(tree):
    date(tree / "behaviours/block.py", 300)
    assert forget_stale(tree) == ["behaviours/block.py"]
    assert kept(tree) == {"vector", "arm", "lean"}


def test_numba_itself_would_have_run_the_old_code(tmp_path):
    """The reason for all this: a changed callee in another file, with and without forget_stale."""
    import subprocess
    import sys

    engine = tmp_path / "engine"
    for room in ("engine", "behaviours", "demos"):
        (tmp_path / room).mkdir()
        (tmp_path / room / "__init__.py").touch()
    callee = "from numba import njit\n@njit(cache=True)\ndef answer():\n    return {}\n"
    (engine / "callee.py").write_text(callee.format(41))
    (engine / "caller.py").write_text(
        "from numba import njit\nfrom engine.callee import answer\n@njit(cache=True)\ndef ask():\n    return answer()\n"
    )

    def run():
        words = [sys.executable, "-c", "from engine.caller import ask; print(ask())"]
        environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run(words, env=environment, cwd=tmp_path, capture_output=True, text=True, check=True)
        return done.stdout.strip()

    assert run() == "41"
    (engine / "callee.py").write_text(callee.format(42))
    assert run() == "41"  # should numba ever learn it, this module can go
    assert "engine/caller.py" in forget_stale(tmp_path)
    assert run() == "42"


def is_number(node):
    """A literal, np.nan, or a negative or several of these."""
    if isinstance(node, ast.Tuple):
        return all(map(is_number, node.elts))
    return isinstance(node, (ast.Constant, ast.Attribute)) or (
        isinstance(node, ast.UnaryOp) and is_number(node.operand)
    )


def slices_that_take_an_array(source):
    """The lines of kernels in which a slice of an array is given another array; see engine.maths.copying."""
    for function in ast.parse(source).body:
        marks = " ".join(map(ast.unparse, getattr(function, "decorator_list", ())))
        if "njit" not in marks and "inner_kernel" not in marks:
            continue
        for node in ast.walk(function):
            targets = node.targets if isinstance(node, ast.Assign) else ()
            places = [place for target in targets for place in ast.walk(target) if isinstance(place, ast.Subscript)]
            sliced = any(isinstance(part, ast.Slice) for place in places for part in ast.walk(place.slice))
            if sliced and not is_number(node.value):
                yield node.lineno


def test_such_slices_are_found():
    few = (" a[:] = 0.0", " a[:2], b[:] = np.nan, -1.0", " a[1, 2:] = b", " a[1] = b[0]")
    lines = ("@njit(cache=True)", "def f(a, b):", *few)
    assert list(slices_that_take_an_array("\n".join(lines))) == [5]
    assert not list(slices_that_take_an_array("def f(a, b):\n    a[:] = b\n"))


def test_no_kernel_assigns_an_array_to_a_slice():
    """It would compile Numba's text handling into the kernel and all its callers."""
    rooms = [path for room in ("engine", "behaviours", "demos") for path in sorted((ROOT / room).rglob("*.py"))]
    found = {path.relative_to(ROOT).as_posix(): list(slices_that_take_an_array(path.read_text())) for path in rooms}
    assert not {name: lines for name, lines in found.items() if lines}


def test_every_kernel_of_ours_is_of_the_sparing_kind():
    """Numba's own decorator would compile a way in from Python for each version that a kernel calls."""
    rooms = [path for room in ("engine", "behaviours", "demos") for path in sorted((ROOT / room).rglob("*.py"))]
    own = [path for path in rooms if re.search(r"^from numba import\b.*\bnjit\b", path.read_text(), re.MULTILINE)]
    assert not own
