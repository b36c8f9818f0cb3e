"""Numbers of many engines in the place of one: the same Python text, run once for all of them.

A :class:`Column` calculates as numbers do, number by number and to the last bit as Python does.
Where a branch depends on it, all its rows must agree; if they do not, :class:`Differs` says which
go which way, and :func:`by_branch` runs each lot by itself.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

Result = TypeVar("Result")


class Differs(Exception):
    """Rows of a column do not agree about a branch.

    Attributes
    ----------
    answers : ndarray of bool
        The answer of each row.
    """

    def __init__(self, answers: np.ndarray):
        super().__init__("rows differ about a branch")
        self.answers = answers


class Column(np.ndarray):
    """A number per row, float64 of shape (n,); any size of one row stands for all."""

    def __bool__(self) -> bool:
        count = np.count_nonzero(self)
        if 0 < count < self.size:
            raise Differs(np.asarray(self) != 0.0)
        return bool(count > 0)

    def __float__(self) -> float:
        raise TypeError("a column is no single number")

    def __pow__(self, exponent: Any, modulo: None = None) -> Any:
        return _power(self, exponent)

    def __rpow__(self, base: Any, modulo: None = None) -> Any:
        return _power(base, self)


def column(values: Any) -> Any:
    """A column of some numbers; a single float if they are all the same."""
    values = np.asarray(values, dtype=np.float64)
    if len(values) and (values == values[0]).all() and not _has_both_zeros(values):
        return float(values[0])
    return values.view(Column)


def _has_both_zeros(values: np.ndarray) -> bool:
    return bool(values[0] == 0.0 and np.signbit(values).any() != np.signbit(values).all())


def row_of(value: Any, row: int) -> Any:
    """A value in one row: the number of a column as a float, anything else as it is."""
    return value.item(row) if isinstance(value, Column) else value


def by_branch(
    work: Callable[[np.ndarray], Result], rows: np.ndarray, least: int = 1
) -> list[tuple[np.ndarray, Result | None]]:
    """Do some work on rows, in lots that agree about every branch.

    Parameters
    ----------
    work : callable
        Takes the numbers of some rows.
    rows : ndarray of int
    least : int
        Rows that are worth it; fewer are left alone.

    Returns
    -------
    list of (ndarray of int, result or None)
        Rows and what the work gave. None for few rows, and where a row has a division by zero, an
        overflow or anything else that is no number, or something takes no columns.
    """
    if len(rows) < least:
        return [(rows, None)] if len(rows) else []
    try:
        with np.errstate(all="raise", under="ignore"):
            return [(rows, work(rows))]
    except Differs as found:
        lots = rows[found.answers], rows[~found.answers]
    except (ArithmeticError, TypeError, ValueError):
        return [(rows, None)]
    return [part for lot in lots for part in by_branch(work, lot, least)]


def _elementwise(function: Callable[..., float], count: int) -> Callable[..., Any]:
    """A function of Python's, number by number: numpy's own differ from it in the last bit."""
    each = np.frompyfunc(function, count, 1)

    def on_columns(*arguments: Any) -> Any:
        if not any(isinstance(argument, Column) for argument in arguments):
            return function(*arguments)
        return each(*arguments).astype(np.float64).view(Column)

    return on_columns


_power = _elementwise(operator.pow, 2)
exp = _elementwise(math.exp, 1)
log = _elementwise(math.log, 1)
expm1 = _elementwise(math.expm1, 1)
sin = _elementwise(math.sin, 1)


def sqrt(x: Any) -> Any:
    """Square root, correctly rounded by numpy and Python alike."""
    return np.sqrt(x) if isinstance(x, Column) else math.sqrt(x)


def least_of(a: Any, b: Any) -> Any:
    """The lesser of two numbers, in each row."""
    return np.minimum(a, b) if isinstance(a, Column) or isinstance(b, Column) else min(a, b)
