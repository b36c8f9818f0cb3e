"""Power demanded over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from saleg.errors import ControllerError, InvalidController
from saleg.files.reading import read_text
from saleg.laws.usual import POWER, TIME
from saleg.quantities import Problem, Quantities, problems, series


@dataclass(frozen=True)
class Demand(Quantities):
    """Power demanded over time: linear between the times, constant before and after.

    Parameters
    ----------
    times : tuple of float
        Never falling [s]; two equal ones make a step.
    powers : tuple of float
        Power at those times [W].

    Raises
    ------
    InvalidController
        If the numbers make no profile.

    Examples
    --------
    >>> Demand.step(2.0, 3900.0, 1900.0).times
    (2.0, 2.0)
    """

    times: tuple[float, ...] = series("s", never_falling=True, usual=TIME)
    powers: tuple[float, ...] = series("W", low=0, length="times", usual=POWER)

    def __post_init__(self) -> None:
        """Check both series."""
        super().__post_init__()
        found = problems(self, "demand")
        if found:
            raise InvalidController(found)

    @classmethod
    def step(cls, at: float, before: float, after: float) -> Demand:
        """A step at a time [s] from one power to another [W]."""
        return cls((at, at), (before, after))

    @classmethod
    def ramp(cls, begin: float, end: float, before: float, after: float) -> Demand:
        """A ramp between two times [s] from one power to another [W]."""
        return cls((begin, end), (before, after))

    @classmethod
    def of(cls, times: Sequence[float], powers: Sequence[float]) -> Demand:
        """A demand from arrays of times [s] and powers [W].

        Raises
        ------
        InvalidController
            If the numbers make no profile.
        """
        return cls(*(tuple(np.ravel(np.asarray(item, dtype=object))) for item in (times, powers)))

    @classmethod
    def read(cls, path: str | Path) -> Demand:
        """A demand from a CSV file of two columns, times [s] and powers [W].

        A first line of words is taken for a header.

        Raises
        ------
        ControllerError
            If the file cannot be read.
        InvalidController
            Naming the line that cannot be read.
        """
        lines = read_text(path, ControllerError).splitlines()
        times, powers = [], []
        for number, line in enumerate(lines, start=1):
            row = line.split(",")
            if not line.strip():
                continue
            try:
                t, power = (float(value.strip().strip('"')) for value in row)
            except ValueError:
                if number > 1:
                    problem = Problem(f"{path}, line {number}", line, "", "must be two numbers")
                    raise InvalidController([problem]) from None
                continue
            times.append(t)
            powers.append(power)
        return cls.of(times, powers)
