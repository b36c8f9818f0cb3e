"""Checks of arguments: what each must be is said beside its name, above the function.

Numbers of any type become floats on the way in. All wrong arguments of a call are named at once.

Examples
--------
>>> @checked(times=SERIES, at=number(low=0.0))
... def later(times, at=0.0):
...     return [time for time in times if time > at]
>>> later([1, 2], at=1)
[2.0]
>>> later(None, at=-1.0)
Traceback (most recent call last):
saleg.errors.WrongArguments: 2 wrong fields in the arguments of later():
  times = None: must be a list of finite numbers, or the like
  at = -1.0: must be a number >= 0
"""

from __future__ import annotations

import functools
import inspect
import math
import sys
from collections.abc import Callable, Iterable, Mapping, Set
from typing import Any, NamedTuple, ParamSpec, TypeVar

import numpy as np

from saleg.columns import Column
from saleg.errors import Problem, WrongArguments, shown
from saleg.quantities import Limits, as_float, is_whole

P = ParamSpec("P")
R = TypeVar("R")


class Check(NamedTuple):
    """What an argument must be.

    Attributes
    ----------
    read : callable
        From a value to what the function is handed; None for a wrong one.
    wanted : str
        What a wrong value should have been.
    or_none : bool
        Whether None is right, too.
    told : callable
        From a wrong value to what is wrong in it, in words, where its own text may not show it.
    """

    read: Callable[[Any], Any]
    wanted: str
    or_none: bool = False
    told: Callable[[Any], str] = lambda value: ""

    @property
    def optional(self) -> Check:
        """The same, or None."""
        return Check(self.read, f"{self.wanted}, or None", True, self.told)


def checked(**checks: Check) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorator of a function whose arguments are checked before it begins.

    Parameters
    ----------
    **checks
        Check by name of the argument; defaults are not checked.

    Returns
    -------
    callable
        Decorator. A call with wrong arguments raises a :class:`saleg.errors.WrongArguments` that
        names all of them.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        names = tuple(inspect.signature(function).parameters)
        whose = function.__name__
        if whose == "__init__":  # of the class that is called
            whose = function.__qualname__.split(".")[-2]

        @functools.wraps(function)
        def call(*args: Any, **given: Any) -> Any:
            wrong: list[Problem] = []
            read = [_read(checks, *item, wrong) for item in zip(names, args, strict=False)]
            for name, value in given.items():
                given[name] = _read(checks, name, value, wrong)
            if wrong:
                raise WrongArguments(wrong, f"arguments of {whose}()")
            return function(*read, *args[len(names) :], **given)

        return call

    return decorate


def _read(checks: dict[str, Check], name: str, value: Any, wrong: list[Problem]) -> Any:
    """An argument as the function is handed it; a wrong one is noted."""
    check = checks.get(name)
    if check is None or (value is None and check.or_none):
        return value
    found = check.read(value)
    if found is None:
        wrong.append(Problem(name, value, "-", check.wanted + check.told(value)))
    return found


def number(
    low: float = -math.inf,
    high: float = math.inf,
    *,
    open_low: bool = False,
    open_high: bool = False,
) -> Check:
    """Check for one finite number of a range."""
    limits = Limits("-", low, high, open_low, open_high)

    def read(value: Any) -> float | None:
        if type(value) is float and low < value < high:
            return value  # by far the most
        found = as_float(value)
        if found is None or not math.isfinite(found) or not limits.admits(found):
            return None
        return found

    return Check(read, limits.wanted("a number" if str(limits) else "a finite number"))


def numbers(low: float = -math.inf, *, open_low: bool = False) -> Check:
    """Check for one finite number of a range, or an array of them."""
    one = number(low, open_low=open_low)
    limits = Limits("-", low, math.inf, open_low, False)

    def read(value: Any) -> Any:
        found = one.read(value)
        if found is not None:
            return found
        array = as_array(value)
        good = array is not None and (np.isfinite(array) & limits.admits(array)).all()
        return array if good else None

    return Check(read, f"{one.wanted}, or an array of such numbers")


def whole(low: int = 0, high: int = 2**31 - 1) -> Check:
    """Check for a whole number of a range, ends included."""
    wanted = f"must be a whole number from {low} to {high}"
    return Check(lambda value: int(value) if is_whole(value, low, high) else None, wanted)


def a(*kinds: Any, wanted: str = "") -> Check:
    """Check for an object of one of some classes."""
    named = " or ".join(kind.__name__ for kind in kinds)
    article = "an" if named.startswith(("A", "E", "I", "O")) else "a"
    return Check(
        lambda value: value if isinstance(value, kinds) else None,
        f"must be {wanted or f'{article} {named}'}",
    )


def as_array(value: Any) -> np.ndarray | None:
    """Numbers in lists, arrays or columns as an array of floats; None if anything else is there."""
    if isinstance(value, Column):
        return value
    try:
        given = np.asarray(value)
    except (TypeError, ValueError):
        return None
    if given.dtype.kind in "iuf" and given.ndim:
        return given.astype(float)
    found = [as_float(item) for item in given.ravel().tolist()] if given.dtype == object else []
    return np.array(found).reshape(given.shape) if found and None not in found else None


def _series(value: Any, read: Callable[[Any], Any]) -> list[Any] | None:
    """Items of a list or the like, each read; None if one is wrong."""
    if isinstance(value, (str, bytes, Mapping, Set)) or not isinstance(value, Iterable):
        return None
    if getattr(value, "ndim", 1) != 1:  # a table, which would give the names of its columns
        return None
    try:
        found = [read(item) for item in value]
    except TypeError:  # what only looks like a list
        return None
    return None if any(item is None for item in found) else found


def each(check: Check, wanted: str, *, empty: bool = True) -> Check:
    """Check for a list, or the like, of what passes a check; whether it may be empty."""

    def read(value: Any) -> list[Any] | None:
        found = _series(value, check.read)
        return None if found is None or not (found or empty) else found

    def told(value: Any) -> str:
        items = _series(value, lambda item: (item,)) or []
        wrong = (n for n, (item,) in enumerate(items) if check.read(item) is None)
        return next((f"; item {n} is {_plainly(items[n][0])}" for n in wrong), "")

    kind = "a list" if empty else "a list, not empty,"
    return Check(read, f"must be {kind} of {wanted}, or the like", told=told)


def _plainly(value: Any) -> str:
    """A value as text, numbers of any type as floats."""
    found = as_float(value)
    return shown(value if found is None else found)


NUMBER = number()
POSITIVE = number(0.0, open_low=True)
SERIES = each(NUMBER, "finite numbers")
SOME = each(NUMBER, "finite numbers", empty=False)
ONE_OR_MORE = Check(
    lambda value: SOME.read(value) if NUMBER.read(value) is None else NUMBER.read(value),
    "must be a finite number, or a list, not empty, of such numbers",
    told=SOME.told,
)
FLAG = Check(
    lambda value: bool(value) if isinstance(value, (bool, np.bool_)) else None,
    "must be True or False",
)
TEXT = a(str, wanted="text")
NAMES = each(TEXT, "names")
FUNCTION = Check(lambda value: value if callable(value) else None, "must be a function")


def _frame(value: Any) -> Any:
    """A table of pandas, which has been imported where there is one; None for anything else."""
    pandas = sys.modules.get("pandas")
    return value if pandas is not None and isinstance(value, pandas.DataFrame) else None


FRAME = Check(_frame, "must be a DataFrame")
