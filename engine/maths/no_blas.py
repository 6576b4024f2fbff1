"""Numba's arrays without SciPy's linear algebra, a tenth of the time of every start.

Numba imports it only to know whether its own `convolve`, `correlate` and `cov` may use BLAS, and else runs plain loops;
what calls BLAS by name, as `dot` does, still imports it when it is compiled. Kernels here use none of them.
"""

from __future__ import annotations

import sys


def set_up_without_blas() -> None:
    """To be called before the first kernel is compiled or loaded: that sets the arrays up."""
    if "scipy.linalg" in sys.modules:
        return
    sys.modules["scipy.linalg"] = None  # type: ignore[assignment]  # Python's own way to say that there is none
    try:
        import numba.np.arraymath  # noqa: F401
    finally:
        del sys.modules["scipy.linalg"]
