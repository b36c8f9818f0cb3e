"""Syntax trees are for one thread at a time."""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")

#: Held by whoever reads or writes syntax trees: Python 3.11 counts how deep it is in them for all
#: threads together, and fails with "AST constructor recursion depth mismatch".
SYNTAX = threading.RLock()


def one_at_a_time(function: Callable[P, T]) -> Callable[P, T]:
    """Make threads that call a function wait for each other."""

    @wraps(function)
    def call(*args: P.args, **given: P.kwargs) -> T:
        with SYNTAX:
            return function(*args, **given)

    return call
