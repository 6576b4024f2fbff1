"""Kernels that only other kernels call."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba.core.registry import CPUDispatcher

# Numba's own words for: compile no way in, neither from Python nor as a pointer
NO_WAY_IN = {"nopython": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def inner_kernel(function: Callable) -> Any:
    """`njit(cache=True)` for a function that only kernels call: without the way in from Python.

    Unpacking a call's arguments is machine code too, a good third of all there is to compile for kernels that take a
    whole body or task. A call from Python is a TypeError; who needs one, as a test may, writes `njit(cache=True)`.
    """
    kernel = _InnerKernel(function, targetoptions=NO_WAY_IN)
    kernel.enable_caching()
    return kernel


class _InnerKernel(CPUDispatcher):
    """Known to Numba's type inference, but never to the part of it that serves calls from Python, which would crash."""

    def add_overload(self, compiled):
        self.overloads[tuple(compiled.signature.args)] = compiled

    def _compile_for_args(self, *args, **named):
        raise TypeError(f"{self.py_func.__name__} is an inner kernel, which only kernels can call")
