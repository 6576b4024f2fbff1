"""Kernels that Python calls."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba.core.registry import CPUDispatcher

from engine.maths.inner_kernel import NO_WAY_IN, InnerKernel
from engine.maths.kernel_cache import KernelCache


def njit(function: Callable | None = None, *, cache: bool = False, forceinline: bool = False) -> Any:
    """Numba's `njit`, compiled into fewer and smaller pieces.

    Python gets machine code. Kernels that call it get an inner kernel of the same function, so that no way in and no
    machine code is made for versions that Python never calls.
    """

    def decorate(function: Callable) -> Any:
        kernel = _Kernel(function, targetoptions={"nopython": True, "no_cfunc_wrapper": True}, forceinline=forceinline)
        if cache:
            kernel.enable_caching()
        return kernel

    return decorate if function is None else decorate(function)


class _Kernel(CPUDispatcher):
    def __init__(self, py_func, locals=None, targetoptions=None, *, forceinline=False):
        super().__init__(py_func, locals, targetoptions)
        self._inner = InnerKernel(py_func, targetoptions={**NO_WAY_IN, "forceinline": forceinline})

    def enable_caching(self):
        self._cache = KernelCache(self.py_func)
        self._inner.enable_caching()

    def get_call_template(self, args, kws):
        return self._inner.get_call_template(args, kws)

    def get_overload(self, sig):
        return self._inner.get_overload(sig)
