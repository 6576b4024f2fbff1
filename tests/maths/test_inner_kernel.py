"""Inner kernels serve kernels, in this process and from the disk, and refuse Python without crashing."""

import subprocess
import sys

import numpy as np
import pytest
from numba import njit

from engine.maths.inner_kernel import inner_kernel
from tests.conftest import ROOT


def twice(values, factor):
    total = 0.0
    for value in values:
        total += 2.0 * factor * value
    return total


inner_twice, plain_twice = inner_kernel(twice), njit(twice)


@njit
def through_inner(values, factor):
    return inner_twice(values, factor)


@njit
def through_plain(values, factor):
    return plain_twice(values, factor)


def test_a_kernel_gets_the_same_from_it_as_from_any_other():
    values = np.linspace(-1.0, 3.0, 11)
    assert through_inner(values, 0.3) == through_plain(values, 0.3) == twice(values, 0.3)


def test_python_is_refused_before_and_after_it_was_compiled():
    for _ in range(2):
        with pytest.raises(TypeError, match="twice is an inner kernel"):
            inner_twice(np.ones(2), 1.0)
        through_inner(np.ones(2), 1.0)


def test_nothing_for_python_is_compiled():
    through_inner(np.ones(2), 1.0)
    through_plain(np.ones(2), 1.0)
    names = {
        kernel: [found.name for found in kernel.overloads[kernel.signatures[0]].library.get_defined_functions()]
        for kernel in (inner_twice, plain_twice)
    }
    assert any("cpython" in name for name in names[plain_twice])
    assert not any("cpython" in name or name.startswith("cfunc") for name in names[inner_twice])


PROGRAM = """
from numba import njit
from engine.maths.inner_kernel import inner_kernel
@inner_kernel
def half(x):
    return 0.5 * x
@njit
def ask(x):
    return half(x)
print(ask(3.0), sum(half.stats.cache_hits.values()))
"""


def test_it_comes_back_from_the_disk(tmp_path):
    (tmp_path / "program.py").write_text(PROGRAM)
    said = []
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "program.py"], cwd=tmp_path, env={"PYTHONPATH": str(ROOT)}, capture_output=True, text=True,
            check=True,
        )  # fmt: skip
        said.append(done.stdout.split())
    assert said == [["1.5", "0"], ["1.5", "1"]]
