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
