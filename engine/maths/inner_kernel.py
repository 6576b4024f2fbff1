"""Kernels that only other kernels call: kept in LLVM's language, for those to take in."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import binding
from numba.core import types
from numba.core.caching import CompileResultCacheImpl
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, compile_result
from numba.core.registry import CPUDispatcher

from engine.maths.kernel_cache import KernelCache
from engine.maths.no_blas import set_up_without_blas

set_up_without_blas()

# Numba's own words for: compile no way in, neither from Python nor as a pointer
NO_WAY_IN = {"nopython": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}


def inner_kernel(function: Callable) -> Any:
    """`njit(cache=True)` for a function that only kernels call: without the way in from Python, without machine code.

    Unpacking a call's arguments is machine code too, a good third of all there is to compile for kernels that take a
    whole body or task. And whoever calls it takes it in and compiles it as part of itself. A call from Python is a
    TypeError; who needs one, as a test may, writes `njit(cache=True)`.
    """
    kernel = InnerKernel(function, targetoptions=NO_WAY_IN)
    kernel.enable_caching()
    return kernel


class InnerKernel(CPUDispatcher):
    """Known to Numba's type inference, but never to the part of it that serves calls from Python, which would crash."""

    def __init__(self, py_func, locals=None, targetoptions=None, pipeline_class=None):
        super().__init__(py_func, locals, targetoptions, pipeline_class or _InnerCompiler)

    def enable_caching(self):
        self._cache = _InnerCache(self.py_func)

    def get_call_template(self, args, kws):
        """One version for all whole numbers: Numba would compile one for each that is written out in a call."""
        args = tuple(types.unliteral(kind) for kind in args)
        return super().get_call_template(args, {name: types.unliteral(kind) for name, kind in kws.items()})

    def add_overload(self, compiled):
        self.overloads[tuple(compiled.signature.args)] = compiled

    def _compile_for_args(self, *args, **named):
        raise TypeError(f"{self.py_func.__name__} is an inner kernel, which only kernels can call")


class _InnerCompiler(Compiler):
    """Stops short of machine code."""

    def define_pipelines(self):
        self.state.library = _InnerLibrary(self.state.targetctx.codegen(), self.state.func_id.func_qualname)
        self.state.flags.no_compile = True
        return super().define_pipelines()

    def _compile_core(self):
        compiled = _with_a_name_of_its_own(super()._compile_core())
        self.state.targetctx.insert_user_function(compiled.entry_point, compiled.fndesc, [compiled.library])
        return compiled


def _with_a_name_of_its_own(compiled: Any) -> Any:
    """Numba finds a kernel by its entry point, which need not lead anywhere."""
    return compiled._replace(entry_point=object())


class _InnerLibrary(JITCodeLibrary):
    """Code that never becomes part of what runs, other than through those who link it."""

    def _optimize_final_module(self):
        """Enough for little to be left to take in; each caller does the whole of it, with its own code around."""
        passes, builder = self._codegen._module_pass_manager(opt=1, loop_vectorize=False, slp_vectorize=False)
        passes.run(self._final_module, builder)

    def _finalize_final_module(self):
        """What Numba would hand to the machine here stays as it is."""
        self._finalize_dynamic_globals()
        self._finalized = True

    @classmethod
    def restored(cls, codegen, name: str, bitcode: bytes) -> _InnerLibrary:
        library = cls(codegen, name)
        library._final_module = binding.parse_bitcode(bitcode)
        library._finalize_final_module()
        return library


class _InnerCacheImpl(CompileResultCacheImpl):
    """What a later process needs of an inner kernel."""

    def reduce(self, compiled):
        compiled.fndesc.typemap = compiled.fndesc.calltypes = None  # long, and of no more use
        library = compiled.library
        return library.name, library._get_module_for_linking().as_bitcode(), compiled.fndesc, compiled.signature

    def rebuild(self, target_context, kept):
        name, bitcode, described, signature = kept
        compiled = compile_result(
            target_context=target_context,
            typing_context=target_context.typing_context,
            library=_InnerLibrary.restored(target_context.codegen(), name, bitcode),
            fndesc=described,
            signature=signature,
            objectmode=False,
            lifted=(),
        )
        return _with_a_name_of_its_own(compiled)


class _InnerCache(KernelCache):
    _impl_class: Any = _InnerCacheImpl

    def _index_key(self, sig, codegen):
        """Another than that of the same function as Python calls it: both are kept beside the same source."""
        return (*super()._index_key(sig, codegen), "inner")
