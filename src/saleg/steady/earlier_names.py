"""Earlier names of keywords, accepted with a warning."""

from __future__ import annotations

import functools
import warnings
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


def renamed_keywords(**names: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorator that accepts earlier names of keywords.

    Parameters
    ----------
    **names
        Present name by earlier name.

    Returns
    -------
    callable
        Decorator. A call with an earlier name warns with a `DeprecationWarning` that says the
        present one.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @functools.wraps(function)
        def call(*args: Any, **given: Any) -> R:
            for earlier in [name for name in names if name in given]:
                name = names[earlier]
                if name in given:
                    raise TypeError(f"{function.__name__}() was given {earlier} and {name}: one")
                text = f"{function.__name__}({earlier}=...) is called {name} now"
                warnings.warn(text, DeprecationWarning, stacklevel=2)
                given[name] = given.pop(earlier)
            return function(*args, **given)

        return call

    return decorate
