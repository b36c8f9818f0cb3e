"""Marks of what the composer compiles, and how; in plain Python they do nothing.

`inline` is folded into its callers, `compiled` stays a function of its own, `cached` is the one
entry point whose machine code is kept on disk.
"""

from collections.abc import Callable
from typing import Any, TypeVar

Function = TypeVar("Function", bound=Callable[..., Any])


def inline(function: Function) -> Function:
    """Fold into the callers."""
    return function


def compiled(function: Function) -> Function:
    """Compile as a function of its own."""
    return function


def cached(function: Function) -> Function:
    """Compile and keep on disk: an entry point."""
    return function


#: What the three names mean in a composed module. Only entry points get wrappers for Python, which
#: halves the time to compile. Nothing in a kernel allocates, so nothing need be counted (`_nrt`):
#: counting references to the arrays took a third of the time.
COMPILED_HEADER = """\
inline = numba.njit(
    forceinline=True,
    error_model="numpy",
    _nrt=False,
    no_cpython_wrapper=True,
    no_cfunc_wrapper=True,
)
compiled = numba.njit(
    error_model="numpy", _nrt=False, no_cpython_wrapper=True, no_cfunc_wrapper=True
)
"""
CACHED_ON_DISK = 'cached = numba.njit(error_model="numpy", _nrt=False, nogil=True, cache=True)\n'
CACHED_IN_MEMORY = 'cached = numba.njit(error_model="numpy", _nrt=False, nogil=True)\n'
