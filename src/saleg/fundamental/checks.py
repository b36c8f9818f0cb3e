"""One error that names every quantity outside the model."""

from __future__ import annotations

from typing import Any

import numpy as np

from saleg.checks import Check, as_array
from saleg.errors import OutsideModel
from saleg.quantities import Limits, Problem, as_float

POSITION = Limits("-", -1.0, 1.0, True, True)
DEPTH = Limits("-", 0.0, 1.0, True, True)
LEFT = Limits("-", -1.0, 0.0, True, True)
GAMMA = Limits("-", 1.0, np.inf, True, False)
NOT_NEGATIVE = Limits("-", 0.0, np.inf, False, False)
FINITE = Limits("-", -np.inf, np.inf, False, False)
#: One number, of whatever range.
SCALAR = Check(as_float, "must be a number")


def require(**arguments: tuple[Any, Limits]) -> None:
    """Check arguments, numbers or arrays, against their allowed ranges.

    Parameters
    ----------
    **arguments : tuple of (array_like, Limits)
        Value and range of every argument, by its name.

    Raises
    ------
    OutsideModel
        Naming every argument that is wrong anywhere, with its first wrong value.

    Examples
    --------
    >>> require(gamma=(0.9, GAMMA), x=([0.5, 2.0], POSITION))
    Traceback (most recent call last):
    saleg.errors.OutsideModel: 2 wrong fields in the fundamental model:
      gamma = 0.9: must be > 1
      x = 2.0: must be > -1 and < 1
    """
    found = [
        problem
        for name, (value, limits) in arguments.items()
        for problem in _problems(name, value, limits)
    ]
    if found:
        raise OutsideModel(found)


def _problems(name: str, value: Any, limits: Limits) -> list[Problem]:
    if np.iscomplexobj(value):
        value = np.real(value)  # derivatives are taken with steps along the other part
    number = as_float(value)
    numbers = as_array(value) if number is None else np.array(number)
    if numbers is None:
        return [Problem(name, value, limits.unit, limits.wanted("a number"))]
    numbers = numbers.ravel()
    if numbers.size == 0 or (np.isfinite(numbers).all() and _admits_all(limits, numbers)):
        return []
    for number in numbers.tolist():
        if not np.isfinite(number):
            return [Problem(name, number, limits.unit, limits.wanted("a finite number"))]
        if not limits.admits(number):
            return [Problem(name, number, limits.unit, limits.wanted())]
    return []


def _admits_all(limits: Limits, numbers: np.ndarray) -> bool:
    return limits.admits(float(numbers.min())) and limits.admits(float(numbers.max()))
