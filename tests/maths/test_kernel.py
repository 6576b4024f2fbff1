"""Kernels that Python calls: one version for all whole numbers, and machine code only for what Python calls."""

import fcntl
import os
import subprocess
import sys

import numba
import pytest
from numba.core.caching import FunctionCache

from engine.maths.kernel import njit
from tests.conftest import ROOT


def risen(base, power):
    if power < 0:
        raise ValueError("a power below nought")
    risen = 1.0
    for _ in range(power):
        risen *= base
    return risen


@pytest.fixture
def kernel():
    return njit(risen)


@pytest.fixture
def caller(kernel):
    @njit
    def square_and_cube(base):
        return kernel(base, 2) + kernel(base, 3)

    return square_and_cube


def test_python_and_kernels_get_what_numbas_own_gives(kernel, caller):
    own = numba.njit(risen)
    assert kernel(1.1, 5) == own(1.1, 5) == pytest.approx(1.1**5, rel=1e-15)
    assert caller(1.1) == own(1.1, 2) + own(1.1, 3)


def test_numbers_written_out_share_one_version(kernel, caller):
    caller(1.1)
    assert [sig[1] for sig in kernel._inner.signatures] == [numba.int64]


def test_what_only_kernels_call_never_becomes_machine_code(kernel, caller):
    caller(1.1)
    assert not kernel.signatures
    (compiled,) = kernel._inner.overloads.values()
    engine = compiled.library.codegen._engine
    assert not engine.is_symbol_defined(compiled.fndesc.llvm_func_name)
    kernel(1.1, 2)
    (compiled,) = kernel.overloads.values()
    assert engine.is_symbol_defined(compiled.fndesc.llvm_func_name)


def test_an_error_inside_a_kernel_that_a_kernel_calls_reaches_python(kernel):
    @njit
    def through(base, power):
        return kernel(base, power)

    assert through(2.0, 3) == 8.0
    with pytest.raises(ValueError, match="a power below nought"):
        through(2.0, -1)


KERNELS = """
from engine.maths.kernel import njit
@njit(cache=True)
def half(values):
    if values.size == 0:
        raise ValueError("nothing to halve")
    return 0.5 * values
@njit(cache=True)
def first(values):
    return half(values)[0]
@njit(cache=True)
def second(values):
    return half(values)[1]
"""
PROGRAM = """
import sys
import numpy as np
import kernels
called = getattr(kernels, sys.argv[1])
try:
    called(np.empty(0))
except ValueError as trouble:
    print(trouble)
hits = [sum(kernel.stats.cache_hits.values()) for kernel in (called, kernels.half._inner)]
print(called(np.array([3.0, 4.0])), *hits)
"""


def test_both_halves_come_back_from_the_disk(tmp_path):
    """The last process compiles a caller that is new, with what was kept of the inner half."""
    (tmp_path / "kernels.py").write_text(KERNELS)
    said = []
    for called in ("first", "first", "half", "second"):
        words = [sys.executable, "-c", PROGRAM, called]
        done = subprocess.run(
            words, cwd=tmp_path, env={"PYTHONPATH": str(ROOT)}, capture_output=True, text=True, check=True
        )
        said.append(done.stdout.splitlines())
    assert said == [
        ["nothing to halve", "1.5 0 0"],
        ["nothing to halve", "1.5 1 0"],  # whole already: nothing is asked of the inner half
        ["nothing to halve", "[1.5 2. ] 0 0"],
        ["nothing to halve", "2.0 0 1"],
    ]


TOTAL = """
from engine.maths.kernel import njit
@njit(cache=True)
def total(parts):
    return parts.first + parts.second
"""
PARTS = """
from typing import NamedTuple
class Parts(NamedTuple):
    first: float
    second: float
"""


@pytest.mark.parametrize(("module", "name"), [("moved", "Parts"), ("parts", "Renamed")])
def test_a_kernel_outlives_the_types_it_was_compiled_for(tmp_path, module, name):
    """As after a pull that moves a type: the kernel's own file is the same, so what was kept of it looks fresh."""

    def said(module, name):
        program = f"from {module} import {name} as Parts; from total import total; print(total(Parts(1.0, 2.0)))"
        words = [sys.executable, "-B", "-c", program]
        where = {"cwd": tmp_path, "env": {"PYTHONPATH": str(ROOT)}}
        return subprocess.run(words, **where, capture_output=True, text=True, check=True).stdout

    (tmp_path / "total.py").write_text(TOTAL)
    (tmp_path / "parts.py").write_text(PARTS)
    assert said("parts", "Parts") == "3.0\n"
    (tmp_path / "parts.py").unlink()
    (tmp_path / f"{module}.py").write_text(PARTS.replace("Parts", name))
    assert said(module, name) == "3.0\n"


def test_only_one_process_at_a_time_adds_to_a_folder_of_kernels(kernel, monkeypatch, tmp_path):
    """Else two that compile two versions of a function may call both by one file name."""

    def watched(cache, sig, data):
        assert cache.cache_path == str(tmp_path)
        other = os.open(tmp_path, os.O_RDONLY)
        with pytest.raises(BlockingIOError):
            fcntl.flock(other, fcntl.LOCK_EX | fcntl.LOCK_NB)
        os.close(other)
        kept.append(sig)

    kept = []
    monkeypatch.setattr(FunctionCache, "save_overload", watched)
    kernel.enable_caching()
    for half in (kernel, kernel._inner):
        half._cache._cache_path = str(tmp_path)
    caller = njit(lambda base: kernel(base, 2))
    assert caller(1.5) == kernel(1.5, 2) == 2.25
    assert len(kept) == 2
    again = os.open(tmp_path, os.O_RDONLY)
    fcntl.flock(again, fcntl.LOCK_EX | fcntl.LOCK_NB)  # and lets go of it
    os.close(again)
